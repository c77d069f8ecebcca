//! The judge, judged: what it gives where the answer is known otherwise, and how it converges.

mod agreement;
mod known;

use super::accel::Accel;
use super::fibers::{RealiseSettings, RealisedFiber, realise};
use super::geometry::{FiberGeometry, Stored};
use super::integrator::{TraceSettings, Tracer};
use crate::scene::Scene;
use glam::DVec3;
use rayon::prelude::*;

/// Fibers of the scene at so large a chord error.
fn fibers(scene: &Scene, chord_error: f64) -> Vec<RealisedFiber> {
    realise(scene, &RealiseSettings { chord_error, ..Default::default() }).unwrap()
}

fn tracer<T: Stored>(
    scene: &Scene,
    fibers: Vec<RealisedFiber>,
    size: [u32; 2],
    settings: TraceSettings,
) -> Tracer<T> {
    let accel = Accel::new(FiberGeometry::<T>::new(fibers, scene.origin_mm)).unwrap();
    Tracer::new(scene, accel, size, settings)
}

/// A pixel's mean over some samples, the variance of that mean, and the share that met a fiber.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    mean: DVec3,
    variance: DVec3,
    covered: f64,
}

/// All pixels of a picture, row by row, from these samples.
fn picture<T: Stored>(tracer: &Tracer<T>, samples: std::ops::Range<u64>) -> Vec<Pixel> {
    let [width, height] = tracer.size();
    let count = (samples.end - samples.start) as f64;
    let pixel = |index: u32| {
        let (mut sum, mut squares, mut covered) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for sample in samples.clone() {
            let seen = tracer.sample([index % width, index / width], sample);
            sum += seen.radiance;
            squares += seen.radiance * seen.radiance;
            covered += f64::from(u8::from(seen.covered)) / count;
        }
        let mean = sum / count;
        let variance = (squares / count - mean * mean).max(DVec3::ZERO) / (count - 1.0).max(1.0);
        Pixel { mean, variance, covered }
    };
    (0..width * height).into_par_iter().map(pixel).collect()
}
