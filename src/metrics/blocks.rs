//! Whether a difference is real: means of small blocks against the noise that their pixels state.

use serde::Serialize;

use crate::metrics::coverage::Coverage;
use crate::metrics::noise::Difference;

/// Pixels along a block's side: enough samples in a block that its mean is nearly normal, few enough pixels that a
/// shadow's edge shows.
pub const BLOCK_SIDE: usize = 8;
/// How often the largest of all z-statistics exceeds [`Blocks::limit`] by chance.
const FALSE_ALARMS: f64 = 0.01;
/// What `beyond_3` counts; 0.27% of a normal distribution lies there.
const THREE: f64 = 3.0;

/// The z-statistics, mean difference over its standard error, of every block and channel. They are of a standard
/// normal distribution where two pictures differ by noise alone and each block has enough samples: at 16 a pixel it
/// is so for all but rare, very bright ones.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Blocks {
    /// Pixels along a block's side; those at the right and lower edge may be smaller.
    pub side: usize,
    /// Blocks with a covered pixel.
    pub count: usize,
    /// The z-statistic furthest from 0; above 0 where the test picture is brighter.
    pub largest_z: f64,
    /// Its block's upper left pixel, x and y.
    pub largest_at: [usize; 2],
    /// Its channel: 0 red, 1 green, 2 blue.
    pub largest_channel: usize,
    /// Share of all z-statistics that lie beyond 3 on either side; 0.0027 by chance.
    pub beyond_3: f64,
    /// What `largest_z` exceeds on either side in 1 of 100 comparisons of pictures that differ by noise alone.
    pub limit: f64,
    /// Whether it does.
    pub differs: bool,
}

/// Sums over the covered pixels of a block.
#[derive(Clone, Copy, Default)]
struct Sums {
    pixels: usize,
    value: [f64; 3],
    variance: [f64; 3],
}

impl Blocks {
    /// The statistics of `differences`, rows of `width` pixels, of which `covered` ones count.
    pub(crate) fn new(differences: &[Difference], width: u32, covered: &Coverage) -> Self {
        let width = width as usize;
        let columns = width.div_ceil(BLOCK_SIDE);
        let rows = differences.len().div_ceil(width).div_ceil(BLOCK_SIDE);
        let mut sums = vec![Sums::default(); columns * rows];
        for index in covered.indices() {
            let (x, y) = (index % width, index / width);
            let block = &mut sums[y / BLOCK_SIDE * columns + x / BLOCK_SIDE];
            block.pixels += 1;
            for channel in 0..3 {
                block.value[channel] += differences[index].value[channel];
                block.variance[channel] += differences[index].variance[channel];
            }
        }
        let of = |block: usize| (0..3).map(move |channel| (block, channel));
        let all: Vec<(f64, usize, usize)> = (0..sums.len())
            .filter(|&block| sums[block].pixels > 0)
            .flat_map(of)
            .map(|(block, channel)| (z(&sums[block], channel), block, channel))
            .collect();
        Self::of_all(&all, columns)
    }

    /// The summary of `(z, block, channel)`s, blocks in rows of `columns`.
    fn of_all(all: &[(f64, usize, usize)], columns: usize) -> Self {
        let largest = all.iter().copied().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        let (largest_z, block, largest_channel) = largest.unwrap_or_default();
        let beyond = all.iter().filter(|(z, ..)| z.abs() > THREE).count();
        let limit = two_sided_limit(FALSE_ALARMS / all.len().max(1) as f64);
        Self {
            side: BLOCK_SIDE,
            count: all.len() / 3,
            largest_z,
            largest_at: [block % columns * BLOCK_SIDE, block / columns * BLOCK_SIDE],
            largest_channel,
            beyond_3: beyond as f64 / all.len().max(1) as f64,
            limit,
            differs: largest_z.abs() > limit,
        }
    }
}

/// Pixels that are black in both pictures have neither difference nor variance, and agree.
fn z(sums: &Sums, channel: usize) -> f64 {
    let (value, variance) = (sums.value[channel], sums.variance[channel]);
    if value == 0.0 { 0.0 } else { value / variance.sqrt() }
}

/// What the absolute value of a standard normal variable exceeds with `probability`, above 0 and at most 1.
fn two_sided_limit(probability: f64) -> f64 {
    // erfc falls from 1 below every probability that a picture's pixels could divide [`FALSE_ALARMS`] into.
    let (mut low, mut high) = (0.0, 30.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if libm::erfc(middle * std::f64::consts::FRAC_1_SQRT_2) > probability {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_those_of_the_normal_distribution() {
        for (probability, z) in [(0.05, 1.959_964), (0.0027, 2.999_977), (1e-6, 4.891_638)] {
            assert!((two_sided_limit(probability) - z).abs() < 1e-5, "{probability}");
        }
        assert!(two_sided_limit(1e-100).is_finite());
    }

    #[test]
    fn a_difference_is_found_in_its_block_and_channel() {
        // 20 x 12 pixels: 3 x 2 blocks, those at the edges smaller.
        let mut differences = vec![Difference { value: [0.0; 3], variance: [0.04; 3] }; 240];
        for (x, y) in [(17, 9), (18, 10), (19, 11)] {
            differences[y * 20 + x].value[1] = -1.0;
        }
        let blocks = Blocks::new(&differences, 20, &Coverage::everywhere(240).unwrap());
        // 16 pixels, -3 in all, of standard error 0.2 * 4.
        assert!((blocks.largest_z + 3.0 / 0.8).abs() < 1e-12, "{blocks:?}");
        assert_eq!((blocks.count, blocks.largest_at, blocks.largest_channel), (6, [16, 8], 1));
        assert!((blocks.beyond_3 - 1.0 / 18.0).abs() < 1e-12 && blocks.differs, "{blocks:?}");
    }

    #[test]
    fn black_blocks_agree_and_a_difference_without_noise_is_certain() {
        let mut differences = vec![Difference { value: [0.0; 3], variance: [0.0; 3] }; 64];
        let everywhere = Coverage::everywhere(64).unwrap();
        let agree = Blocks::new(&differences, 8, &everywhere);
        assert_eq!((agree.largest_z, agree.beyond_3, agree.differs), (0.0, 0.0, false));
        differences[5] = Difference { value: [1e-3, 0.0, 0.0], variance: [1e-20, 0.0, 0.0] };
        let differ = Blocks::new(&differences, 8, &everywhere);
        assert!(differ.largest_z.is_finite() && differ.largest_z > 1e6 && differ.differs, "{differ:?}");
    }
}
