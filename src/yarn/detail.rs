//! How much of a yarn is drawn where it is small in the picture; twin of `glsl/yarn/detail.glsl`.

use super::fiber::PieceTurns;
use super::flyaway::Flyaways;
use super::params::YarnParams;
use super::period::{CurvePeriods, Kind, Period, draw_period, period_turns};
use super::table::Fiber;
use glam::DVec2;
use std::f64::consts::PI;

/// Levels of detail for which a core fiber's texture is baked; `CORE_LEVELS` in
/// `glsl/shared/constants.glsl`.
pub const CORE_LEVELS: u32 = 8;

/// Share of the number of ranks kept over which a rank fades in.
const RANK_FADE: f64 = 0.25;
/// Share of the part of fibers kept over which one fades in.
const THINNING_FADE: f64 = 0.2;
/// Share of the ply's radius from which on loops and hairs are seen beside the core, which stands for fibers that
/// only migrate: without those that stay within the ply it would be shaded as too deep.
const FLYING_SHARE: f64 = 0.6;
/// Most width to which fibers are drawn in place of others, as a share of the ply's: those that stand out of it
/// would hide it or stick out from behind it where the ones they stand for do not.
const WIDEST_SHARE: f64 = 0.25;
/// Periods in a piece of yarn beyond which it is taken to hold a flyaway without looking.
const MOST_PERIODS_SEARCHED: i32 = 8;

/// What a piece of yarn is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Ranks of fibers drawn one by one in each ply, from the outermost.
    pub kept: f64,
    /// Share of all fibers that is kept where they are thinner than allowed; above 1 none is dropped.
    pub share: f64,
    /// Place in the core's levels, 0 (whole detail) to [`CORE_LEVELS`] - 1 (core alone).
    pub level: f64,
}

/// Lengths of a yarn that its level of detail depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetailWidths {
    /// Half a fiber's diameter in mm.
    pub fiber_radius_mm: f64,
    /// Radius in mm of the circle with the area of the ply's ellipse.
    pub ply_radius_mm: f64,
    /// Fibers of each ply drawn one by one at full detail.
    pub core_ranks: f64,
}

/// Wu & Yuksel 2019, Eq. 4, with the widths in pixels: 1 where a fiber is at least `threshold` wide, 0 where
/// a ply is at most that, falling in between.
pub fn lod_factor(fiber_px: f64, ply_px: f64, threshold: f64) -> f64 {
    if fiber_px >= threshold {
        return 1.0;
    }
    if ply_px <= threshold {
        return 0.0;
    }
    (fiber_px / threshold) * ((ply_px - threshold) / (ply_px - fiber_px))
}

/// Share of all fibers that is kept where each is `fiber_px` pixels wide, plies are `ply_px` and `thin` pixels are
/// the least allowed; above 1 none is dropped.
pub fn share_kept(fiber_px: f64, ply_px: f64, thin: f64) -> f64 {
    fiber_px / thin.min(WIDEST_SHARE * ply_px).max(1e-30)
}

/// What is drawn of a yarn whose pixels are `pixel_mm` wide at its place. `threshold` and `thin` in pixels.
/// The number of fibers goes with the square of Eq. 4's factor, as the paper's text has it.
pub fn detail_of(pixel_mm: f64, threshold: f64, thin: f64, widths: &DetailWidths) -> Detail {
    let fiber_px = 2.0 * widths.fiber_radius_mm / pixel_mm;
    let ply_px = 2.0 * widths.ply_radius_mm / pixel_mm;
    let factor = lod_factor(fiber_px, ply_px, threshold);
    Detail {
        kept: factor * factor * widths.core_ranks,
        share: share_kept(fiber_px, ply_px, thin),
        level: (1.0 - factor) * f64::from(CORE_LEVELS - 1),
    }
}

/// Ranks that are drawn one by one at a level of the core: the inverse of what [`detail_of`] says of both.
pub fn ranks_at_level(level: u32, core_ranks: f64) -> f64 {
    let factor = 1.0 - f64::from(level) / f64::from(CORE_LEVELS - 1);
    factor * factor * core_ranks
}

/// Share of its width with which a rank is drawn while `kept` are: ranks fade in one after another.
pub fn rank_weight(rank: u32, kept: f64) -> f64 {
    (1.0 + (kept / (f64::from(rank) + 1.0) - 1.0) / RANK_FADE).clamp(0.0, 1.0)
}

/// Candidates for [`slot_stride`] on either side of the golden section.
const STRIDES_TRIED: u32 = 8;

/// Distance between the fibers of successive slots: near the golden section of all, without a common factor, so
/// that every fiber has a slot, and of those the one whose first slots leave the smallest gaps.
pub fn slot_stride(fiber_count: u32) -> u32 {
    let golden = (f64::from(fiber_count) / ((1.0 + 5f64.sqrt()) / 2.0)).round() as u32;
    let near = golden.saturating_sub(STRIDES_TRIED).max(1)..=(golden + STRIDES_TRIED).min(fiber_count.max(1));
    let whole = near.filter(|stride| common_divisor(*stride, fiber_count) == 1);
    whole.min_by_key(|stride| largest_gap(*stride, fiber_count)).unwrap_or(1)
}

