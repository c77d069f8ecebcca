//! What is drawn at random, against the distributions that the preset states. Seeds are fixed: these tests
//! pass or fail for good.

use glam::DVec3;
use std::f64::consts::{E, TAU};
use worsted::math::curve::{Basis, Curve};
use worsted::yarn::breaks::is_broken;
use worsted::yarn::fetch::FiberField;
use worsted::yarn::level::period_pieces;
use worsted::yarn::params::{MAX_FIBERS, YarnParams};
use worsted::yarn::period::{Kind, period_rate};
use worsted::yarn::presets;
use worsted::yarn::strand::strands;
use worsted::yarn::table::{Fiber, fiber_table};

const BINS: usize = 20;
/// Chi squared with 19 degrees of freedom exceeds this by chance once in ten thousand.
const CHI_SQUARED: f64 = 50.8;
/// Kolmogorov and Smirnov's statistic exceeds this by chance once in ten thousand.
const KOLMOGOROV: f64 = 2.23;

/// As many fibers of the preset's density as a yarn may have.
fn many_fibers(preset: &str) -> (YarnParams, Vec<Fiber>) {
    let yarn = presets::yarn(preset).expect("the preset exists");
    let yarn = YarnParams { ply_count: 8, fibers_per_ply: MAX_FIBERS / 8, ..yarn };
    let fibers = fiber_table(&yarn, 11);
    (yarn, fibers)
}

/// Chi squared of the fibers' radii for p(R) (Zhao et al. 2016) on the area of the disc.
fn radius_chi_squared(fibers: &[Fiber], beta: f64, epsilon: f64) -> f64 {
    let ring = |r: f64| r * ((1.0 - 2.0 * epsilon) * ((E - r.exp()) / (E - 1.0)).powf(beta) + epsilon);
    let steps = 1000;
    let place = |bin: usize, k: u32| (bin as f64 + (f64::from(k) + 0.5) / f64::from(steps)) / BINS as f64;
    let masses: Vec<f64> = (0..BINS).map(|bin| (0..steps).map(|k| ring(place(bin, k))).sum()).collect();
    let mut counts = [0.0; BINS];
    for fiber in fibers {
        counts[((fiber.radius * BINS as f64) as usize).min(BINS - 1)] += 1.0;
    }
    let per_mass = fibers.len() as f64 / masses.iter().sum::<f64>();
    counts.iter().zip(masses).map(|(n, mass)| (n - per_mass * mass).powi(2) / (per_mass * mass)).sum()
}

#[test]
fn radii_of_every_preset_follow_its_density() {
    for preset in presets::yarn_names() {
        let (yarn, fibers) = many_fibers(preset);
        let (beta, epsilon) = (yarn.density_beta, yarn.density_epsilon);
        let found = radius_chi_squared(&fibers, beta, epsilon);
        assert!(found < CHI_SQUARED, "{preset}: chi squared {found}");
        // The power of the test: an exponent, a floor or an area not the preset's own is noticed.
        // (The higher the floor, the less the exponent is felt.)
        let wrong_beta = radius_chi_squared(&fibers, beta + 0.4 / (1.0 - 2.0 * epsilon).powi(2), epsilon);
        let wrong_floor = radius_chi_squared(&fibers, beta, if epsilon > 0.2 { 0.0 } else { 0.49 });
        let squared = |f: &Fiber| Fiber { radius: f.radius * f.radius, ..*f };
        let no_root = radius_chi_squared(&fibers.iter().map(squared).collect::<Vec<_>>(), beta, epsilon);
        println!("{preset}: {found:.1}; wrong {wrong_beta:.0}, {wrong_floor:.0}, {no_root:.0}");
        for wrong in [wrong_beta, wrong_floor, no_root] {
            assert!(wrong > CHI_SQUARED, "{preset}: a wrong density has chi squared {wrong}");
        }
    }
}

