use super::*;
use crate::math::curve::{Basis, Curve};
use crate::math::quadrature::gauss_legendre;
use crate::yarn::fetch::FiberField;
use crate::yarn::presets;
use crate::yarn::strand::strands;

/// Distance from the ply's centre in the round ply, place along the yarn, and angle in the ply's frame.
fn unwound(yarn: &YarnParams, ply: u32, p: DVec3) -> DVec3 {
    let turn = TAU * (f64::from(ply) / f64::from(yarn.ply_count) + yarn.ply_turns_per_mm() * p.z);
    let outward = p.x * turn.cos() + p.y * turn.sin() - 0.5 * yarn.yarn_radius_mm;
    let around = p.y * turn.cos() - p.x * turn.sin();
    let (x, y) = (outward / yarn.ellipse_short_mm, around / yarn.ellipse_long_mm);
    DVec3::new(x.hypot(y) * (yarn.ellipse_short_mm * yarn.ellipse_long_mm).sqrt(), p.z, y.atan2(x))
}

/// The difference of two angles, in [-pi, pi].
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

fn of_kind(curves: &[FiberCurve], kind: Kind) -> Vec<&FiberCurve> {
    curves.iter().filter(|curve| curve.kind == kind).collect()
}

/// Largest departure of the sorted `shares` from a uniform distribution, times the root of their count:
/// Kolmogorov and Smirnov's statistic.
fn uniform_distance(mut shares: Vec<f64>) -> f64 {
    shares.sort_by(f64::total_cmp);
    let n = shares.len() as f64;
    let gap = |(i, u): (usize, &f64)| (u - i as f64 / n).abs().max((u - (i + 1) as f64 / n).abs());
    shares.iter().enumerate().map(gap).fold(0.0, f64::max) * n.sqrt()
}

/// Exceeded by chance once in a thousand (Kolmogorov's distribution).
const UNLIKELY: f64 = 1.95;

/// The standard normal distribution function.
fn normal_share(x: f64) -> f64 {
    let density = |t: f64| (-0.5 * t * t).exp() / TAU.sqrt();
    let x = x.clamp(-8.0, 8.0);
    0.5 + (0..8)
        .map(|i| gauss_legendre(x * f64::from(i) / 8.0, x * f64::from(i + 1) / 8.0, density))
        .sum::<f64>()
}

#[test]
fn flyaways_are_as_many_as_their_densities_say() {
    let length_mm = 30.0;
    for name in presets::yarn_names() {
        let yarn = presets::yarn(name).unwrap();
        let curves = zhao_fibers(&yarn, length_mm, 0.5, 3);
        let maxima = length_mm
            * yarn.migration_rate
            * yarn.fiber_turns_per_mm().abs()
            * f64::from(yarn.fibers_per_ply);
        for ply in 0..yarn.ply_count {
            let count = |kind| curves.iter().filter(|c| c.kind == kind && c.ply == ply).count() as f64;
            let hairs = yarn.hair_density_per_mm * length_mm;
            assert!((count(Kind::Hair) - hairs).abs() <= 0.5, "{name}: {} hairs", count(Kind::Hair));
            let loops = yarn.loop_density_per_mm * length_mm;
            let enough = maxima > 1.1 * loops;
            // silk1 migrates so slowly that it has fewer maxima than the loops counted in it; a fiber's
            // number of maxima is within 1 of the mean, with a deviation of at most one half.
            assert_eq!(enough, name != "silk1", "{name}: {maxima} maxima for {loops} loops");
            let (expected, error) =
                if enough { (loops, 0.5) } else { (maxima, 1.5 * f64::from(yarn.fibers_per_ply).sqrt()) };
            let found = count(Kind::Loop);
            assert!((found - expected).abs() <= error, "{name}: {found} loops, expected {expected}");
        }
    }
}

