//! Uniform light on cloth that absorbs nothing.

use crate::draw::{draw, scene, swatch};
use std::f64::consts::FRAC_PI_2;
use worsted::bsdf::khungurn::ambient_scattering;
use worsted::bsdf::params::FiberParams;
use worsted::io::picture::LinearImage;

const SIZE: [u32; 2] = [120, 90];
const SETS: [&str; 6] = [
    "light=[]",
    "ambient.radiance=[1, 1, 1]",
    "occlusion.mode=\"none\"",
    "shadow.self=false",
    "camera.distance_mm=14",
    "camera.target_mm=[0, 0, 0]",
];
/// What the tables and half a pixel's rounding may add.
const SLACK: f64 = 2e-3;

/// The brightest that the model's fibers are in uniform light of radiance 1, at any angle.
fn furnace_value(fiber: &FiberParams) -> f64 {
    let lobes = fiber.scattering();
    let at = |i: u32| ambient_scattering(FRAC_PI_2 * f64::from(i) / 200.0, &lobes).sum().max_element();
    (0..=200).map(at).fold(0.0, f64::max) + fiber.diffuse().into_iter().fold(0.0, f64::max)
}

/// The brightest that the yarn of any pixel is.
fn brightest(picture: &LinearImage) -> f64 {
    let covered = picture.pixels.iter().filter(|pixel| pixel[3] > 0.0);
    covered.map(|p| f64::from(p[0].max(p[1]).max(p[2]) / p[3])).fold(0.0, f64::max)
}

#[test]
fn nothing_in_a_furnace_is_brighter_than_the_model() {
    for (name, fiber) in [
        ("reflection", ["fiber.c_r=[1, 1, 1]", "fiber.c_tt=[1, 1, 1]", "fiber.diffuse=[0, 0, 0]"]),
        ("wool", ["fiber.c_r=[0.05, 0.05, 0.05]", "fiber.c_tt=[1, 1, 1]", "fiber.diffuse=[0, 0, 0]"]),
        ("diffuse", ["fiber.c_r=[0, 0, 0]", "fiber.c_tt=[0, 0, 0]", "fiber.diffuse=[1, 1, 1]"]),
        ("all", ["fiber.c_r=[0.3, 0.3, 0.3]", "fiber.c_tt=[1, 1, 1]", "fiber.diffuse=[1, 1, 1]"]),
    ] {
        for widths in
            [["fiber.beta_r_deg=1", "fiber.beta_tt_deg=5"], ["fiber.beta_r_deg=20", "fiber.beta_tt_deg=40"]]
        {
            let sets = [&SETS[..], &fiber, &widths].concat();
            let scene_drawn = scene(&swatch(), &sets);
            let most = furnace_value(&scene_drawn.fabrics[0].fiber);
            let found = brightest(&draw(scene_drawn, SIZE, 4).linear);
            println!("{name} {widths:?}: {found:.4}, the model {most:.4}");
            assert!(found <= most * (1.0 + SLACK), "{name} {widths:?}: {found} above {most}");
            // The furnace is lit: some fiber is nearly as bright as the model's brightest angle, often end-on.
            assert!(found >= 0.8 * most, "{name} {widths:?}: only {found} of {most}");
            let brighter = scene(&swatch(), &[&sets[..], &["ambient.radiance=[1.3, 1.3, 1.3]"]].concat());
            assert!(
                brightest(&draw(brighter, SIZE, 4).linear) > most * (1.0 + SLACK),
                "{name}: a leak passes"
            );
        }
    }
}
