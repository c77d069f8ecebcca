//! The equations of a straight yarn, written out once more in plain trigonometry: nothing of the twins.

use crate::twin::{Reading, StraightTwin};
use std::f64::consts::TAU;
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

/// Turns in radians at `z` of something that turns once in `pitch`, clockwise or not.
fn turn(pitch: Option<f64>, clockwise: bool, z: f64) -> f64 {
    let turned = TAU * z / pitch.expect("twisted");
    if clockwise { -turned } else { turned }
}

/// Angle of a ply's centre around the yarn's at `z`, where ply 0 starts toward +X.
fn ply_angle(yarn: &YarnParams, ply: u32, z: f64) -> f64 {
    TAU * f64::from(ply) / f64::from(yarn.ply_count) + turn(yarn.ply_pitch_mm, yarn.ply_clockwise, z)
}

/// x and y in mm at `z` of the fiber with R_i, theta_i and m_i (Wu & Yuksel 2019, Sec. 3.1).
pub fn fiber_at(yarn: &YarnParams, ply: u32, [radius, angle, phase]: [f64; 3], z: f64) -> [f64; 2] {
    let twist = turn(yarn.fiber_pitch_mm, yarn.fiber_clockwise, z);
    let (most, least) = (yarn.migration_max, yarn.migration_min);
    let r = 0.5 * radius * ((most + least) + (most - least) * (yarn.migration_rate * twist + phase).cos());
    let outward = 0.5 * yarn.yarn_radius_mm + yarn.ellipse_short_mm * r * (angle + twist).cos();
    let around = yarn.ellipse_long_mm * r * (angle + twist).sin();
    let turned = ply_angle(yarn, ply, z);
    [outward * turned.cos() - around * turned.sin(), outward * turned.sin() + around * turned.cos()]
}

/// The way back: phase and radius in the ply's rotating elliptical frame, where ply 0 starts at `ply_start`.
pub fn phase_and_radius(yarn: &YarnParams, ply: u32, ply_start: f64, [x, y, z]: [f64; 3]) -> [f64; 2] {
    let turned = ply_start + ply_angle(yarn, ply, z);
    let outward = (x * turned.cos() + y * turned.sin() - 0.5 * yarn.yarn_radius_mm) / yarn.ellipse_short_mm;
    let around = (y * turned.cos() - x * turned.sin()) / yarn.ellipse_long_mm;
    [around.atan2(outward), outward.hypot(around)]
}

#[test]
fn equations_and_their_inverse_agree() {
    let yarn = presets::yarn("rayon1").expect("the preset exists");
    let untwisted = YarnParams { fiber_pitch_mm: Some(1e12), migration_min: 1.0, ..yarn };
    for z in [-3.0, 0.0, 7.7] {
        let [x, y] = fiber_at(&untwisted, 1, [0.6, 1.1, 0.0], z);
        let [phase, radius] = phase_and_radius(&untwisted, 1, 0.0, [x, y, z]);
        assert!((phase - 1.1).abs() < 1e-9 && (radius - 0.6).abs() < 1e-12, "{phase} {radius}");
    }
}

#[test]
fn twins_give_the_equations_positions() {
    for preset in ["cotton2", "rayon1"] {
        let yarn = presets::yarn(preset).expect("the preset exists");
        let twin = StraightTwin::new(&yarn, Reading::FreePhase);
        for i in 0..12 {
            let z = -13.7 + 2.43 * f64::from(i);
            let own = [0.2 + 0.07 * f64::from(i), 0.5 * f64::from(i), 2.0 - 0.9 * f64::from(i)];
            for ply in 0..yarn.ply_count {
                let [x, y] = fiber_at(&yarn, ply, own, z);
                let found = twin.position(ply, &[own[0], own[1], own[2], 0.0], z);
                let gap = (found - glam::DVec3::new(x, y, z)).length();
                assert!(gap < 1e-12, "{preset} ply {ply} at {z}: {gap} mm apart");
            }
        }
    }
}
