use super::*;
use crate::io::picture::LinearImage;
use crate::math::frame::any_perpendicular;
use crate::math::rng::Rng;
use crate::reference::test_scene::{scene_of, straight, yarn};
use std::sync::Arc;

const MODELS: [&str; 4] =
    ["", "[shading]\nmodel = 'simple'", "[shading]\nspecular = false", "[shading]\ndiffuse = false"];

fn material_and_sky(text: &str, picture: bool) -> (Material, Sky) {
    let mut scene = scene_of(text, &[straight(0.0, 1.0, 0.0)], &yarn("cotton1", 1));
    if picture {
        let mut image = LinearImage::filled(16, 8, [0.2, 0.2, 0.2, 1.0]);
        image.pixels[37] = [20.0, 10.0, 5.0, 1.0];
        scene.environment = Some(Arc::new(image));
    }
    (Material::new(&scene.file.shading, &scene.fabrics[0]), Sky::new(&scene))
}

fn meeting(theta_o: f64) -> Meeting {
    let tangent = DVec3::new(0.6, 0.64, 0.48);
    let across = any_perpendicular(tangent);
    let normal = (across + 0.7 * tangent.cross(across)).normalize();
    Meeting { tangent, normal, to_eye: theta_o.cos() * across + theta_o.sin() * tangent }
}

/// The integral over all directions by the midpoint rule about the tangent.
fn over_sphere(meeting: &Meeting, f: impl Fn(DVec3) -> f64) -> f64 {
    const STEPS: u32 = 180;
    let [x, y] = across(meeting);
    let step = PI / f64::from(STEPS);
    let mut sum = 0.0;
    for i in 0..STEPS {
        let theta = (f64::from(i) + 0.5) * step - FRAC_PI_2;
        for j in 0..STEPS {
            let (s, c) = ((f64::from(j) + 0.5) * 2.0 * step).sin_cos();
            let w = theta.sin() * meeting.tangent + theta.cos() * (c * x + s * y);
            sum += f(w) * theta.cos() * 2.0 * step * step;
        }
    }
    sum
}

#[test]
fn densities_integrate_to_one_and_draws_to_the_integral_of_what_is_scattered() {
    for text in MODELS {
        for picture in [false, true] {
            let (material, sky) = material_and_sky(text, picture);
            for theta_o in [0.0, 0.9] {
                let meeting = meeting(theta_o);
                let whole = over_sphere(&meeting, |w| material.pdf(&meeting, &sky, w));
                assert!((whole - 1.0).abs() < 0.01, "{text} {picture} {theta_o}: density {whole}");
                let light = |w: DVec3| (material.scatter_sky(&meeting, w) * sky.radiance(w)).element_sum();
                let exact = over_sphere(&meeting, light);
                let count = 4000;
                let values = (0..count).map(|k| {
                    let mut rng = Rng::new(6, &[k]);
                    let u = std::array::from_fn(|_| rng.uniform());
                    material.sample(&meeting, &sky, u).map_or(0.0, |(w, pdf)| light(w) / pdf)
                });
                let (sum, squares) = values.fold((0.0, 0.0), |(s, q), v| (s + v, q + v * v));
                let mean = sum / count as f64;
                let error = ((squares / count as f64 - mean * mean) / count as f64).sqrt();
                let off = (mean - exact) / (error + 0.003 * exact);
                assert!(off.abs() < 4.0, "{text} {picture} {theta_o}: {mean} +- {error}, exactly {exact}");
            }
        }
    }
}

#[test]
fn lobes_are_those_that_the_scene_asks_for() {
    let at = |text: &str| {
        let (material, _) = material_and_sky(text, false);
        let m = meeting(0.2);
        // In front of the fiber and behind it.
        [m.normal, -m.normal].map(|w| (material.scatter(&m, w).x, material.scatter_sky(&m, w).x))
    };
    let [physical, simple, diffuse, highlight] = MODELS.map(at);
    assert!(diffuse[0].0 > 0.1 && diffuse[1] == (0.0, 0.0));
    assert!((physical[0].0 - diffuse[0].0 - highlight[0].0).abs() < 1e-15 && highlight[1].0 > 0.0);
    assert!(simple[0].0 > diffuse[0].0 && simple[0].1 == diffuse[0].0, "no simple highlight of the sky");
    assert!((0..2).all(|k| physical[k].0 == physical[k].1));
    let (nothing, sky) = material_and_sky("[shading]\ndiffuse = false\nspecular = false", false);
    assert_eq!(nothing.scatter(&meeting(0.1), DVec3::X), DVec3::ZERO);
    assert!(nothing.sample(&meeting(0.1), &sky, [0.3; 4]).is_some(), "something is drawn all the same");
}
