//! How a fabric's patches are cut into draw calls.

use crate::gpu_types::FIBERS_PER_PATCH;
use std::ops::Range;

/// lavapipe silently draws a wrong picture when one draw evaluates more tessellation vertices.
pub const CPU_MAX_EVALUATED_VERTICES: u32 = 65_536;
/// On lavapipe draws of this many patches are about twice as fast as one big draw.
const CPU_PATCHES_PER_DRAW: u32 = 16;
/// Elsewhere a draw may be large; this keeps a single one well under any watchdog.
const GPU_PATCHES_PER_DRAW: u32 = 16_384;

/// One draw call: a range of patches times a range of instances, 64 fibers each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draw {
    /// First piece of yarn.
    pub first_patch: u32,
    /// Pieces of yarn.
    pub patches: u32,
    /// First group of fibers.
    pub first_group: u32,
    /// Groups of fibers.
    pub groups: u32,
}

/// Sizes of a fabric's draws. `Default` draws nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawPlan {
    patches: u32,
    fibers: u32,
    groups: u32,
    patches_per_draw: u32,
    groups_per_draw: u32,
}

impl Default for DrawPlan {
    fn default() -> Self {
        Self::new(0, 0, 1, false, None)
    }
}

impl DrawPlan {
    /// Plans draws of `patches` pieces of yarn with `fibers` fibers each, of which none is cut into
    /// more than `max_subdivisions` pieces. `asked` patches a draw are granted as far as the device
    /// allows.
    pub fn new(patches: u32, fibers: u32, max_subdivisions: u32, is_cpu: bool, asked: Option<u32>) -> Self {
        let groups = fibers.div_ceil(FIBERS_PER_PATCH).max(1);
        let default = if is_cpu { CPU_PATCHES_PER_DRAW } else { GPU_PATCHES_PER_DRAW };
        let mut plan = Self {
            patches,
            fibers,
            groups,
            patches_per_draw: asked.unwrap_or(default).max(1),
            groups_per_draw: groups,
        };
        if is_cpu {
            let per_group = fibers.clamp(1, FIBERS_PER_PATCH) * (max_subdivisions + 1);
            let patch_groups = (CPU_MAX_EVALUATED_VERTICES / per_group).max(1);
            plan.groups_per_draw = groups.min(patch_groups);
            plan.patches_per_draw = plan.patches_per_draw.min((patch_groups / plan.groups_per_draw).max(1));
        }
        plan
    }

    /// Fiber curves of all draws together.
    pub fn curves(&self) -> u64 {
        u64::from(self.patches) * u64::from(self.fibers)
    }

    /// How many draws there are.
    pub fn draw_count(&self) -> usize {
        let steps = |total: u32, step: u32| total.div_ceil(step) as usize;
        steps(self.patches, self.patches_per_draw) * steps(self.groups, self.groups_per_draw)
    }

    /// The draws, in an order that does not depend on their size: patch by patch.
    pub fn draws(&self) -> impl Iterator<Item = Draw> + use<> {
        let plan = *self;
        let starts = |total: u32, step: u32| (0..total).step_by(step as usize);
        starts(plan.patches, plan.patches_per_draw).flat_map(move |first_patch| {
            starts(plan.groups, plan.groups_per_draw).map(move |first_group| Draw {
                first_patch,
                patches: plan.patches_per_draw.min(plan.patches - first_patch),
                first_group,
                groups: plan.groups_per_draw.min(plan.groups - first_group),
            })
        })
    }
}

/// In how many parts draws are handed to the device, so that none has many more than `curves` fiber curves: between
/// them a user hears of progress, and a device's watchdog is content.
pub fn part_count<'a>(plans: impl Iterator<Item = &'a DrawPlan> + Clone, curves: u64) -> usize {
    let total: u64 = plans.clone().map(DrawPlan::curves).sum();
    let draws: usize = plans.map(DrawPlan::draw_count).sum();
    usize::try_from(total.div_ceil(curves.max(1))).unwrap_or(usize::MAX).clamp(1, draws.max(1))
}

/// The `part`-th of `parts` equal parts of all draws: the places of the plans that have any in it, and which.
pub fn part_draws<'a>(
    plans: impl Iterator<Item = &'a DrawPlan> + Clone,
    part: usize,
    parts: usize,
) -> impl Iterator<Item = (usize, Range<usize>)> {
    let draws: usize = plans.clone().map(DrawPlan::draw_count).sum();
    let range = draws * part / parts..draws * (part + 1) / parts;
    let mut before = 0;
    let of_plan = move |(place, plan): (usize, &DrawPlan)| {
        let count = plan.draw_count();
        let start = range.start.clamp(before, before + count) - before;
        let end = range.end.clamp(before, before + count) - before;
        before += count;
        (start < end).then_some((place, start..end))
    };
    plans.enumerate().filter_map(of_plan)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_draw_exceeds_the_trap_and_every_patch_and_group_is_drawn_once() {
        for patches in [1, 15, 16, 17, 61, 62, 1000] {
            for fibers in [1, 20, 63, 64, 65, 150, 288, 3200, 16_000] {
                for subdivisions in [1, 3, 16, 64] {
                    for asked in [None, Some(1), Some(100_000)] {
                        check(patches, fibers, subdivisions, asked);
                    }
                }
            }
        }
    }

    fn check(patches: u32, fibers: u32, subdivisions: u32, asked: Option<u32>) {
        let plan = DrawPlan::new(patches, fibers, subdivisions, true, asked);
        let groups = fibers.div_ceil(FIBERS_PER_PATCH);
        let mut drawn = vec![0u8; (patches * groups) as usize];
        for draw in plan.draws() {
            let vertices = draw.patches * draw.groups * fibers.min(FIBERS_PER_PATCH) * (subdivisions + 1);
            assert!(vertices <= CPU_MAX_EVALUATED_VERTICES, "{draw:?} evaluates {vertices}");
            for patch in draw.first_patch..draw.first_patch + draw.patches {
                for group in draw.first_group..draw.first_group + draw.groups {
                    drawn[(patch * groups + group) as usize] += 1;
                }
            }
        }
        assert_eq!(plan.draw_count(), plan.draws().count());
        assert!(drawn.iter().all(|&n| n == 1), "{patches} {fibers} {subdivisions} {asked:?}");
    }

    #[test]
    fn parts_hold_every_draw_once_and_in_order() {
        let plans = [(0, 3), (40, 200), (0, 1), (7, 64), (16, 64)]
            .map(|(n, f)| DrawPlan::new(n, f, 8, true, Some(3)));
        let all: Vec<(usize, usize)> = (0..plans.len())
            .flat_map(|place| (0..plans[place].draw_count()).map(move |draw| (place, draw)))
            .collect();
        assert_eq!(part_count(plans.iter(), u64::MAX), 1);
        assert_eq!(part_count(plans.iter(), 0), all.len());
        for parts in [1, 2, 5, all.len()] {
            let found: Vec<(usize, usize)> = (0..parts)
                .flat_map(|part| part_draws(plans.iter(), part, parts).collect::<Vec<_>>())
                .flat_map(|(place, range)| range.map(move |draw| (place, draw)))
                .collect();
            assert_eq!(found, all, "{parts} parts");
        }
    }

    #[test]
    fn a_gpu_draws_in_large_pieces() {
        assert_eq!(DrawPlan::new(10_000, 288, 16, false, None).draws().count(), 1);
    }
}
