//! A picture in the making: sums of samples, pass after pass over tiles, on all cores.
//!
//! Whatever the number of threads and wherever it is stopped, a pixel adds up the same samples in the same order.

use super::geometry::Stored;
use super::integrator::Tracer;
use crate::io::measured::MeasuredImage;
use crate::io::picture::LinearImage;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use rayon::prelude::*;

/// Samples of a pixel in one pass over the picture.
pub const SAMPLES_PER_PASS: u64 = 4;
/// Pixels of a tile's side.
const TILE: u32 = 16;

/// What a pixel's samples add up to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PixelSums {
    radiance: [f64; 3],
    squares: [f64; 3],
    covered: u64,
    samples: u64,
}

impl PixelSums {
    fn add(&mut self, radiance: DVec3, covered: bool) {
        for (channel, value) in radiance.to_array().into_iter().enumerate() {
            self.radiance[channel] += value;
            self.squares[channel] += value * value;
        }
        self.covered += u64::from(covered);
        self.samples += 1;
    }

    fn mean(&self) -> [f32; 4] {
        let count = self.samples.max(1) as f64;
        let [r, g, b] = self.radiance.map(|sum| (sum / count) as f32);
        [r, g, b, (self.covered as f64 / count) as f32]
    }

    /// Of the mean; of one sample nobody knows it.
    fn variance(&self) -> Option<[f32; 3]> {
        let count = self.samples as f64;
        let of = |channel: usize| {
            let about_mean = self.squares[channel] - self.radiance[channel].powi(2) / count;
            (about_mean.max(0.0) / (count * (count - 1.0))) as f32
        };
        (self.samples > 1).then(|| std::array::from_fn(of))
    }
}

/// How far a picture is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Tally {
    /// Tiles done, of all passes.
    pub tiles: u64,
    /// Rays traced.
    pub rays: u64,
    /// Samples that were no finite number, and count as black.
    pub not_finite: u64,
}

/// A picture in the making.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendering {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Row by row from the top.
    pub pixels: Vec<PixelSums>,
    /// What was done for it.
    pub tally: Tally,
}

impl Rendering {
    /// Nothing yet.
    pub fn new(size: [u32; 2]) -> Self {
        let pixels = vec![PixelSums::default(); size[0] as usize * size[1] as usize];
        Self { size, pixels, tally: Tally::default() }
    }

    fn tiles_across(&self) -> u64 {
        u64::from(self.size[0].div_ceil(TILE))
    }

    /// Tiles of the whole picture.
    pub fn tiles_per_pass(&self) -> u64 {
        self.tiles_across() * u64::from(self.size[1].div_ceil(TILE))
    }

    /// Whole passes done.
    pub fn passes(&self) -> u64 {
        self.tally.tiles / self.tiles_per_pass()
    }

    /// Samples that every pixel has.
    pub fn samples(&self) -> u64 {
        self.pixels.iter().map(|pixel| pixel.samples).min().unwrap_or(0)
    }

    /// Share of `samples` per pixel that is done, 0 to 1.
    pub fn share(&self, samples: u64) -> f64 {
        let passes = samples.div_ceil(SAMPLES_PER_PASS).max(1);
        (self.tally.tiles as f64 / (passes * self.tiles_per_pass()) as f64).min(1.0)
    }

    /// Whether every pixel has its samples.
    pub fn is_done(&self, samples: u64) -> bool {
        self.passes() >= samples.div_ceil(SAMPLES_PER_PASS)
    }

    /// Adds at most `tiles` tiles, all of one pass, toward `samples` per pixel.
    pub fn advance<T: Stored>(&mut self, tracer: &Tracer<T>, samples: u64, tiles: u64) {
        if self.is_done(samples) {
            return;
        }
        let pass = self.passes();
        let first = self.tally.tiles % self.tiles_per_pass();
        let last = (first + tiles).min(self.tiles_per_pass());
        let until = (SAMPLES_PER_PASS * (pass + 1)).min(samples);
        let done: Vec<_> =
            (first..last).into_par_iter().map(|tile| self.trace_tile(tracer, tile, until)).collect();
        for (pixels, tally) in done {
            for (index, sums) in pixels {
                self.pixels[index] = sums;
            }
            self.tally.rays += tally.rays;
            self.tally.not_finite += tally.not_finite;
        }
        self.tally.tiles += last - first;
    }

    /// The tile's pixels with `until` samples each.
    fn trace_tile<T: Stored>(
        &self,
        tracer: &Tracer<T>,
        tile: u64,
        until: u64,
    ) -> (Vec<(usize, PixelSums)>, Tally) {
        let [width, height] = self.size;
        let corner = [tile % self.tiles_across(), tile / self.tiles_across()].map(|n| n as u32 * TILE);
        let mut tally = Tally::default();
        let mut pixels = Vec::with_capacity((TILE * TILE) as usize);
        for y in corner[1]..(corner[1] + TILE).min(height) {
            for x in corner[0]..(corner[0] + TILE).min(width) {
                let index = y as usize * width as usize + x as usize;
                let mut sums = self.pixels[index];
                for sample in sums.samples..until {
                    let seen = tracer.sample([x, y], sample);
                    tally.rays += seen.rays;
                    tally.not_finite += u64::from(!seen.radiance.is_finite());
                    let radiance = if seen.radiance.is_finite() { seen.radiance } else { DVec3::ZERO };
                    sums.add(radiance, seen.covered);
                }
                pixels.push((index, sums));
            }
        }
        (pixels, tally)
    }

    /// The picture as it is now.
    pub fn measured(&self) -> MeasuredImage {
        let [width, height] = self.size;
        let pixels = self.pixels.iter().map(PixelSums::mean).collect();
        let variance = self.pixels.iter().map(PixelSums::variance).collect();
        MeasuredImage { mean: LinearImage { width, height, pixels }, variance }
    }

    /// Mean over all pixels and colours of the variance of a pixel's mean.
    pub fn mean_variance(&self) -> Option<f64> {
        let sum = |v: [f32; 3]| v.into_iter().map(f64::from).sum::<f64>();
        let all = self.pixels.iter().map(|p| p.variance().map(sum)).sum::<Option<f64>>();
        all.map(|all| all / (3.0 * self.pixels.len().max(1) as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_give_the_mean_its_variance_and_the_coverage() {
        let mut sums = PixelSums::default();
        assert_eq!((sums.mean(), sums.variance()), ([0.0; 4], None));
        sums.add(DVec3::new(1.0, 0.0, 3.0), true);
        assert_eq!(sums.variance(), None);
        sums.add(DVec3::new(3.0, 0.0, 3.0), true);
        sums.add(DVec3::new(5.0, 0.0, 3.0), false);
        assert_eq!(sums.mean(), [3.0, 0.0, 3.0, 2.0 / 3.0]);
        // Variance 4 of a sample, of three of them a third.
        let [r, g, b] = sums.variance().unwrap();
        assert!((r - 4.0 / 3.0).abs() < 1e-6 && g == 0.0 && b.abs() < 1e-6, "{r} {g} {b}");
    }

    #[test]
    fn tiles_cover_a_picture_of_any_size_once() {
        let rendering = Rendering::new([33, 17]);
        assert_eq!(rendering.tiles_per_pass(), 6);
        assert!(!rendering.is_done(1) && rendering.is_done(0));
        let mut halfway = rendering.clone();
        halfway.tally.tiles = 9;
        assert_eq!((halfway.passes(), halfway.share(12)), (1, 0.5));
        assert!(halfway.is_done(4) && !halfway.is_done(5));
    }
}
