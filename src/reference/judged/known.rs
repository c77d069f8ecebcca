//! Scenes whose pictures are known without tracing.

use super::{fibers, picture, tracer};
use crate::bsdf::khungurn::{ambient_scattering, bcsdf_cos_of_directions};
use crate::math::angle::longitudinal_angle;
use crate::math::curve::Curve;
use crate::reference::integrator::TraceSettings;
use crate::reference::test_scene::{scene_of, yarn};
use crate::scene::Scene;
use crate::scene::camera::Camera;
use crate::yarn::params::YarnParams;
use glam::DVec3;
use std::f64::consts::PI;

const SIZE: [u32; 2] = [14, 14];
const FIBER_RADIUS: f64 = 0.01;

/// One straight fiber, slanting through the middle of the picture, its diameter the height of a view of 0.03 degrees;
/// `toward` leans to the eye.
fn one_fiber(text: &str, toward: f64, fov_y_deg: f64) -> (Scene, DVec3) {
    let single = YarnParams {
        ply_count: 1,
        fibers_per_ply: 1,
        ply_pitch_mm: None,
        fiber_pitch_mm: None,
        fiber_diameter_um: 2e3 * FIBER_RADIUS,
        ..yarn("cotton1", 1)
    };
    let along = DVec3::new(1.0, 0.4, toward).normalize();
    let points = (0..5).map(|k| 10.0 * (f64::from(k) - 2.0) * along).collect();
    let camera = "[camera]\ndistance_mm = 40\n";
    let mut scene = scene_of(&format!("{text}\n{camera}"), &[Curve { points, closed: false }], &single);
    // The fiber lies beside its yarn's centre line: around it from now on.
    let fiber = fibers(&scene, 0.1).remove(0);
    scene.origin_mm = fiber.points[0].lerp(fiber.points[fiber.points.len() - 1], 0.5);
    scene.file.camera.target_mm = Some((scene.origin_mm + DVec3::new(0.003, -0.002, 0.0)).to_array());
    scene.file.camera.fov_y_deg = fov_y_deg;
    (scene, along)
}

/// Where a ray meets the infinite round fiber through the origin: its normal there.
fn normal_at(along: DVec3, origin: DVec3, direction: DVec3) -> Option<DVec3> {
    let across = |v: DVec3| v - v.dot(along) * along;
    let (o, d) = (across(origin), across(direction));
    let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - FIBER_RADIUS * FIBER_RADIUS);
    let discriminant = b * b - a * c;
    (discriminant > 0.0).then(|| ((o + (-b - discriminant.sqrt()) / a * d) / FIBER_RADIUS).normalize())
}

/// Mean of `f(normal, to_eye)` over each pixel by the midpoint rule, 0 beside the fiber.
fn over_pixels(camera: &Camera, along: DVec3, f: impl Fn(DVec3, DVec3) -> DVec3) -> Vec<DVec3> {
    const STEPS: u32 = 24;
    let pixel = |index: u32| {
        let corner = [index % SIZE[0], index / SIZE[0]];
        let mut sum = DVec3::ZERO;
        for k in 0..STEPS * STEPS {
            let place = [0, 1].map(|axis| {
                let inside = (f64::from([k % STEPS, k / STEPS][axis]) + 0.5) / f64::from(STEPS);
                2.0 * (f64::from(corner[axis]) + inside) / f64::from(SIZE[axis]) - 1.0
            });
            let half = camera.half_extent;
            let view = DVec3::new(place[0] * half.x, -place[1] * half.y, -1.0).normalize();
            let direction = camera.world_from_view * view;
            if let Some(normal) = normal_at(along, camera.eye_world, direction) {
                sum += f(normal, -direction) / f64::from(STEPS * STEPS);
            }
        }
        sum
    };
    (0..SIZE[0] * SIZE[1]).map(pixel).collect()
}

/// How far a picture is from the exact one: of the whole, and the mean over pixels of the square, both in standard
/// errors; the exact picture's own grid may err by a `grid` share of its brightest pixel.
fn off(found: &[super::Pixel], exact: &[DVec3], grid: f64) -> (f64, f64) {
    let peak = exact.iter().map(|e| e.x).fold(0.0, f64::max);
    let error = |p: &super::Pixel| p.variance.x + (grid * peak).powi(2);
    let seen: Vec<_> = found.iter().zip(exact).filter(|(p, e)| p.mean.x > 0.0 || e.x > 0.0).collect();
    let squares: f64 = seen.iter().map(|(p, e)| (p.mean.x - e.x).powi(2) / error(p)).sum();
    let difference: f64 = seen.iter().map(|(p, e)| p.mean.x - e.x).sum();
    let variance: f64 = seen.iter().map(|(p, _)| error(p)).sum();
    (difference / variance.sqrt(), squares / seen.len() as f64)
}

