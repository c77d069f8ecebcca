//! The fitted presets against the published fits, where they are at hand: `../shared/data` beside the
//! repository.

use std::collections::HashMap;
use std::path::PathBuf;

use worsted::yarn::params::{Spread, YarnParams};
use worsted::yarn::presets;

const FITS: [&str; 9] =
    ["cotton1", "cotton2", "polyester1", "rayon1", "rayon2", "rayon3", "rayon4", "silk1", "silk2"];

/// The numbers of each key of a fit, lengths in cm; `None`, with the reason printed, when this machine
/// does not have it.
fn fit(name: &str) -> Option<HashMap<String, Vec<f64>>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/data/zhao-yarn-params/final")
        .join(format!("{name}.txt"));
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("skipped: {} is not on this machine", path.display());
        return None;
    };
    let rows = text.lines().filter_map(|line| line.split_once(':'));
    let numbers = |text: &str| text.split_whitespace().map(str::parse).collect::<Result<_, _>>();
    // The bounding boxes are in brackets: no numbers, and not wanted.
    Some(rows.filter_map(|(key, text)| Some((key.to_owned(), numbers(text).ok()?))).collect())
}

/// The first number in which a preset departs from its fit.
fn departure(yarn: &YarnParams, fit: &HashMap<String, Vec<f64>>) -> Option<String> {
    let flag = |flag: bool| f64::from(u8::from(flag));
    let pair = |spread: Spread, unit: f64| vec![unit * spread.mean, unit * spread.deviation];
    let cm = 0.1;
    let expected = [
        ("ply_num", vec![f64::from(yarn.ply_count)]),
        ("fiber_num", vec![f64::from(yarn.fibers_per_ply)]),
        ("yarn_clock_wise", vec![flag(yarn.ply_clockwise)]),
        ("fiber_clock_wise", vec![flag(yarn.fiber_clockwise)]),
        ("yarn_alpha", vec![cm * yarn.ply_pitch_mm.unwrap_or(0.0)]),
        ("alpha", vec![cm * yarn.fiber_pitch_mm.unwrap_or(0.0)]),
        ("yarn_radius", vec![cm * yarn.yarn_radius_mm]),
        ("ellipse_long", vec![cm * yarn.ellipse_long_mm]),
        ("ellipse_short", vec![cm * yarn.ellipse_short_mm]),
        ("epsilon", vec![yarn.density_epsilon]),
        ("beta", vec![yarn.density_beta]),
        ("R_max", vec![1.0]),
        ("s_i", vec![yarn.migration_rate]),
        ("rho_min", vec![yarn.migration_min]),
        ("rho_max", vec![yarn.migration_max]),
        ("flyaway_hair_density", vec![yarn.hair_density_per_mm / cm]),
        ("flyaway_hair_ze", pair(yarn.hair_length_mm, cm)),
        ("flyaway_hair_r0", pair(yarn.hair_radius_start_mm, cm)),
        ("flyaway_hair_re", pair(yarn.hair_radius_gain_mm, cm)),
        ("flyaway_hair_pe", pair(yarn.hair_angle_rad, 1.0)),
        ("flyaway_loop_density", vec![yarn.loop_density_per_mm / cm]),
        ("flyaway_loop_r1", pair(yarn.loop_radius_mm, cm)),
    ];
    let close = |a: &Vec<f64>, b: &Vec<f64>| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-12 * b.abs().max(1e-3))
    };
    let wrong =
        expected.iter().find(|(key, ours)| !fit.get(*key).is_some_and(|theirs| close(ours, theirs)))?;
    Some(format!("{}: preset {:?}, fit {:?}", wrong.0, wrong.1, fit.get(wrong.0)))
}

#[test]
fn every_number_of_the_fitted_presets_is_the_published_one() {
    for name in FITS {
        let yarn = presets::yarn(name).expect("the preset exists");
        assert!(presets::describe(name).expect("the preset exists").measured, "{name}");
        let Some(fit) = fit(name) else { return };
        assert_eq!(departure(&yarn, &fit), None, "{name}");
    }
    let measured = |name: &&str| presets::describe(name).is_some_and(|about| about.measured);
    assert_eq!(presets::yarn_names().filter(measured).collect::<Vec<_>>(), FITS);
}

#[test]
fn a_wrong_digit_is_noticed() {
    let Some(fit) = fit("rayon3") else { return };
    let good = presets::yarn("rayon3").expect("the preset exists");
    let slip = Spread { mean: good.hair_length_mm.mean, deviation: good.hair_length_mm.deviation + 1e-5 };
    for bad in [
        YarnParams { ellipse_short_mm: good.ellipse_short_mm + 1e-6, ..good.clone() },
        YarnParams { ply_clockwise: !good.ply_clockwise, ..good.clone() },
        YarnParams { loop_density_per_mm: 10.0 * good.loop_density_per_mm, ..good.clone() },
        YarnParams { hair_length_mm: slip, ..good.clone() },
    ] {
        assert!(departure(&bad, &fit).is_some());
    }
    let mut short = fit.clone();
    short.remove("flyaway_loop_r1");
    assert!(departure(&good, &short).is_some_and(|text| text.starts_with("flyaway_loop_r1")));
}