fn common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// Largest distance between neighbours among the first ninth of the slots.
fn largest_gap(stride: u32, fiber_count: u32) -> u32 {
    let kept = 0..fiber_count.div_ceil(9);
    let mut first: Vec<u32> = kept.map(|slot| fiber_of_slot(slot, stride, fiber_count)).collect();
    first.sort_unstable();
    first.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or(0)
}

/// The fibers in the order in which they are kept: `slot` counts those that stay longest first. Successive slots
/// lie far apart, so that any share of the fibers is spread over all plies and ranks.
pub fn fiber_of_slot(slot: u32, stride: u32, fiber_count: u32) -> u32 {
    slot.wrapping_mul(stride) % fiber_count
}

/// Share of its width with which the fiber at `place` in (0, 1) of that order is drawn while `share` of all are
/// kept.
pub fn thinning_weight(place: f64, share: f64) -> f64 {
    (0.5 + (share - place) / (THINNING_FADE * share.max(1e-6))).clamp(0.0, 1.0)
}

/// The first slots of which any may be drawn while `share` of all are kept; one more than there should be, for
/// the device's rounding.
pub fn slots_kept(share: f64, fiber_count: u32) -> u32 {
    let last = share * (1.0 + 0.5 * THINNING_FADE) * f64::from(fiber_count);
    (last.min(f64::from(fiber_count)) as u32).saturating_add(1).min(fiber_count)
}

/// Factor of a fiber's true width: what is kept is wide enough to cover as much as all did.
pub fn width_factor(thinning: f64, share: f64) -> f64 {
    thinning * (1.0 / share.max(1e-6)).max(1.0)
}

/// R beyond which a loop or hair of the fiber stands out of the ply and of the fiber's own migration: within, the
/// core stands for it.
pub fn flying_radius(fiber: &Fiber, migration_max: f64) -> f64 {
    fiber.radius.max(FLYING_SHARE) * migration_max
}

/// Part of a period, as places in it, outside of which the fiber does not stand out of the ply; empty (from > to)
/// where it nowhere does. Not tight: the radius of the migration that goes on is taken to be its largest.
pub fn flying_range(fiber: &Fiber, period: &Period, migration_max: f64) -> DVec2 {
    let low = fiber.radius * migration_max;
    let missing = flying_radius(fiber, migration_max) - low;
    let gain = (period.reach - low).max(0.0);
    if period.kind == Kind::Migration || missing >= gain {
        return DVec2::new(1.0, 0.0);
    }
    if period.kind == Kind::Loop {
        // gain sin^2(pi x) reaches what is missing no nearer to the ends than this: asin(z) >= z.
        let from = (missing / gain).sqrt() / PI;
        return DVec2::new(from, 1.0 - from);
    }
    let from = period.share * missing / gain;
    if period.root_first {
        DVec2::new(from, period.share)
    } else {
        DVec2::new(1.0 - period.share, 1.0 - from)
    }
}

/// Whether a loop or hair of the fiber may stand out of the ply somewhere over the piece.
pub fn has_flyaway(
    turns: &PieceTurns,
    fiber: &Fiber,
    fiber_index: u32,
    periods: &CurvePeriods,
    (yarn, flyaways): (&YarnParams, &Flyaways),
) -> bool {
    let (start, end) = (period_turns(turns, fiber, 0.0, flyaways), period_turns(turns, fiber, 1.0, flyaways));
    let (low, high) = (start.min(end), start.max(end));
    let (first, last) = (low.floor() as i32, high.floor() as i32);
    if last.saturating_sub(first) > MOST_PERIODS_SEARCHED {
        return true;
    }
    (first..=last).any(|k| {
        let period = draw_period(periods, fiber, fiber_index, k, flyaways);
        let range = flying_range(fiber, &period, yarn.migration_max) + f64::from(k);
        range.x <= range.y && range.x <= high && range.y >= low
    })
}