#[test]
fn a_straight_fiber_under_one_light_is_the_integral_of_its_formula_over_each_pixel() {
    // From the viewer's side, and from behind, through the fiber.
    for light in [DVec3::new(0.5, -0.6, -1.0), DVec3::new(-0.1, 0.15, 1.0)] {
        let [x, y, z] = light.to_array();
        let text = format!(
            "[ambient]\nradiance = [0, 0, 0]\n[[light]]\nirradiance = [2.0, 1.0, 0.5]\ndirection = [{x:?}, {y:?}, {z:?}]"
        );
        let (scene, along) = one_fiber(&text, 0.3, 0.1);
        let trace = |settings: TraceSettings| {
            picture(&tracer::<f32>(&scene, fibers(&scene, 0.1), SIZE, settings), 0..512)
        };
        let fiber = &scene.fabrics[0].fiber;
        let (scattering, diffuse) = (fiber.scattering(), DVec3::from_array(fiber.diffuse()));
        let to_light = -light.normalize();
        let irradiance = DVec3::new(2.0, 1.0, 0.5);
        let radiance = |normal: DVec3, to_eye: DVec3| {
            let lobes = bcsdf_cos_of_directions(along, to_light, to_eye, 0.0, &scattering).sum();
            irradiance * (lobes + diffuse * normal.dot(to_light).max(0.0) / PI)
        };
        let exact = over_pixels(&scene.camera(SIZE), along, radiance);
        let found = trace(TraceSettings::default());
        let (whole, squares) = off(&found, &exact, 2e-3);
        assert!(whole.abs() < 4.0 && (0.3..1.5).contains(&squares), "{light}: {whole} {squares}");
        // The test sees an error of 3%.
        let wrong: Vec<DVec3> = exact.iter().map(|e| 1.03 * *e).collect();
        assert!(off(&found, &wrong, 2e-3).0.abs() > 6.0, "{light}");
        // A straight fiber shadows nothing of itself, however little of it a ray ignores.
        let settings = TraceSettings { own_fiber_diameters: 0.0, ..Default::default() };
        let (whole, squares) = off(&trace(settings), &exact, 2e-3);
        assert!(whole.abs() < 4.0 && (0.3..1.5).contains(&squares), "{light}: {whole} {squares}");
    }
}

#[test]
fn a_fiber_in_a_furnace_gives_the_model_s_ambient_integral() {
    for toward in [0.0, 1.0, 3.0] {
        let (scene, along) = one_fiber("light = []\n[ambient]\nradiance = [1, 1, 1]", toward, 0.01);
        let found =
            picture(&tracer::<f32>(&scene, fibers(&scene, 0.1), SIZE, TraceSettings::default()), 0..160);
        let fiber = &scene.fabrics[0].fiber;
        let (scattering, diffuse) = (fiber.scattering(), DVec3::from_array(fiber.diffuse()));
        // The fiber fills the picture, and all of it is seen from one angle.
        let to_eye = DVec3::Z;
        let exact_here = diffuse + ambient_scattering(longitudinal_angle(along, to_eye), &scattering).sum();
        let exact = vec![exact_here; found.len()];
        // The integral over theta_i is one over the sphere too.
        let sphere =
            sphere_integral(along, |w| bcsdf_cos_of_directions(along, w, to_eye, 0.0, &scattering).sum().x);
        assert!((sphere + diffuse.x - exact_here.x).abs() < 2e-3, "{sphere} {exact_here}");
        let (whole, squares) = off(&found, &exact, 2e-3);
        assert!(whole.abs() < 4.0 && (0.3..1.5).contains(&squares), "{toward}: {whole} {squares}");
        let wrong: Vec<DVec3> = exact.iter().map(|e| 1.03 * *e).collect();
        assert!(off(&found, &wrong, 2e-3).0.abs() > 5.0, "{toward}: an error of 3% is seen");
    }
}

/// By the midpoint rule over theta and phi.
fn sphere_integral(along: DVec3, f: impl Fn(DVec3) -> f64) -> f64 {
    const STEPS: u32 = 180;
    let x = along.any_orthonormal_vector();
    let y = along.cross(x);
    let step = PI / f64::from(STEPS);
    let mut sum = 0.0;
    for i in 0..STEPS * STEPS {
        let theta = (f64::from(i / STEPS) + 0.5) * step - 0.5 * PI;
        let (s, c) = (2.0 * (f64::from(i % STEPS) + 0.5) * step).sin_cos();
        let w = theta.sin() * along + theta.cos() * (c * x + s * y);
        sum += 2.0 * step * step * theta.cos() * f(w);
    }
    sum
}

#[test]
fn a_block_of_white_fibers_in_a_furnace_gives_no_more_than_it_gets() {
    let text = "light = []\n[ambient]\nradiance = [1, 1, 1]\n[shading]\nspecular = false\n\
                [camera]\ndistance_mm = 3\nfov_y_deg = 10";
    let curve = crate::reference::test_scene::straight(-4.0, 4.0, 0.0);
    let mut scene = scene_of(text, &[curve], &yarn("cotton1", 60));
    scene.fabrics[0].fiber.diffuse = Some([1.0; 3]);
    let albedo = |bounces: u32, samples: u64| {
        let settings = TraceSettings { bounces, ..Default::default() };
        let found = picture(&tracer::<f32>(&scene, fibers(&scene, 0.1), SIZE, settings), 0..samples);
        let covered: f64 = found.iter().map(|p| p.covered).sum();
        let radiance: f64 = found.iter().map(|p| p.mean.x).sum();
        let error = found.iter().map(|p| p.variance.x).sum::<f64>().sqrt();
        (radiance / covered, error / covered)
    };
    let (single, _) = albedo(0, 8);
    let (few, _) = albedo(2, 8);
    let (all, error) = albedo(1000, 24);
    assert!(single < 0.7 && single < few && few < all, "{single} {few} {all}");
    // All light comes back: nothing is lost, and nothing is made.
    assert!((all - 1.0).abs() < 4.0 * error + 0.01 && error < 0.02, "{all} +- {error}");
}
