//! The f64 twins of the yarn against fibers of the generator of Zhao et al. 2016, where its output is at hand
//! (`../shared/data` beside the repository), and against the equations written out plainly, everywhere.

mod compare;
mod equations;
mod statistics;
mod truth;
mod twin;

use compare::{Errors, compare};
use truth::Truth;
use twin::Reading;
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

/// What issue and equations promise: radians, and shares of a ply's radius.
const MOST_PHASE: f64 = 1e-3;
const MOST_RADIUS: f64 = 1e-4;

fn passes(errors: &Errors) -> bool {
    errors.phase_rad < MOST_PHASE && errors.radius < MOST_RADIUS
}

/// The yarn as the twin would read it wrongly, one mistake each.
fn wrong_readings(yarn: &YarnParams) -> Vec<(&'static str, YarnParams, Reading)> {
    let right = || yarn.clone();
    let swapped = YarnParams {
        ellipse_short_mm: yarn.ellipse_long_mm,
        ellipse_long_mm: yarn.ellipse_short_mm,
        ..right()
    };
    let free = Reading::FreePhase;
    vec![
        ("e_N and e_B swapped", swapped, free),
        ("plies turn the other way", YarnParams { ply_clockwise: !yarn.ply_clockwise, ..right() }, free),
        ("fibers turn the other way", YarnParams { fiber_clockwise: !yarn.fiber_clockwise, ..right() }, free),
        (
            "plies lie at yarn_radius",
            YarnParams { yarn_radius_mm: 2.0 * yarn.yarn_radius_mm, ..right() },
            free,
        ),
        ("fiber pitch 0.1% off", with_pitch(yarn, 1.001), free),
        ("R migrates 1% faster", YarnParams { migration_rate: 1.01 * yarn.migration_rate, ..right() }, free),
        ("theta_i for m_i", right(), Reading::AngleAsPhase),
    ]
}

fn with_pitch(yarn: &YarnParams, by: f64) -> YarnParams {
    YarnParams { fiber_pitch_mm: yarn.fiber_pitch_mm.map(|pitch| by * pitch), ..yarn.clone() }
}

/// The twin must follow every fiber of `truth`, and each mistake must show.
fn judge(truth: &Truth) {
    let found = compare(truth, &truth.yarn, Reading::FreePhase);
    let summary = format!(
        "{}: {} fibers, {} points: phase {:.1e} rad, radius {:.1e}, ply 0 starts at {:.6} rad",
        truth.name,
        truth.fibers.len(),
        truth.fibers.iter().map(Vec::len).sum::<usize>(),
        found.phase_rad,
        found.radius,
        found.ply_start_rad
    );
    println!("{summary}");
    assert!(passes(&found), "{summary}");
    for (what, yarn, reading) in wrong_readings(&truth.yarn) {
        let found = compare(truth, &yarn, reading);
        println!("  {what}: phase {:.1e} rad, radius {:.1e}", found.phase_rad, found.radius);
        assert!(!passes(&found), "{}: nobody notices that {what}", truth.name);
    }
}

#[test]
fn twins_follow_the_reference_generators_fibers() {
    for (file, yarn) in [("genYarn_yarn8", "cotton2"), ("genYarn_yarn9", "silk1")] {
        match Truth::read(file, yarn) {
            Ok(truth) => judge(&truth),
            Err(why) => println!("skipped: {why}"),
        }
    }
}

#[test]
fn twins_follow_the_equations_written_out() {
    // Plies counter-clockwise and fibers clockwise, and the other way around.
    for (preset, seed) in [("cotton2", 1), ("rayon1", 2)] {
        let yarn = presets::yarn(preset).expect("the preset exists");
        judge(&Truth::from_equations(preset, &YarnParams { fibers_per_ply: 12, ..yarn }, seed));
    }
}

#[test]
fn a_single_point_out_of_place_shows() {
    let yarn = presets::yarn("cotton2").expect("the preset exists");
    let good = Truth::from_equations("cotton2", &YarnParams { fibers_per_ply: 4, ..yarn }, 3);
    assert!(passes(&compare(&good, &good.yarn, Reading::FreePhase)));
    let mut bad = good.clone();
    bad.fibers[7][150].x += 3e-4 * good.yarn.ellipse_short_mm.hypot(good.yarn.ellipse_long_mm);
    assert!(!passes(&compare(&bad, &good.yarn, Reading::FreePhase)));
    let mut bad = good.clone();
    bad.fibers[2][5].y = f64::NAN;
    assert!(!passes(&compare(&bad, &good.yarn, Reading::FreePhase)));
    let mut bad = good.clone();
    bad.fibers.swap(0, 4);
    assert!(!passes(&compare(&bad, &good.yarn, Reading::FreePhase)), "a fiber in another's ply");
}
