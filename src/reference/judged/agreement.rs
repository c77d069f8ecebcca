//! Pictures that must agree within their noise, and how that noise falls.

use super::{Pixel, fibers, picture, tracer};
use crate::reference::fibers::RealisedFiber;
use crate::reference::integrator::TraceSettings;
use crate::reference::test_scene::{scene_of, straight, yarn};
use crate::scene::Scene;
use glam::DVec3;

const SIZE: [u32; 2] = [24, 24];

/// Two hairy yarns close up, in the light of a lamp and of everywhere.
fn close_up() -> Scene {
    let text = "[camera]\ndistance_mm = 4\nfov_y_deg = 24\n[ambient]\nradiance = [0.3, 0.3, 0.3]";
    scene_of(text, &[straight(-4.0, 4.0, -0.4), straight(-4.0, 4.0, 0.4)], &yarn("cotton1", 40))
}

/// Difference of two pictures of independent samples in standard errors: of the whole, and the mean over pixels of
/// the square, where either saw a fiber.
fn apart(a: &[Pixel], b: &[Pixel]) -> (f64, f64) {
    let pairs = || a.iter().zip(b).filter(|(a, b)| (a.variance + b.variance).x > 0.0);
    let difference: f64 = pairs().map(|(a, b)| a.mean.x - b.mean.x).sum();
    let variance: f64 = pairs().map(|(a, b)| a.variance.x + b.variance.x).sum();
    let square = |(a, b): (&Pixel, &Pixel)| (a.mean.x - b.mean.x).powi(2) / (a.variance.x + b.variance.x);
    (difference / variance.sqrt(), pairs().map(square).sum::<f64>() / pairs().count() as f64)
}

fn coverage(pixels: &[Pixel]) -> f64 {
    pixels.iter().map(|p| p.covered).sum::<f64>() / pixels.len() as f64
}

fn trace(scene: &Scene, fibers: Vec<RealisedFiber>, samples: std::ops::Range<u64>) -> Vec<Pixel> {
    picture(&tracer::<f32>(scene, fibers, SIZE, TraceSettings::default()), samples)
}

#[test]
fn coarse_and_fine_pieces_agree_within_the_noise_and_a_wrong_radius_does_not() {
    let scene = close_up();
    let usual = trace(&scene, fibers(&scene, 0.1), 0..96);
    let fine = trace(&scene, fibers(&scene, 0.01), 96..192);
    let agree = |(whole, squares): (f64, f64)| whole.abs() < 3.5 && (0.7..1.25).contains(&squares);
    assert!(agree(apart(&usual, &fine)), "{:?}", apart(&usual, &fine));
    assert!((coverage(&usual) / coverage(&fine) - 1.0).abs() < 0.01);

    let mut thick = fibers(&scene, 0.1);
    thick.iter_mut().flat_map(|fiber| &mut fiber.radii_mm).for_each(|radius| *radius *= 1.3);
    let wrong = apart(&usual, &trace(&scene, thick, 96..192));
    assert!(!agree(wrong), "{wrong:?}");
}

#[test]
fn single_precision_storage_shows_what_double_does() {
    let scene = close_up();
    let single = tracer::<f32>(&scene, fibers(&scene, 0.1), SIZE, TraceSettings::default());
    let double = tracer::<f64>(&scene, fibers(&scene, 0.1), SIZE, TraceSettings::default());
    let (mut same, mut all, mut difference, mut sum) = (0.0, 0.0, 0.0, 0.0);
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            for sample in 0..8 {
                let [a, b] = [single.sample([x, y], sample), double.sample([x, y], sample)];
                let near = (a.radiance - b.radiance).length() < 1e-3 * (0.1 + b.radiance.length());
                same += f64::from(u8::from(near));
                all += 1.0;
                difference += a.radiance.x - b.radiance.x;
                sum += b.radiance.x;
            }
        }
    }
    // A ray may pass an edge on the other side.
    assert!(same / all > 0.99, "{same} of {all} samples are the same");
    assert!((difference / sum).abs() < 5e-3, "{}", difference / sum);
    assert!(same < all || difference != 0.0, "one of the two would not be what it says");
    assert!(single.accel().geometry().bytes() < double.accel().geometry().bytes());
}

#[test]
fn the_error_falls_with_the_square_root_of_the_samples() {
    let scene = close_up();
    let tracer = tracer::<f32>(&scene, fibers(&scene, 0.1), SIZE, TraceSettings::default());
    let truth = picture(&tracer, 1000..2400);
    let error = |samples: std::ops::Range<u64>| {
        let found = picture(&tracer, samples);
        let square = |(a, b): (&Pixel, &Pixel)| (a.mean - b.mean).length_squared();
        let mean = found.iter().zip(&truth).map(square).sum::<f64>() / found.len() as f64;
        // Less the noise of what it is compared with.
        let own = truth.iter().map(|p| p.variance.dot(DVec3::ONE)).sum::<f64>() / truth.len() as f64;
        (mean - own).sqrt()
    };
    let points = [0..1, 1..5, 5..21, 21..85, 85..341].map(|samples: std::ops::Range<u64>| {
        (((samples.end - samples.start) as f64).ln(), error(samples).ln())
    });
    let middle = |pick: fn(&(f64, f64)) -> f64| points.iter().map(pick).sum::<f64>() / points.len() as f64;
    let (x, y) = (middle(|p| p.0), middle(|p| p.1));
    let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let slope = covariance / points.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    assert!((slope + 0.5).abs() < 0.08, "{slope}: {points:?}");
}