/// Largest second difference of a hair's equally spaced points in (r, z, angle), beyond its centre where the
/// angle is lost.
fn bend(yarn: &YarnParams, hair: &FiberCurve) -> f64 {
    let points: Vec<DVec3> = hair.points.iter().map(|&p| unwound(yarn, hair.ply, p)).collect();
    let differences: Vec<DVec3> = points
        .windows(2)
        .filter(|pair| pair[0].x > 1e-6 && pair[1].x > 1e-6)
        .map(|pair| DVec3 { z: wrapped(pair[1].z - pair[0].z), ..pair[1] - pair[0] })
        .collect();
    differences.windows(2).map(|pair| (pair[1] - pair[0]).abs().max_element()).fold(0.0, f64::max)
}

#[test]
fn hairs_are_straight_in_radius_place_and_angle() {
    for name in ["cotton1", "rayon1", "mohair"] {
        let yarn = presets::yarn(name).unwrap();
        let curves = zhao_fibers(&yarn, 50.0, 0.02, 3);
        let hairs = of_kind(&curves, Kind::Hair);
        let mut rooted = 0;
        for hair in &hairs {
            assert!(bend(&yarn, hair) < 1e-8, "{name}: {}", bend(&yarn, hair));
            let ends = [hair.points[0], hair.points[hair.points.len() - 1]];
            let [root, tip] = ends.map(|p| unwound(&yarn, hair.ply, p));
            assert!(tip.x > root.x, "{name}: a hair leads inward");
            assert!(ends.iter().all(|p| (-1e-9..50.0 + 1e-9).contains(&p.z)), "{name}: beyond the yarn");
            rooted += usize::from(root.x < 1e-9);
        }
        assert!(rooted * 10 > hairs.len() * 9, "{name}: {rooted} of {} hairs reach the centre", hairs.len());
        let mut bent = (*hairs.iter().max_by_key(|hair| hair.points.len()).unwrap()).clone();
        let last = bent.points.len() - 1;
        bent.points[last].x += 1e-4;
        assert!(bend(&yarn, &bent) > 1e-6, "{name}: a bent hair goes unnoticed");
    }
}

#[test]
fn hair_tips_and_slopes_follow_their_spreads() {
    // Deviations so small that drawing anew, which would bend the normal distribution, does not occur.
    let base = presets::yarn("cotton1").unwrap();
    let yarn = YarnParams {
        hair_radius_start_mm: Spread { mean: 0.2, deviation: 0.03 },
        hair_radius_gain_mm: Spread { mean: 0.4, deviation: 0.04 },
        hair_length_mm: Spread { mean: 1.0, deviation: 1e-9 },
        hair_angle_rad: Spread { mean: 0.3, deviation: 0.4 },
        ..base
    };
    let length_mm = 1000.0;
    let curves = zhao_fibers(&yarn, length_mm, 0.05, 8);
    let mut tips = Vec::new();
    let mut angles = Vec::new();
    let mut forward = 0.0;
    for hair in of_kind(&curves, Kind::Hair) {
        let at = |from_tip: usize| {
            let p = hair.points[hair.points.len() - 1 - from_tip];
            unwound(&yarn, hair.ply, p)
        };
        let (tip, before) = (at(0), at(1));
        let (run, turn) = (tip.y - before.y, wrapped(tip.z - before.z));
        if (10.0..length_mm - 10.0).contains(&tip.y) {
            tips.push(tip.x);
            // z_e is 1 mm: the angle over that length is p_e.
            angles.push(turn / run.abs());
            forward += f64::from(u8::from(run > 0.0));
        }
    }
    let n = tips.len() as f64;
    assert!(n > 5000.0);
    let distance = |values: &[f64], mean: f64, deviation: f64| {
        uniform_distance(values.iter().map(|x| normal_share((x - mean) / deviation)).collect())
    };
    assert!(distance(&tips, 0.6, 0.75 * 0.05) < UNLIKELY);
    assert!(distance(&tips, 0.6, 0.05) > UNLIKELY, "the whole deviation passes for 0.75 of it");
    assert!(distance(&angles, 0.3, 0.75 * 0.4) < UNLIKELY);
    assert!(distance(&angles, 0.33, 0.75 * 0.4) > UNLIKELY, "a wrong mean passes");
    assert!((forward - 0.5 * n).abs() < 3.0 * 0.5 * n.sqrt(), "{forward} of {n} hairs run forward");
}

