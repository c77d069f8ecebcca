//! Bias told from noise, where a picture states how sure it is of each pixel.
//!
//! A pixel of a Monte Carlo picture is a mean of samples with a variance of its own. Then the expected squared
//! difference of two pixels is the squared difference of what they converge to, the bias, and the sum of their
//! variances, the noise. Only the first is a mistake of a renderer. A picture that states no variance is taken at
//! its word: what noise it has counts as bias.

use serde::Serialize;

use crate::io::measured::MeasuredImage;
use crate::metrics::blocks::Blocks;
use crate::metrics::coverage::Coverage;
use crate::metrics::{MetricError, Side, check_linear};

/// What a squared error is made of, over one set of pixels; means over pixels and red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RegionNoise {
    /// Mean variance of `test - reference`: the squared error that two pictures without any bias would have.
    pub variance: f64,
    /// Mean squared error less that variance: an unbiased estimate of the mean squared bias, so that it may fall
    /// below 0 where there is little.
    pub bias_squared: f64,
    /// Standard error of that, from its spread over pixels: an upper bound, for where the bias itself differs from
    /// pixel to pixel that counts as well.
    pub bias_squared_error: f64,
}

/// Bias and noise where yarn is, and everywhere, and whether the difference is real.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// Over the pixels covered by yarn in either picture.
    pub covered: RegionNoise,
    /// Over all pixels, empty background included.
    pub whole: RegionNoise,
    /// The differences of small blocks against their noise, over the covered pixels.
    pub blocks: Blocks,
}

/// Tells bias from noise by the variances of the test picture and of the reference, each where there is one. Nothing
/// without either. Samples of one pixel must be independent of those of another, as a box filter's are.
///
/// # Errors
/// Pictures that cannot be compared; a variance of another size, below 0, or that is no finite number.
pub fn separate(test: &MeasuredImage, reference: &MeasuredImage) -> Result<Option<Noise>, MetricError> {
    check_linear(&test.mean, &reference.mean)?;
    check_variance(Side::Test, test)?;
    check_variance(Side::Reference, reference)?;
    if test.variance.is_none() && reference.variance.is_none() {
        return Ok(None);
    }
    let differences: Vec<Difference> =
        (0..test.mean.pixels.len()).map(|index| difference(test, reference, index)).collect();
    let covered = Coverage::of_linear(&test.mean, &reference.mean)?;
    let whole = Coverage::everywhere(differences.len())?;
    Ok(Some(Noise {
        covered: region(&differences, &covered),
        whole: region(&differences, &whole),
        blocks: Blocks::new(&differences, test.mean.width, &covered),
    }))
}

/// `test - reference` at one pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Difference {
    pub value: [f64; 3],
    pub variance: [f64; 3],
}

fn difference(test: &MeasuredImage, reference: &MeasuredImage, index: usize) -> Difference {
    let (t, r) = (test.mean.pixels[index], reference.mean.pixels[index]);
    let variance =
        |image: &MeasuredImage| image.variance.as_ref().map_or([0.0; 3], |v| v[index].map(f64::from));
    let (of_test, of_reference) = (variance(test), variance(reference));
    Difference {
        value: std::array::from_fn(|c| f64::from(t[c]) - f64::from(r[c])),
        variance: std::array::from_fn(|c| of_test[c] + of_reference[c] + rounding(t[c]) + rounding(r[c])),
    }
}

/// Variance of a value's rounding to f32, so that no picture is surer of itself than its file.
fn rounding(value: f32) -> f64 {
    let step = f64::from(value) * f64::from(f32::EPSILON);
    step * step / 12.0
}

fn region(differences: &[Difference], coverage: &Coverage) -> RegionNoise {
    let count = coverage.count() as f64;
    let mean_of = |v: [f64; 3]| v.iter().sum::<f64>() / 3.0;
    let (mut noise, mut bias, mut bias_squares) = (0.0, 0.0, 0.0);
    for index in coverage.indices() {
        let Difference { value, variance } = differences[index];
        let excess: [f64; 3] = std::array::from_fn(|c| value[c] * value[c] - variance[c]);
        noise += mean_of(variance);
        bias += mean_of(excess);
        bias_squares += mean_of(excess).powi(2);
    }
    let bias_squared = bias / count;
    // The channels of a pixel come from the same samples: pixels are what is counted.
    let spread = (bias_squares / count - bias_squared * bias_squared).max(0.0);
    RegionNoise {
        variance: noise / count,
        bias_squared,
        bias_squared_error: (spread / (count - 1.0).max(1.0)).sqrt(),
    }
}

fn check_variance(side: Side, image: &MeasuredImage) -> Result<(), MetricError> {
    let Some(variance) = &image.variance else { return Ok(()) };
    let (pixels, found) = (image.mean.pixels.len(), variance.len());
    if pixels != found {
        return Err(MetricError::VarianceSize { side, pixels, found });
    }
    let sound = |v: &f32| v.is_finite() && *v >= 0.0;
    match variance.iter().position(|channels| !channels.iter().all(sound)) {
        None => Ok(()),
        Some(index) => {
            let width = image.mean.width as usize;
            let value = variance[index];
            Err(MetricError::Variance { side, x: index % width, y: index / width, value })
        }
    }
}

#[cfg(test)]
#[path = "noise_tests.rs"]
mod tests;
