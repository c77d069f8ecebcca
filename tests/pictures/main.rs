//! Pictures drawn in process: as the goldens show them, and by what must hold of any picture.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

mod broken_shaders;
mod detail;
#[path = "../support/device.rs"]
mod device;
mod draw;
mod far;
mod furnace;
#[path = "../support/golden.rs"]
#[allow(dead_code)]
mod golden;
mod invariance;
mod lights;
mod shadows;
mod strand_judge;
mod turned_light;

use draw::{draw, draw_counted, hook, scene, swatch, yarn};
use golden::{Tolerance, golden, golden_linear};
use std::collections::BTreeSet;
use worsted::io::curves::Basis;
use worsted::scene::Scene;

const SIZE: [u32; 2] = [160, 120];
/// Some loops of the swatch, seen from a little above and to the right.
const CLOSE: [&str; 4] =
    ["camera.yaw_deg=18", "camera.pitch_deg=12", "camera.distance_mm=26", "camera.target_mm=[0, 0, 0]"];

fn close_up(more: &[&str]) -> Scene {
    scene(&swatch(), &[&CLOSE, more].concat())
}

#[test]
fn golden_swatch() {
    let picture = draw(close_up(&[]), SIZE, 16);
    golden_linear("swatch", &picture.linear, 1.0, Tolerance::ROUNDING);
}

#[test]
fn golden_swatch_as_shown() {
    let picture = draw(close_up(&[]), SIZE, 16);
    // What is shown is the same over a background, whose alpha is 1: here the whole picture counts.
    golden("swatch_shown", &picture.display, Tolerance::ROUNDING);
}

fn golden_view(view: &str) {
    let picture = draw(close_up(&[&format!("debug.view={view}")]), SIZE, 4);
    golden_linear(&format!("view_{view}"), &picture.linear, 1.0, Tolerance::ROUNDING);
}

#[test]
fn golden_normal_view() {
    golden_view("normal");
}

#[test]
fn golden_tangent_view() {
    golden_view("tangent");
}

#[test]
fn golden_ply_view() {
    golden_view("ply");
}

#[test]
fn golden_occlusion_view() {
    golden_view("occlusion");
}

const ARCH: [[f64; 3]; 7] = [
    [-10.0, -6.0, 0.0],
    [-8.0, 4.0, 3.0],
    [-3.0, 9.0, 1.0],
    [0.0, 3.0, 0.0],
    [3.0, -3.0, -1.0],
    [7.0, -6.0, -2.0],
    [10.0, 6.0, 0.0],
];

#[test]
fn golden_bezier_yarn() {
    let picture = draw(scene(&yarn(Basis::Bezier, &ARCH), &[]), SIZE, 16);
    golden_linear("bezier", &picture.linear, 1.0, Tolerance::ROUNDING);
}

#[test]
fn golden_b_spline_yarn() {
    let picture = draw(scene(&yarn(Basis::BSpline, &ARCH), &[]), SIZE, 16);
    golden_linear("b_spline", &picture.linear, 1.0, Tolerance::ROUNDING);
}

#[test]
fn golden_untwisted_yarn() {
    let untwisted = ["yarn.ply_pitch_mm=untwisted", "yarn.fiber_pitch_mm=untwisted", "camera.pitch_deg=20"];
    let picture = draw(scene(&hook(), &untwisted), SIZE, 16);
    golden_linear("untwisted", &picture.linear, 1.0, Tolerance::ROUNDING);
}

#[test]
fn golden_straight_yarn() {
    let points: Vec<[f64; 3]> = (0..5).map(|i| [f64::from(i) * 3.0, f64::from(i), 0.0]).collect();
    let picture = draw(scene(&yarn(Basis::CatmullRom, &points), &[]), SIZE, 16);
    golden_linear("straight", &picture.linear, 1.0, Tolerance::ROUNDING);
}

#[test]
fn alpha_is_the_coverage_and_the_background_is_empty() {
    let picture = draw(scene(&hook(), &[]), SIZE, 4).linear;
    let empty = picture.pixels.iter().filter(|p| **p == [0.0; 4]).count();
    let full = picture.pixels.iter().filter(|p| p[3] == 1.0).count();
    let part = picture.pixels.iter().filter(|p| p[3] > 0.0 && p[3] < 1.0).count();
    assert_eq!(empty + full + part, picture.pixels.len(), "no radiance without coverage, none above 1");
    assert!(empty > picture.pixels.len() / 2 && full > 500 && part > 100, "{empty} {full} {part}");
    // 4 samples: quarters and nothing else.
    assert!(picture.pixels.iter().all(|p| (4.0 * p[3]).fract() == 0.0));
    let corners = [0, SIZE[0] as usize - 1, picture.pixels.len() - 1];
    assert!(corners.iter().all(|&i| picture.pixels[i] == [0.0; 4]));
}

#[test]
fn the_ply_view_has_a_color_for_every_ply() {
    for plies in [1, 2, 3, 5, 8] {
        let sets = ["debug.view=ply", "yarn.fibers_per_ply=30", &format!("yarn.ply_count={plies}")];
        // One sample: no pixel mixes colours.
        let picture = draw(scene(&hook(), &sets), SIZE, 1).linear;
        let covered = picture.pixels.iter().filter(|p| p[3] > 0.0);
        let colors: BTreeSet<_> = covered.map(|p| [p[0], p[1], p[2]].map(f32::to_bits)).collect();
        assert_eq!(colors.len(), plies);
    }
}

#[test]
fn every_feature_that_is_left_out_was_dark_anyway() {
    let black = ["ambient.radiance=[0, 0, 0]", "light=[]"];
    let (dark, stats) = draw_counted(scene(&hook(), &black), SIZE, 4, false);
    assert!(dark.linear.pixels.iter().all(|p| p[..3] == [0.0; 3]), "no light, no radiance");
    for what in ["light", "ambient", "occlusion"] {
        assert!(stats.left_out.contains_key(what), "{what}: {:?}", stats.left_out);
    }
    let unlit = ["ambient.radiance=[0, 0, 0]", "light=[{irradiance = [0, 0, 0]}]"];
    assert_eq!(draw(scene(&hook(), &unlit), SIZE, 4).linear, dark.linear);
    // No specular lobe is the limit of a faint one.
    let simple = |specular: &str| {
        let specular = format!("fiber.specular=[{specular}, {specular}, {specular}]");
        draw(scene(&hook(), &["shading.model=simple", &specular]), SIZE, 4).linear
    };
    let (matte, faint, glossy) = (simple("0"), simple("1e-9"), simple("0.02"));
    assert_eq!(draw::differing(&matte, &faint), 0);
    assert!(draw::differing(&matte, &glossy) > 500);
}
