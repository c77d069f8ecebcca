//! Repeated measurements: their middle and how far they lie apart.

use serde::{Deserialize, Serialize};

/// Spread beyond which a time is not to be relied on, as a share of the median.
pub const WIDE_SPREAD: f64 = 0.2;

/// Spread of a measured figure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Middle of all measurements.
    pub median: f64,
    /// Shortest.
    pub min: f64,
    /// Longest.
    pub max: f64,
    /// Number of measurements.
    pub frames: usize,
}

impl Spread {
    /// Of these measurements; none of no measurement.
    pub fn of(measured: &[f64]) -> Option<Self> {
        let mut sorted = measured.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let frames = sorted.len();
        let median = 0.5 * (sorted[(frames - 1) / 2] + sorted[frames / 2]);
        Some(Self { median, min, max, frames })
    }

    /// Distance of the longest from the shortest as a share of the median; NaN of a single measurement.
    pub fn relative(&self) -> f64 {
        if self.frames > 1 { (self.max - self.min) / self.median } else { f64::NAN }
    }

    /// Whether the measurements lie too far apart to be relied on. Of a single one nobody knows.
    pub fn is_wide(&self) -> bool {
        self.relative() > WIDE_SPREAD
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_lies_between_and_the_ends_are_kept() {
        assert_eq!(Spread::of(&[]), None);
        let spread = Spread::of(&[30.0, 10.0, 20.0, 40.0]).unwrap();
        assert_eq!(spread, Spread { median: 25.0, min: 10.0, max: 40.0, frames: 4 });
        assert!((spread.relative() - 1.2).abs() < 1e-12);
    }

    #[test]
    fn beyond_a_fifth_of_the_median_it_is_wide_and_a_single_measurement_says_nothing() {
        assert!(!Spread::of(&[100.0, 110.0, 119.0]).unwrap().is_wide());
        assert!(Spread::of(&[100.0, 110.0, 123.0]).unwrap().is_wide());
        let single = Spread::of(&[100.0]).unwrap();
        assert!(single.relative().is_nan() && !single.is_wide());
    }
}