/// How far along a normal distribution cut off below 1.05 times the fiber's own radius each peak lies.
fn peak_shares(yarn: &YarnParams, curves: &[FiberCurve], deviation_share: f64) -> Vec<f64> {
    let Spread { mean, deviation } = yarn.loop_radius_mm;
    let whole = |curve: &&&FiberCurve| curve.points[0].z > 0.0 && curve.points.last().unwrap().z < 200.0;
    of_kind(curves, Kind::Loop)
        .iter()
        .filter(whole)
        .map(|curve| {
            let radii = curve.points.iter().map(|&p| unwound(yarn, curve.ply, p).x);
            let peak_mm = radii.clone().fold(0.0, f64::max);
            // A loop runs from a minimum of R to the next.
            let own_mm = radii.fold(f64::INFINITY, f64::min) * yarn.migration_max / yarn.migration_min;
            let share = |r: f64| normal_share((r - mean) / (deviation_share * deviation));
            let least = share(1.05 * own_mm);
            (share(peak_mm) - least) / (1.0 - least)
        })
        .collect()
}

#[test]
fn loop_peaks_follow_their_spread_beyond_the_fibers_own_radius() {
    for name in ["cotton1", "rayon1", "polyester1"] {
        let yarn = presets::yarn(name).unwrap();
        let curves = zhao_fibers(&yarn, 200.0, 0.2, 5);
        let distance = |share| uniform_distance(peak_shares(&yarn, &curves, share));
        assert!(peak_shares(&yarn, &curves, 0.5).len() > 600, "{name}");
        assert!(distance(0.5) < UNLIKELY, "{name}: {}", distance(0.5));
        assert!(distance(0.75) > UNLIKELY, "{name}: the hairs' deviation passes for the loops'");
    }
}

/// The straight yarn of [`zhao_fibers`] in pieces of 1 mm.
fn field(yarn: &YarnParams, length_mm: u32, seed: u64) -> FiberField {
    let points = (0..=length_mm).map(|i| DVec3::Z * f64::from(i)).collect();
    let mut strands = strands(&[Curve { points, closed: false }], Basis::CatmullRom, yarn, seed);
    strands.normals.fill(DVec3::X);
    let begin = strands.pieces[0].turns;
    for piece in &mut strands.pieces {
        piece.turns.ply.start -= begin.ply.start;
        piece.turns.fiber.start -= begin.fiber.start;
        piece.turns.migration.start -= begin.migration.start;
    }
    FiberField::new(strands, yarn, seed)
}

/// A point of a migrating fiber by the twin of the drawn fibers.
fn twin_point(field: &FiberField, fiber: usize, z: f64) -> DVec3 {
    let index = (z as usize).min(field.strands.pieces.len() - 1);
    let (piece, t) = (&field.strands.pieces[index], z - index as f64);
    let twist = twist_at(&piece.turns, t);
    let fiber = &field.fibers[fiber];
    let shape = migration_shape(fiber, twist.migration, twist.migration_rate, &field.yarn);
    field.fiber_point(piece, fiber, t, &shape).position
}

