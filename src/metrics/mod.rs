//! How wrong a picture is: it sees only pictures, and refuses what it cannot judge.
//!
//! Every function fails closed: pictures of different or senseless sizes, a NaN or an infinity anywhere in
//! either, and an empty set of covered pixels are errors, never a number.

pub mod blocks;
pub mod coverage;
pub mod error;
pub mod error_vs_time;
pub mod flip;
pub mod noise;

use crate::io::picture::{BadShape, DisplayImage, LinearImage, NotDisplayable, NotFinite};

/// Which of the two pictures of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The picture that is judged.
    Test,
    /// The picture that it should be.
    Reference,
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Test => "test picture",
            Self::Reference => "reference picture",
        })
    }
}

/// Why two pictures cannot be compared.
#[derive(Clone, Copy, Debug, thiserror::Error)]
pub enum MetricError {
    /// The sides of one picture are senseless or disagree with its pixels.
    #[error("{0}: {1}")]
    Shape(Side, BadShape),
    /// The pictures differ in size.
    #[error(
        "test picture: expected {} x {} pixels as in the reference, found {} x {}",
        reference[0], reference[1], test[0], test[1]
    )]
    Sizes {
        /// Width and height of the test picture.
        test: [u32; 2],
        /// Width and height of the reference.
        reference: [u32; 2],
    },
    /// A NaN or an infinity.
    #[error("{0}: {1}")]
    NotFinite(Side, NotFinite),
    /// An exposure that would make every picture alike.
    #[error("expected a finite exposure factor above 0, found {0}")]
    Exposure(f64),
    /// The coverage belongs to pictures of another size.
    #[error("expected the coverage of {pixels} pixels, found that of {covers}")]
    Coverage {
        /// Pixels of the pictures.
        pixels: usize,
        /// Pixels of the coverage.
        covers: usize,
    },
    /// The variances belong to a picture of another size.
    #[error("{side}: expected the variance of {pixels} pixels, found that of {found}")]
    VarianceSize {
        /// The picture.
        side: Side,
        /// Its pixels.
        pixels: usize,
        /// Variances of pixels.
        found: usize,
    },
    /// A variance that is below 0 or no finite number.
    #[error("{side}: pixel ({x}, {y}): expected finite variances of at least 0, found {value:?}")]
    Variance {
        /// The picture.
        side: Side,
        /// The pixel's column.
        x: usize,
        /// The pixel's row.
        y: usize,
        /// The variances of its red, green and blue.
        value: [f32; 3],
    },
    /// There is nothing to average over.
    #[error("expected a pixel covered by yarn in either picture, found none")]
    NothingCovered,
}

impl MetricError {
    fn display(side: Side, error: NotDisplayable) -> Self {
        match error {
            NotDisplayable::Shape(shape) => Self::Shape(side, shape),
            NotDisplayable::Pixel(pixel) => Self::NotFinite(side, pixel),
            NotDisplayable::Exposure(exposure) => Self::Exposure(exposure),
        }
    }
}

/// Checks two linear pictures before any figure is taken: shapes, equal sizes, finite values.
pub(crate) fn check_linear(test: &LinearImage, reference: &LinearImage) -> Result<(), MetricError> {
    test.check_shape().map_err(|e| MetricError::Shape(Side::Test, e))?;
    reference.check_shape().map_err(|e| MetricError::Shape(Side::Reference, e))?;
    check_sizes([test.width, test.height], [reference.width, reference.height])?;
    test.check_finite().map_err(|e| MetricError::NotFinite(Side::Test, e))?;
    reference.check_finite().map_err(|e| MetricError::NotFinite(Side::Reference, e))
}

/// Checks two display pictures before any figure is taken: shapes and equal sizes (bytes are always finite).
pub(crate) fn check_display(test: &DisplayImage, reference: &DisplayImage) -> Result<(), MetricError> {
    test.check_shape().map_err(|e| MetricError::Shape(Side::Test, e))?;
    reference.check_shape().map_err(|e| MetricError::Shape(Side::Reference, e))?;
    check_sizes([test.width, test.height], [reference.width, reference.height])
}

fn check_sizes(test: [u32; 2], reference: [u32; 2]) -> Result<(), MetricError> {
    if test == reference { Ok(()) } else { Err(MetricError::Sizes { test, reference }) }
}
