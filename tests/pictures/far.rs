//! The same cloth wherever in the world it is.

use glam::DVec3;
use worsted::io::curves::CurveSet;
use worsted::io::picture::LinearImage;
use worsted::math::tone::Display;
use worsted::metrics::error::compare;
use worsted::scene::{Scene, SceneFile};

use crate::draw::{draw, swatch};

const SIZE: [u32; 2] = [112, 84];
const SAMPLES: u32 = 16;
/// Most FLIP between the same cloth here and a kilometre away.
const MOST_FLIP: f64 = 0.005;
const KILOMETRE: DVec3 = DVec3::new(0.8e6, -0.36e6, 0.48e6);

fn file(target: DVec3) -> SceneFile {
    let text = format!(
        "yarn.fibers_per_ply = 40\n[camera]\nyaw_deg = 18\npitch_deg = 12\ndistance_mm = 26\ntarget_mm = [{:?}, {:?}, {:?}]\n\
         [[light]]\nkind = \"directional\"\n[[light]]\nkind = \"point\"\nposition_mm = [{:?}, {:?}, {:?}]\nintensity = [0.01, 0.01, 0.01]\n",
        target.x,
        target.y,
        target.z,
        target.x + 30.0,
        target.y + 40.0,
        target.z + 50.0
    );
    toml::from_str(&text).unwrap()
}

fn moved(by: DVec3) -> CurveSet {
    let mut set = swatch();
    set.curves.iter_mut().flat_map(|curve| &mut curve.points).for_each(|p| *p += by);
    set
}

/// The swatch at `at`, seen from near by, with `others` in the scene.
fn pictured(at: DVec3, others: &[DVec3]) -> LinearImage {
    let scene = |by: DVec3| Scene::of_curves(file(at), moved(by), "swatch").unwrap();
    let mut all = scene(at);
    all.fabrics.extend(others.iter().flat_map(|other| scene(*other).fabrics));
    // As a file would have it that names them all.
    let fabrics = std::mem::take(&mut all.fabrics);
    draw(Scene::of_fabrics(all.file, fabrics).unwrap(), SIZE, SAMPLES).linear
}

fn flip(a: &LinearImage, b: &LinearImage) -> f64 {
    compare(a, b, &Display::default()).unwrap().error.covered.flip_mean
}

#[test]
fn a_kilometre_away_the_same_cloth_is_the_same_picture() {
    let here = pictured(DVec3::ZERO, &[]);
    let away = flip(&here, &pictured(KILOMETRE, &[]));
    println!("a kilometre away: mean FLIP {away:.5}");
    assert!(away <= MOST_FLIP, "mean FLIP {away}");
}

#[test]
fn cloth_a_kilometre_apart_is_the_same_from_near_by_each() {
    let (here, there) = (pictured(DVec3::ZERO, &[]), [KILOMETRE]);
    let (near, far) = (pictured(DVec3::ZERO, &there), pictured(KILOMETRE, &[DVec3::ZERO]));
    let (near, far) = (flip(&here, &near), flip(&here, &far));
    println!("the first of two: mean FLIP {near:.5}, the other: {far:.5}");
    assert!(near <= MOST_FLIP && far <= MOST_FLIP, "mean FLIP {near} and {far}");
}

#[test]
fn the_comparison_sees_what_f32_would_lose() {
    // As if positions were not taken relative to anything: rounded to f32 a kilometre away.
    let here = pictured(DVec3::ZERO, &[]);
    let mut rounded = moved(KILOMETRE);
    for point in rounded.curves.iter_mut().flat_map(|curve| &mut curve.points) {
        *point = point.as_vec3().as_dvec3();
    }
    let scene = Scene::of_curves(file(KILOMETRE), rounded, "swatch").unwrap();
    let lost = flip(&here, &draw(scene, SIZE, SAMPLES).linear);
    println!("rounded to f32 a kilometre away: mean FLIP {lost:.5}");
    assert!(lost > MOST_FLIP, "mean FLIP {lost}");
}
