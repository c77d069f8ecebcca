//! Which pixels count: those that yarn covers in either picture, since empty background hides error.

use crate::io::picture::{DisplayImage, LinearImage};
use crate::metrics::{MetricError, check_display, check_linear};

/// A set of pixels, never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coverage {
    mask: Vec<bool>,
    count: usize,
}

impl Coverage {
    /// The pixels whose alpha is above 0 in either picture. A picture from a file without alpha is covered
    /// everywhere, and then so is the pair.
    pub fn of_linear(test: &LinearImage, reference: &LinearImage) -> Result<Self, MetricError> {
        check_linear(test, reference)?;
        let pairs = test.pixels.iter().zip(&reference.pixels);
        Self::from_mask(pairs.map(|(t, r)| t[3] > 0.0 || r[3] > 0.0).collect())
    }

    /// The pixels whose alpha byte is above 0 in either picture.
    pub fn of_display(test: &DisplayImage, reference: &DisplayImage) -> Result<Self, MetricError> {
        check_display(test, reference)?;
        let pairs = test.pixels.iter().zip(&reference.pixels);
        Self::from_mask(pairs.map(|(t, r)| t[3] > 0 || r[3] > 0).collect())
    }

    /// All of `pixels` pixels.
    pub fn everywhere(pixels: usize) -> Result<Self, MetricError> {
        Self::from_mask(vec![true; pixels])
    }

    fn from_mask(mask: Vec<bool>) -> Result<Self, MetricError> {
        let count = mask.iter().filter(|covered| **covered).count();
        if count == 0 { Err(MetricError::NothingCovered) } else { Ok(Self { mask, count }) }
    }

    /// Covered pixels, at least 1.
    pub fn count(&self) -> usize {
        self.count
    }

    /// All pixels, covered or not.
    pub fn total(&self) -> usize {
        self.mask.len()
    }

    /// Whether this is the coverage of pictures of `pixels` pixels.
    pub(crate) fn check_total(&self, pixels: usize) -> Result<(), MetricError> {
        let covers = self.mask.len();
        if covers == pixels { Ok(()) } else { Err(MetricError::Coverage { pixels, covers }) }
    }

    /// The indices (row-major, row 0 on top) of the covered pixels, rising.
    pub fn indices(&self) -> impl Iterator<Item = usize> {
        self.mask.iter().enumerate().filter(|(_, covered)| **covered).map(|(index, _)| index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn either_picture_covers() {
        let mut a = LinearImage::filled(3, 1, [1.0, 1.0, 1.0, 0.0]);
        let mut b = a.clone();
        a.pixels[0][3] = 1e-30;
        b.pixels[2][3] = 1.0;
        let coverage = Coverage::of_linear(&a, &b).unwrap();
        assert_eq!(coverage.indices().collect::<Vec<_>>(), [0, 2]);
        assert_eq!((coverage.count(), coverage.total()), (2, 3));
    }

    #[test]
    fn bytes_cover_likewise() {
        let mut a = DisplayImage::filled(2, 2, [9, 9, 9, 0]);
        let b = a.clone();
        a.pixels[3][3] = 1;
        assert_eq!(Coverage::of_display(&b, &a).unwrap().indices().collect::<Vec<_>>(), [3]);
    }

    #[test]
    fn nothing_covered_is_an_error() {
        let a = LinearImage::filled(3, 1, [1.0, 1.0, 1.0, 0.0]);
        assert!(matches!(Coverage::of_linear(&a, &a), Err(MetricError::NothingCovered)));
        let b = DisplayImage::filled(3, 1, [9, 9, 9, 0]);
        assert!(matches!(Coverage::of_display(&b, &b), Err(MetricError::NothingCovered)));
        assert!(matches!(Coverage::everywhere(0), Err(MetricError::NothingCovered)));
    }
}
