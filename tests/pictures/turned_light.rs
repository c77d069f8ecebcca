//! Light turned around a straight yarn: the mean brightness against that of its f64 model.

use crate::device::shared;
use crate::draw::{mean_channel, scene, yarn};
use crate::strand_judge::{Seen, seen};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};
use worsted::bsdf::khungurn::{FiberScattering, azimuthal_tt, longitudinal_normaliser};
use worsted::bsdf::params::FiberParams;
use worsted::bsdf::simple::{simple_diffuse, simple_specular_cos};
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::curves::Basis;
use worsted::io::picture::LinearImage;
use worsted::math::angle::{cos_half_azimuth, longitudinal_angle};
use worsted::scene::light::LightTable;
use worsted::vulkan::DeviceChoice;

/// A fiber is 1.04 pixels wide, and the yarn reaches past the picture's sides.
const SIZE: [u32; 2] = [160, 72];
const SETS: [&str; 16] = [
    "shadow.map=false",
    "shadow.self=false",
    "yarn.fibers_per_ply=48",
    "yarn.loop_density_per_mm=0",
    "yarn.hair_density_per_mm=0",
    "ambient.radiance=[0, 0, 0]",
    "occlusion.mode=\"none\"",
    "camera.yaw_deg=0",
    "camera.pitch_deg=0",
    "camera.distance_mm=60",
    "camera.fov_y_deg=2.3",
    "camera.target_mm=[0, 0, 0]",
    "debug.fibers=\"every\"",
    "fiber.c_r=[0.05, 0.05, 0.05]",
    "fiber.c_tt=[0.8, 0.8, 0.8]",
    "fiber.diffuse=[0.3, 0.3, 0.3]",
];
/// Most difference of the mean brightness, as a share of the largest on the curve.
const MOST_DIFFERENCE: f64 = 0.01;
const STEPS: u32 = 360;

/// The longitudinal normaliser by quadrature, at angles close enough that a straight line between them will do.
struct Normaliser(Vec<f64>);

impl Normaliser {
    const STEPS: usize = 2000;

    fn new(width: f64) -> Self {
        let at = |i: usize| longitudinal_normaliser(PI * i as f64 / Self::STEPS as f64 - FRAC_PI_2, width);
        Self((0..=Self::STEPS).map(at).collect())
    }

    fn at(&self, theta: f64) -> f64 {
        let place = (theta + FRAC_PI_2) / PI * Self::STEPS as f64;
        let i = (place as usize).min(Self::STEPS - 1);
        let share = place - i as f64;
        self.0[i] * (1.0 - share) + self.0[i + 1] * share
    }
}

/// Khungurn's lobes, grey, written out.
fn physical(seen: &Seen, to_light: DVec3, fiber: &FiberScattering, normalisers: &[Normaliser; 2]) -> f64 {
    let theta_i = longitudinal_angle(seen.tangent, to_light);
    let sum = theta_i + longitudinal_angle(seen.tangent, seen.to_eye);
    let lobe = |width: f64, normaliser: &Normaliser| {
        (-0.5 * (sum / width).powi(2)).exp() / (width * (2.0 * PI).sqrt()) / normaliser.at(-theta_i)
    };
    let f = fiber.c_r.x + (1.0 - fiber.c_r.x) * (1.0 - theta_i.cos()).powi(5);
    let r = f * lobe(fiber.beta_r, &normalisers[0]) / (2.0 * PI);
    let azimuth = azimuthal_tt(cos_half_azimuth(seen.tangent, to_light, seen.to_eye), fiber.gamma_tt);
    let tt = (1.0 - f) * fiber.c_tt.x * lobe(fiber.beta_tt, &normalisers[1]) * azimuth;
    (r + tt) * theta_i.cos()
}

/// What the yarn's fibers send to the eye on average under light of irradiance 1, for each direction.
fn expected(all: &[Seen], fiber: &FiberParams, is_physical: bool, lights: &[DVec3]) -> Vec<f64> {
    let lobes = fiber.scattering();
    let normalisers = [lobes.beta_r, lobes.beta_tt].map(Normaliser::new);
    let diffuse = DVec3::from_array(fiber.diffuse());
    let one = |seen: &Seen, light: DVec3| {
        let shine = if is_physical {
            physical(seen, light, &lobes, &normalisers)
        } else {
            fiber.specular()[0]
                * simple_specular_cos(seen.tangent, light, seen.to_eye, fiber.specular_width(), 0.0)
        };
        shine + simple_diffuse(diffuse, seen.normals, seen.side, seen.toward, light).x
    };
    let mean = |&light: &DVec3| all.iter().map(|seen| one(seen, light)).sum::<f64>() / all.len() as f64;
    lights.iter().map(mean).collect()
}

/// The same from pictures.
fn drawn(sets: &[&str], lights: &[DVec3]) -> Vec<f64> {
    let device = shared(DeviceChoice::Software);
    let request =
        Request { size: SIZE, sampling: Sampling::new(4).unwrap(), statistics: false, profile: false };
    let light = |to_light: DVec3| LightTable {
        direction: Some((-to_light).to_array()),
        irradiance: Some([1.0; 3]),
        ..Default::default()
    };
    let mut renderer = Renderer::new(device, straight(sets), request).unwrap();
    lights
        .iter()
        .map(|&to_light| {
            renderer.set_lights(vec![light(to_light)]).unwrap();
            let picture = renderer.render(&|_| ()).unwrap();
            let linear = LinearImage { width: SIZE[0], height: SIZE[1], pixels: picture.linear };
            linear.check_finite().unwrap();
            mean_channel(&linear, 0)
        })
        .collect()
}

fn straight(sets: &[&str]) -> worsted::scene::Scene {
    let points: Vec<[f64; 3]> = (-10..=10).map(|i| [2.0 * f64::from(i), 0.0, 0.0]).collect();
    scene(&yarn(Basis::CatmullRom, &points), &[&SETS[..], sets].concat())
}

/// Directions to a light that goes once around an axis perpendicular to Z, from the eye's side.
fn turn(axis: DVec3) -> Vec<DVec3> {
    let across = axis.cross(DVec3::Z);
    let at = |i: u32| {
        let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(STEPS)).sin_cos();
        cos * DVec3::Z + sin * across
    };
    (0..STEPS).map(at).collect()
}

/// Largest difference of two curves as a share of the second's largest value.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    let most = expected.iter().copied().fold(0.0, f64::max);
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs() / most);
    differences.fold(0.0, |most, d| if d > most || d.is_nan() { d } else { most })
}

#[test]
fn brightness_follows_the_model_as_light_turns_around_a_straight_yarn() {
    for (model, is_physical) in [("simple", false), ("physical", true)] {
        let sets = [format!("shading.model=\"{model}\"")];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let scene = straight(&sets);
        let all = seen(&scene, SIZE);
        assert!(all.len() > 5000, "the rays miss the yarn: {} hits", all.len());
        for (name, axis) in [("along the yarn", DVec3::X), ("across the yarn", DVec3::Y)] {
            let lights = turn(axis);
            let expected = expected(&all, &scene.fabrics[0].fiber, is_physical, &lights);
            let found = drawn(&sets, &lights);
            let off = difference(&found, &expected);
            println!("{model}, light turned about an axis {name}: {off:.4} of the largest");
            assert!(off <= MOST_DIFFERENCE, "{model} {name}: {off}");
            // The comparison must see a light that is 3 degrees late.
            let mut late = found.clone();
            late.rotate_right(3);
            assert!(difference(&late, &expected) > MOST_DIFFERENCE, "{model} {name}");
        }
    }
}
