//! The error of a picture against a reference: FLIP on what a display shows, squared errors on radiance.

use serde::Serialize;

use crate::io::picture::{DisplayImage, LinearImage};
use crate::math::tone::Display;
use crate::metrics::coverage::Coverage;
use crate::metrics::flip::FlipMap;
use crate::metrics::{MetricError, Side, check_linear};

/// What keeps the relative error of a black reference finite, in units of radiance (as pbrt-v4's MRSE has it).
const RELATIVE_FLOOR: f64 = 0.01;

/// The error over one set of pixels. Squared errors are means over pixels and red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RegionError {
    /// Pixels averaged over, at least 1.
    pub pixels: usize,
    /// Mean LDR-FLIP in [0, 1].
    pub flip_mean: f64,
    /// Largest LDR-FLIP in [0, 1].
    pub flip_max: f64,
    /// Mean squared error of linear radiance at exposure 1.
    pub mse: f64,
    /// Mean of `((test - reference) / (|reference| + 0.01))^2` on linear radiance.
    pub relative_mse: f64,
    /// `10 log10(1 / mse)`: the peak is radiance 1, a display's white. Infinite where `mse` is 0.
    pub psnr_db: f64,
}

/// The error of a picture: where yarn is, and everywhere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PictureError {
    /// Over the pixels covered by yarn in either picture: the figure to quote.
    pub covered: RegionError,
    /// Over all pixels, empty background included.
    pub whole: RegionError,
}

/// The figures of a comparison and the map they come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The figures.
    pub error: PictureError,
    /// FLIP of every pixel, for heatmaps.
    pub flip: FlipMap,
}

/// Compares `test` with `reference`. FLIP sees both as `display` shows them, over black; the squared errors see
/// the radiance as it is. Not symmetric: the relative error and FLIP's
/// name for the sides depend on which is the reference.
pub fn compare(
    test: &LinearImage,
    reference: &LinearImage,
    display: &Display,
) -> Result<Comparison, MetricError> {
    check_linear(test, reference)?;
    let covered = Coverage::of_linear(test, reference)?;
    let whole = Coverage::everywhere(test.pixels.len())?;
    let shown_test =
        DisplayImage::from_linear(test, display).map_err(|e| MetricError::display(Side::Test, e))?;
    let shown_reference = DisplayImage::from_linear(reference, display)
        .map_err(|e| MetricError::display(Side::Reference, e))?;
    let flip = FlipMap::new(&shown_test, &shown_reference)?;
    let error = PictureError {
        covered: region_error(test, reference, &flip, &covered)?,
        whole: region_error(test, reference, &flip, &whole)?,
    };
    Ok(Comparison { error, flip })
}

/// The figures over one set of pixels of two pictures that [`check_linear`] has passed.
fn region_error(
    test: &LinearImage,
    reference: &LinearImage,
    flip: &FlipMap,
    coverage: &Coverage,
) -> Result<RegionError, MetricError> {
    coverage.check_total(test.pixels.len())?;
    let (flip_mean, flip_max) = flip.mean_and_max(coverage)?;
    let (mut squared, mut relative) = (0.0, 0.0);
    for index in coverage.indices() {
        for channel in 0..3 {
            let wanted = f64::from(reference.pixels[index][channel]);
            let difference = f64::from(test.pixels[index][channel]) - wanted;
            squared += difference * difference;
            relative += (difference / (wanted.abs() + RELATIVE_FLOOR)).powi(2);
        }
    }
    let samples = 3.0 * coverage.count() as f64;
    let mse = squared / samples;
    Ok(RegionError {
        pixels: coverage.count(),
        flip_mean,
        flip_max,
        mse,
        relative_mse: relative / samples,
        psnr_db: psnr_db(mse),
    })
}

/// The peak signal-to-noise ratio in decibels of a mean squared error, the peak being 1; infinite at 0.
pub fn psnr_db(mse: f64) -> f64 {
    -10.0 * mse.log10()
}

#[cfg(test)]
#[path = "error_tests.rs"]
mod tests;