/// Largest departure of angles from a uniform distribution over the circle, times the root of their count.
fn circle_distance(angles: impl Iterator<Item = f64>) -> f64 {
    let mut shares: Vec<f64> = angles.map(|angle| (angle / TAU).rem_euclid(1.0)).collect();
    shares.sort_by(f64::total_cmp);
    let n = shares.len() as f64;
    let gap = |(i, u): (usize, &f64)| (u - i as f64 / n).abs().max((u - (i + 1) as f64 / n).abs());
    shares.iter().enumerate().map(gap).fold(0.0, f64::max) * n.sqrt()
}

#[test]
fn angles_and_migration_phases_are_uniform_and_independent() {
    let (_, fibers) = many_fibers("cotton1");
    let of = |f: &dyn Fn(&Fiber) -> f64| circle_distance(fibers.iter().map(f));
    assert!(of(&|f| f.angle) < KOLMOGOROV && of(&|f| f.migration_phase) < KOLMOGOROV);
    assert!(of(&|f| f.migration_phase - f.angle) < KOLMOGOROV);
    assert!(of(&|f| f.migration_phase - TAU * f.radius * f.radius) < KOLMOGOROV);
    // theta_i in the place of m_i, or half the circle left out.
    assert!(of(&|f| f.angle - f.angle) > KOLMOGOROV && of(&|f| 0.5 * f.angle) > KOLMOGOROV);
}

/// Loops that begin and hairs that end along the drawn vertices of a straight yarn of so many mm.
fn drawn_flyaways(yarn: &YarnParams, length_mm: u32) -> [f64; 2] {
    let points = (0..=length_mm).map(|z| DVec3::Z * f64::from(z)).collect();
    let strands = strands(&[Curve { points, closed: false }], Basis::CatmullRom, yarn, 5);
    let field = FiberField::new(strands, yarn, 5);
    let [mut loops, mut hairs] = [0.0; 2];
    for fiber in 0..field.fibers.len() {
        let mut before: Option<worsted::yarn::breaks::StrandVertex> = None;
        for piece in &field.strands.pieces {
            let pieces = period_pieces(12, period_rate(&piece.turns, &field.flyaways), 1000);
            for i in 0..pieces {
                let t = f64::from(i) / f64::from(pieces);
                let (_, vertex) = field.fiber_vertex(piece, fiber, t, pieces);
                if let Some(before) = before {
                    let begins = before.period.index != vertex.period.index;
                    loops += f64::from(u8::from(begins && vertex.period.kind == Kind::Loop));
                    hairs += f64::from(u8::from(is_broken(before.exit, vertex.entry)));
                }
                before = Some(vertex);
            }
        }
    }
    [loops, hairs]
}

/// Whether counts over `length_mm` are within three standard errors (of Poisson's, which are no smaller
/// than the binomial's) of what the yarn's densities say.
fn as_dense([loops, hairs]: [f64; 2], yarn: &YarnParams, length_mm: u32) -> bool {
    let yarn_mm = f64::from(length_mm) * f64::from(yarn.ply_count);
    [(loops, yarn.loop_density_per_mm), (hairs, yarn.hair_density_per_mm)].into_iter().all(
        |(found, per_mm)| {
            let expected = per_mm * yarn_mm;
            (found - expected).abs() <= 3.0 * expected.sqrt()
        },
    )
}

#[test]
fn drawn_loops_and_hairs_are_as_many_as_the_preset_says() {
    for (preset, length_mm) in [("cotton1", 120), ("silk1", 120), ("worsted_3ply", 200)] {
        let yarn = presets::yarn(preset).expect("the preset exists");
        let counts = drawn_flyaways(&yarn, length_mm);
        println!("{preset}: {} loops, {} hairs drawn over {length_mm} mm", counts[0], counts[1]);
        assert!(as_dense(counts, &yarn, length_mm), "{preset}: {counts:?}");
        let denser = YarnParams { hair_density_per_mm: 1.3 * yarn.hair_density_per_mm, ..yarn.clone() };
        assert!(!as_dense(counts, &denser, length_mm), "{preset}: 30% more hairs go unnoticed");
        let fewer = YarnParams { loop_density_per_mm: 0.7 * yarn.loop_density_per_mm, ..yarn.clone() };
        assert!(!as_dense(counts, &fewer, length_mm), "{preset}: 30% fewer loops go unnoticed");
    }
}