#[test]
fn regular_fibers_are_the_twins_and_loops_are_those_scaled() {
    for name in ["cotton2", "rayon1", "silk1"] {
        let yarn = presets::yarn(name).unwrap();
        let field = field(&yarn, 40, 6);
        let curves = zhao_fibers(&yarn, 40.0, 0.1, 6);
        let parts: Vec<_> = curves.iter().filter(|curve| curve.kind != Kind::Hair).collect();
        let mut fiber = usize::MAX;
        let mut before = DVec3::ZERO;
        for part in parts {
            // A part at the yarn's start begins the next fiber; others go on where the last one ended.
            if part.points[0].z == 0.0 {
                fiber = fiber.wrapping_add(1);
            } else {
                assert!((part.points[0] - before).length() < 1e-12, "{name}: a gap");
            }
            before = part.points[part.points.len() - 1];
            assert_eq!((part.ply, part.radius_mm), (field.fibers[fiber].ply, yarn.fiber_radius_mm()));
            for &p in &part.points {
                let twin = twin_point(&field, fiber, p.z);
                if part.kind == Kind::Migration {
                    assert!((p - twin).length() < 1e-10, "{name} fiber {fiber}: {p}, {twin}");
                } else {
                    let [here, own] = [p, twin].map(|p| unwound(&yarn, part.ply, p));
                    assert!(here.x > own.x - 1e-10 && wrapped(here.z - own.z).abs() < 1e-8, "{name}");
                }
            }
        }
        assert_eq!(fiber + 1, field.fibers.len());
    }
}

#[test]
fn a_loop_rises_like_a_sine_and_mirrors() {
    let yarn = presets::yarn("cotton1").unwrap();
    let field = field(&yarn, 40, 6);
    let half_mm = 0.5 * yarn.fiber_pitch_mm.unwrap() / yarn.migration_rate;
    let straight = StraightYarn::new(&yarn, 40.0, 0.1);
    let fiber = &field.fibers[0];
    let peak_mm = straight.maxima(fiber).find(|z| (half_mm + 0.01..39.9 - half_mm).contains(z)).unwrap();
    let mut curves = Vec::new();
    straight.append_fiber(fiber, &mut [Loop { peak_mm, ratio: 3.0 }], &mut curves);
    let kinds: Vec<_> = curves.iter().map(|curve| curve.kind).collect();
    assert_eq!(kinds, [Kind::Migration, Kind::Loop, Kind::Migration]);
    for &p in &curves[1].points {
        let [here, own] = [p, twin_point(&field, 0, p.z)].map(|p| unwound(&yarn, fiber.ply, p).x);
        let share = 1.0 - (p.z - peak_mm).abs() / half_mm;
        let factor = 1.0 + 2.0 * (0.5 * std::f64::consts::PI * share).sin();
        assert!((here / own - factor).abs() < 1e-8, "{} for {factor} at {share}", here / own);
    }
}

#[test]
fn odd_yarns_give_finite_fibers_or_none() {
    let base = presets::yarn("cotton1").unwrap();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(zhao_fibers(&base, bad, 0.1, 1).is_empty() && zhao_fibers(&base, 1.0, bad, 1).is_empty());
    }
    let nowhere = Spread { mean: 0.0, deviation: 0.0 };
    let odd = [
        YarnParams { fiber_pitch_mm: None, ply_pitch_mm: None, ..base.clone() },
        YarnParams { migration_rate: 0.0, ..base.clone() },
        YarnParams { loop_radius_mm: nowhere, hair_radius_gain_mm: nowhere, ..base.clone() },
        YarnParams { ply_count: 1, yarn_radius_mm: 0.0, hair_pitch_mm: Some(2.0), ..base.clone() },
        YarnParams { migration_min: 0.0, ..base },
    ];
    for yarn in odd {
        let curves = zhao_fibers(&yarn, 7.3, 0.1, 1);
        let regular = curves.iter().filter(|c| c.kind == Kind::Migration && c.points[0].z == 0.0).count();
        assert!(regular > 0 && curves.iter().all(|curve| curve.points.len() >= 2));
        assert!(curves.iter().flat_map(|curve| &curve.points).all(|p| p.is_finite()));
        if yarn.migration_rate * yarn.fiber_turns_per_mm() == 0.0 {
            assert!(of_kind(&curves, Kind::Loop).is_empty());
        }
        let shortest = curves
            .iter()
            .flat_map(|curve| curve.points.windows(2).map(|pair| (pair[1] - pair[0]).length()))
            .fold(f64::INFINITY, f64::min);
        assert!(shortest > 0.0, "two points in one place");
    }
}