/// Place of the (n + 1)-th set bit of 64, the lowest first. `n` is below the number of set bits.
pub fn nth_set_bit(mask: u64, n: u32) -> u32 {
    let rest = (0..n).fold(mask, |mask, _| mask & mask.wrapping_sub(1));
    rest.trailing_zeros()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::period::{on_hair, period_shape};
    use crate::yarn::presets;
    use crate::yarn::table::fiber_table;

    #[test]
    fn the_factor_is_eq_4_and_has_no_step() {
        assert_eq!(lod_factor(1.0, 20.0, 1.0), 1.0);
        assert_eq!(lod_factor(0.05, 1.0, 1.0), 0.0);
        assert!((lod_factor(0.5, 10.0, 1.0) - 0.5 * 9.0 / 9.5).abs() < 1e-15);
        let mut before = 0.0;
        for i in 1..4000 {
            let fiber_px = 0.0005 * f64::from(i);
            let factor = lod_factor(fiber_px, 20.0 * fiber_px, 1.0);
            assert!(factor >= before && factor - before < 1e-3, "at {fiber_px}: {before} to {factor}");
            before = factor;
        }
        // A yarn of a single fiber per ply: no difference of widths to divide by.
        assert_eq!(lod_factor(0.5, 0.5, 1.0), 0.0);
    }

    #[test]
    fn thinning_keeps_what_all_fibers_cover() {
        for share in [0.02, 0.1, 0.37, 0.8, 0.95, 1.0, 1.1, 3.0] {
            let n = 100_000;
            let mean = (0..n)
                .map(|i| width_factor(thinning_weight((f64::from(i) + 0.5) / f64::from(n), share), share))
                .sum::<f64>()
                / f64::from(n);
            // Around 1 the fade has no fibers beyond the last to take from.
            let allowed = if (0.9..1.2).contains(&share) { 0.05 } else { 1e-4 };
            assert!((mean - 1.0).abs() < allowed, "share {share}: covers {mean}");
        }
    }

    #[test]
    fn every_fiber_has_a_slot_and_any_first_slots_are_spread() {
        for count in [1, 2, 3, 99, 225, 288, 324, 1000, 9891, 16_000] {
            let stride = slot_stride(count);
            let mut order: Vec<u32> = (0..count).map(|slot| fiber_of_slot(slot, stride, count)).collect();
            if count > 90 {
                let mut first: Vec<u32> = order[..count as usize / 9].to_vec();
                first.sort_unstable();
                let gap = first.windows(2).map(|w| w[1] - w[0]).max().unwrap_or(0);
                assert!(gap <= 27, "{count}: the first ninth leaves a gap of {gap}");
            }
            order.sort_unstable();
            assert!(order.iter().copied().eq(0..count), "{count} with stride {stride}");
        }
    }

    #[test]
    fn no_slot_beyond_those_kept_has_any_weight() {
        for share in [0.0, 0.01, 0.33, 0.9, 0.95, 1.0, 2.0, 1e9] {
            for count in [1, 64, 324] {
                let kept = slots_kept(share, count);
                assert!(kept <= count && (share < 1.0 || kept == count));
                for slot in kept..count {
                    let place = (f64::from(slot) + 0.5) / f64::from(count);
                    assert_eq!(thinning_weight(place, share), 0.0, "{share} of {count}: slot {slot}");
                }
            }
        }
    }

    #[test]
    fn nothing_stands_out_of_the_ply_outside_its_range() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let flyaways = Flyaways::new(&yarn);
        let periods = CurvePeriods { curve: 0, count: 0, seed: 5 };
        let (mut out, mut inside) = (0, 0);
        for (index, fiber) in (0..).zip(&fiber_table(&yarn, 2)) {
            for k in 0..20 {
                let period = draw_period(&periods, fiber, index, k, &flyaways);
                let range = flying_range(fiber, &period, yarn.migration_max);
                for step in 0..=100 {
                    let x = f64::from(step) / 100.0;
                    let shape = period_shape(fiber, &period, x, 1.0, (&yarn, &flyaways));
                    let flies =
                        period.kind == Kind::Loop || (period.kind == Kind::Hair && on_hair(&period, x));
                    if flies && shape.radius > flying_radius(fiber, yarn.migration_max) {
                        assert!(range.x <= x && x <= range.y, "{period:?} at {x}: {}", shape.radius);
                        out += 1;
                    } else if range.x <= x && x <= range.y {
                        inside += 1;
                    }
                }
            }
        }
        assert!(out > 1000 && inside < out, "{out} places stand out, {inside} more are drawn");
    }

    #[test]
    fn ranks_fade_in_one_after_another_and_all_are_whole_at_full_detail() {
        assert!((0..54).all(|rank| rank_weight(rank, 54.0) == 1.0));
        assert_eq!(rank_weight(80, 54.0), 0.0);
        assert_eq!(rank_weight(0, 0.0), 0.0);
        let weights: Vec<f64> = (0..100).map(|rank| rank_weight(rank, 20.0)).collect();
        assert!(weights.windows(2).all(|w| w[1] <= w[0]) && weights.iter().any(|w| *w > 0.1 && *w < 0.9));
        for level in 0..CORE_LEVELS {
            let factor = 1.0 - f64::from(level) / f64::from(CORE_LEVELS - 1);
            assert!((ranks_at_level(level, 54.0) - factor * factor * 54.0).abs() < 1e-12);
        }
    }

    #[test]
    fn bits_are_found_in_order() {
        let mask = 0x8000_0001_0010_0082_u64;
        let found: Vec<u32> = (0..mask.count_ones()).map(|n| nth_set_bit(mask, n)).collect();
        assert_eq!(found, [1, 7, 20, 32, 63]);
    }
}
