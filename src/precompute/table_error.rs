//! How far a baked table is from the integral it stands for.

use glam::DVec2;
use std::f64::consts::TAU;

/// Differences over many places, as shares of the table's range. No number anywhere makes all of them none.
#[derive(Clone, Copy, Debug)]
pub struct TableError {
    /// Root of the mean square.
    pub rms: f64,
    /// What 99% of the places keep within.
    pub p99: f64,
    /// The largest.
    pub worst: f64,
}

impl TableError {
    /// Sums up pairs of (read, exact); `range` is what 1 stands for.
    pub fn new(pairs: &[(f64, f64)], range: f64) -> Self {
        let mut off: Vec<f64> = pairs.iter().map(|(read, exact)| (read - exact).abs() / range).collect();
        off.sort_by(f64::total_cmp);
        // NaN sorts last; sums spread it.
        let sum = off.iter().sum::<f64>();
        let squares = off.iter().map(|v| v * v).sum::<f64>();
        let at = |share: f64| off.get((share * off.len() as f64) as usize).copied().unwrap_or(f64::NAN);
        Self {
            rms: (squares / off.len() as f64).sqrt(),
            p99: at(0.99) + 0.0 * sum,
            worst: off.last().copied().unwrap_or(f64::NAN),
        }
    }

    /// Whether each is within its limit.
    pub fn within(&self, limit: &Self) -> bool {
        self.rms <= limit.rms && self.p99 <= limit.p99 && self.worst <= limit.worst
    }
}

/// `count` pairs of a place in the unit circle and a unit direction toward light, evenly spread: the sequence of
/// Roberts (2018) in three dimensions, which meets no table's nodes.
pub fn places(count: u32) -> impl Iterator<Item = (DVec2, DVec2)> {
    (0..count).map(|i| {
        let part = |step: f64| (0.5 + step * f64::from(i)).fract();
        let [area, around, light] = [0.819_172_513_396, 0.671_043_606_703, 0.549_700_477_902].map(part);
        (area.sqrt() * DVec2::from_angle(TAU * around), DVec2::from_angle(TAU * light))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_known_differences() {
        let mut pairs: Vec<(f64, f64)> = (0..1000).map(|i| (f64::from(i) / 1000.0, 0.0)).collect();
        let error = TableError::new(&pairs, 2.0);
        assert_eq!((error.p99, error.worst), (0.495, 0.4995));
        assert!((error.rms - 0.5 / 3f64.sqrt()).abs() < 1e-3, "{error:?}");
        let limit = TableError { rms: 0.3, p99: 0.5, worst: 0.5 };
        assert!(error.within(&limit) && !error.within(&TableError { p99: 0.4, ..limit }));
        pairs[3].0 = f64::NAN;
        let broken = TableError::new(&pairs, 2.0);
        assert!(broken.rms.is_nan() && broken.p99.is_nan() && !broken.within(&limit));
        assert!(!TableError::new(&[], 1.0).within(&limit), "nothing compared");
    }

    #[test]
    fn places_fill_the_circle() {
        let mean: f64 = places(10_000).map(|(p, _)| p.length_squared()).sum::<f64>() / 1e4;
        assert!((mean - 0.5).abs() < 1e-3, "{mean}");
        let sum = places(10_000).fold(DVec2::ZERO, |sum, (p, l)| sum + p + l) / 1e4;
        assert!(sum.length() < 1e-2, "{sum}");
    }
}
