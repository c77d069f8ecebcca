//! Frames that follow moving yarn: `src/motion/pose.rs`.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

use glam::{DQuat, DVec3};
use std::f64::consts::TAU;
use worsted::knit::params::KnitParams;
use worsted::knit::stockinette::stockinette;
use worsted::knit::tube::tube;
use worsted::math::curve::{Basis, Curve};
use worsted::math::rng::Rng;
use worsted::motion::pose::{RestPose, knots};
use worsted::yarn::pose::PointMap;
use worsted::yarn::presets;
use worsted::yarn::strand::Strands;
use worsted::yarn::strand::strands;

fn fabrics() -> Vec<Strands> {
    let small = KnitParams { courses: 4, wales: 4, ..KnitParams::swatch() };
    let round = KnitParams { courses: 3, wales: 10, ..KnitParams::tube() };
    let line = Curve { points: (0..40).map(|i| DVec3::X * f64::from(i)).collect(), closed: false };
    let yarn = presets::yarn(presets::DEFAULT_YARN).unwrap();
    let knitted = [stockinette(&small).unwrap().curves, tube(&round).unwrap().curves, vec![line]];
    knitted.iter().map(|curves| strands(curves, Basis::CatmullRom, &yarn, 1)).collect()
}

fn given(strands: &Strands) -> Vec<DVec3> {
    PointMap::new(strands).unwrap().given(&strands.points)
}

/// The largest angle between normals of knots.
fn apart(strands: &Strands, a: &[DVec3], b: impl Fn(usize) -> DVec3) -> f64 {
    let knots = knots(strands);
    let angle = |i: usize| a[i].cross(b(i)).length().atan2(a[i].dot(b(i)));
    (0..a.len()).filter(|i| knots[*i]).map(angle).fold(0.0, f64::max)
}

#[test]
fn at_rest_and_after_rigid_motion_no_phase_is_added() {
    let mut rng = Rng::new(4, &[]);
    let mut worst: f64 = 0.0;
    for strands in &fabrics()[..2] {
        let rest = RestPose::new(strands).unwrap();
        let pose = rest.pose(&given(strands)).unwrap();
        assert_eq!(pose.points, strands.points);
        worst = worst.max(apart(strands, &pose.normals, |i| strands.normals[i]));
        for _ in 0..20 {
            let mut number = || 2.0 * rng.uniform() - 1.0;
            let axis = DVec3::new(number(), number(), number()).normalize();
            let q = DQuat::from_axis_angle(axis, std::f64::consts::PI * number());
            let shift = 500.0 * DVec3::new(number(), number(), number());
            // As files hold them: f32.
            let moved: Vec<DVec3> =
                given(strands).iter().map(|p| (q * *p + shift).as_vec3().as_dvec3()).collect();
            let pose = rest.pose(&moved).unwrap();
            worst = worst.max(apart(strands, &pose.normals, |i| q * strands.normals[i]));
        }
    }
    println!("rigid motion adds at most {worst:.1e} rad");
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn a_cyclic_motion_comes_back_to_the_same_normals() {
    let wave = |p: DVec3, cycles: f64| p + DVec3::Z * 3.0 * (0.2 * p.y + TAU * cycles).sin();
    for strands in fabrics() {
        let rest = RestPose::new(&strands).unwrap();
        let at = |cycles: f64| {
            let moved: Vec<DVec3> =
                given(&strands).iter().map(|p| wave(*p, cycles).as_vec3().as_dvec3()).collect();
            rest.pose(&moved).unwrap()
        };
        for share in [0.0, 0.13, 0.5, 0.77] {
            let later = at(share + 100.0);
            let angle = apart(&strands, &at(share).normals, |i| later.normals[i]);
            assert!(angle < 1e-3, "{angle}");
        }
    }
}

#[test]
fn normals_are_unit_and_perpendicular_whatever_moves() {
    let mut rng = Rng::new(7, &[]);
    for strands in fabrics() {
        let rest = RestPose::new(&strands).unwrap();
        for size in [0.0, 0.3, 10.0, 1e6] {
            let moved: Vec<DVec3> = given(&strands)
                .iter()
                .map(|p| *p * 0.0 + size * DVec3::from_array(std::array::from_fn(|_| rng.uniform())))
                .collect();
            let pose = rest.pose(&moved).unwrap();
            let tangents = strands.knot_tangents_at(&pose.points);
            for (normal, tangent) in pose.normals.iter().zip(&tangents) {
                assert!((normal.length() - 1.0).abs() < 1e-9 && normal.dot(*tangent).abs() < 1e-9);
            }
        }
        assert!(rest.pose(&given(&strands)[1..]).is_none(), "a point is missing");
    }
}
