//! `glsl/yarn/detail.glsl`.

use crate::flyaway_rows::{FLOOR, truth};
use crate::harness::{Args, Case, Part, Row, number};
use crate::inputs::{Random, random_rows, row};
use worsted::yarn::detail::{self, DetailWidths};
use worsted::yarn::params::MAX_FIBERS;
use worsted::yarn::period::CurvePeriods;

type Twin = fn(&mut Args<'_>) -> Vec<Part>;

pub fn cases() -> Vec<Case> {
    let mut all = vec![lod_factor(), share_kept(), detail_of(), rank_weight(), fiber_of_slot()];
    all.extend([thinning_weight(), width_factor()]);
    all.extend([flying_radius(), flying_range(), has_flyaway(), nth_set_bit()]);
    all
}

fn case(function: &'static str, make: impl Fn(&mut Random) -> Row, twin: Twin) -> Case {
    Case { function, rows: random_rows(function, make), twin, invariant: None }
}

fn reals(values: &[f64]) -> Row {
    values.iter().fold(row(), |row, value| row.real(*value)).end()
}

fn lod_factor() -> Case {
    let mut case = case(
        "lod_factor",
        |random| {
            let threshold = random.magnitude(0.05, 20.0);
            let fiber_px = threshold * random.magnitude(1e-3, 3.0);
            reals(&[fiber_px, fiber_px * random.between(1.0, 50.0), threshold])
        },
        |args| vec![number("factor", detail::lod_factor(args.real(), args.real(), args.real()), FLOOR)],
    );
    // On both sides of both thresholds and on them; a ply of one fiber; nothing at all to see.
    for fiber_px in [0.0, 1e-30, 0.5, 0.999_999, 1.0, 1.000_001, 1e6] {
        case.rows.extend([1.0, 1.000_001, 2.0, 1e6].map(|plies| reals(&[fiber_px, plies * fiber_px, 1.0])));
        case.rows.extend([0.999_999, 1.0, 1.000_001].map(|ply_px| reals(&[fiber_px, ply_px, 1.0])));
    }
    case.rows.push(reals(&[0.5, 5.0, 0.0]));
    case
}

fn share_kept() -> Case {
    let mut case = case(
        "share_kept",
        |random| {
            let thin = random.magnitude(0.05, 2.0);
            let fiber_px = thin * random.magnitude(1e-4, 10.0);
            reals(&[fiber_px, fiber_px * random.magnitude(1.0, 100.0), thin])
        },
        |args| vec![number("share", detail::share_kept(args.real(), args.real(), args.real()), FLOOR)],
    );
    for fiber_px in [0.0, 1e-30, 0.25, 1.0, 1e6] {
        case.rows.extend([0.0, 1.0, 1e6].map(|ply_px| reals(&[fiber_px, ply_px, 0.25])));
    }
    case
}

fn detail_of() -> Case {
    let mut case = case(
        "detail_of",
        |random| {
            let fiber_mm = random.magnitude(1e-3, 0.05);
            // From a fiber of twice the threshold to a ply of a tenth of it.
            let threshold = random.magnitude(0.1, 4.0);
            let ply_mm = fiber_mm * random.between(2.0, 40.0);
            let pixel_mm = random.magnitude(fiber_mm / threshold, 20.0 * ply_mm / threshold);
            let ranks = f64::from(random.below(600));
            reals(&[pixel_mm, threshold, random.magnitude(0.05, 2.0), fiber_mm, ply_mm, ranks])
        },
        |args| {
            let (pixel_mm, threshold, thin) = (args.real(), args.real(), args.real());
            let widths = DetailWidths {
                fiber_radius_mm: args.real(),
                ply_radius_mm: args.real(),
                core_ranks: args.real(),
            };
            let found = detail::detail_of(pixel_mm, threshold, thin, &widths);
            vec![
                number("kept", found.kept, FLOOR),
                number("share", found.share, FLOOR),
                number("level", found.level, FLOOR),
            ]
        },
    );
    for pixel_mm in [1e-9, 1e-3, 0.02, 0.1, 10.0, 1e9] {
        for ranks in [0.0, 1.0, 2000.0] {
            case.rows.push(reals(&[pixel_mm, 1.0, 0.25, 0.01, 0.2, ranks]));
        }
    }
    case
}

fn rank_weight() -> Case {
    let mut case = case(
        "rank_weight",
        |random| {
            let rank = random.below(2000);
            row().bits(rank).real((f64::from(rank) + 1.0) * random.between(0.6, 1.15)).end()
        },
        |args| vec![number("weight", detail::rank_weight(args.bits(), args.real()), FLOOR)],
    );
    for rank in [0, 1, 53, MAX_FIBERS] {
        let own = f64::from(rank) + 1.0;
        case.rows
            .extend([0.0, 0.75 * own, 0.76 * own, own, 1e6].map(|kept| row().bits(rank).real(kept).end()));
    }
    case
}

fn slot_row(slot: u32, fiber_count: u32) -> Row {
    row().bits(slot).bits(detail::slot_stride(fiber_count)).bits(fiber_count).end()
}

fn fiber_of_slot() -> Case {
    let mut case = case(
        "fiber_of_slot",
        |random| {
            let fiber_count = 1 + random.below(MAX_FIBERS);
            slot_row(random.below(fiber_count), fiber_count)
        },
        |args| {
            let fiber = detail::fiber_of_slot(args.bits(), args.bits(), args.bits());
            vec![number("fiber", fiber.into(), 1.0)]
        },
    );
    for fiber_count in [1, 2, 3, 64, MAX_FIBERS] {
        case.rows.extend([0, fiber_count / 2, fiber_count - 1].map(|slot| slot_row(slot, fiber_count)));
    }
    case
}

/// Shares kept that are special: none, next to none, all but few, all, and more than all.
const SPECIAL_SHARES: [f64; 9] = [0.0, 1e-9, 1e-6, 1e-3, 0.5, 0.9, 1.0, 1.1, 1e6];

fn thinning_weight() -> Case {
    let mut case = case(
        "thinning_weight",
        |random| {
            let place = random.magnitude(1e-4, 1.0);
            reals(&[place, place * random.between(0.85, 1.2)])
        },
        |args| vec![number("weight", detail::thinning_weight(args.real(), args.real()), FLOOR)],
    );
    for share in SPECIAL_SHARES {
        case.rows.extend([1e-4, 0.5, 0.999_9].map(|place| reals(&[place, share])));
    }
    case
}

fn width_factor() -> Case {
    let mut case = case(
        "width_factor",
        |random| reals(&[random.between(0.0, 1.0), random.magnitude(1e-4, 10.0)]),
        |args| vec![number("factor", detail::width_factor(args.real(), args.real()), FLOOR)],
    );
    for share in SPECIAL_SHARES {
        case.rows.extend([0.0, 0.3, 1.0].map(|thinning| reals(&[thinning, share])));
    }
    case
}

fn flying_radius() -> Case {
    case(
        "flying_radius",
        |random| row().random_fiber(random).random_hairy(random).end(),
        |args| {
            let (fiber, hairy) = (args.fiber(), args.hairy());
            vec![number("radius", detail::flying_radius(&fiber, hairy.yarn.migration_max), FLOOR)]
        },
    )
}

/// How much of its reach a period has to spare beyond what it takes to stand out of the ply.
fn to_spare(args: &mut Args<'_>) -> f64 {
    let (fiber, period, most) = (args.fiber(), args.period(), args.hairy().yarn.migration_max);
    let low = fiber.radius * most;
    (period.reach - low).max(0.0) - (detail::flying_radius(&fiber, most) - low)
}

fn flying_range() -> Case {
    let mut case = case(
        "flying_range",
        |random| {
            loop {
                let radius = match random.below(8) {
                    0 => 0.0,
                    1 => 1.0,
                    _ => random.between(0.0, 1.0),
                };
                let fiber = row().real(radius).real(0.0);
                let index = random.below(2000);
                let made = fiber.period(random, index).random_hairy(random).end();
                // One that just reaches out has a place there or none as the last digit falls.
                if to_spare(&mut Args::new(&made)).abs() > 1e-4 {
                    return made;
                }
            }
        },
        |args| {
            let (fiber, period, hairy) = (args.fiber(), args.period(), args.hairy());
            let range = detail::flying_range(&fiber, &period, hairy.yarn.migration_max);
            vec![number("from", range.x, FLOOR), number("to", range.y, FLOOR)]
        },
    );
    // Few of the rows above are loops: as many again with every kind alike.
    case.rows.extend(random_rows("flying_range of any", |random| {
        loop {
            let made = row().random_fiber(random).random_period(random).random_hairy(random).end();
            if to_spare(&mut Args::new(&made)).abs() > 1e-4 {
                return made;
            }
        }
    }));
    case
}

fn flyaway_twin(args: &mut Args<'_>) -> bool {
    let (strand, fiber, index, hairy) = (args.strand(), args.fiber(), args.bits(), args.hairy());
    let periods = CurvePeriods { seed: hairy.seed, ..strand.periods };
    detail::has_flyaway(&strand.turns, &fiber, index, &periods, (&hairy.yarn, &hairy.flyaways))
}

/// Pieces of at most two migrations, mostly short ones: a long piece nearly always holds a flyaway.
fn flyaway_row(random: &mut Random) -> Row {
    let count = if random.below(2) == 0 { 0 } else { 1 + random.below(300) };
    let whole = random.below(600) as i32 - 300;
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let (turns, delta) = (random.between(0.0, 1.0), sign * random.magnitude(1e-3, 2.0));
    let placed = row().segment(random.below(2000), whole, count, turns, delta);
    placed.random_fiber(random).bits(random.below(600)).random_hairy(random).end()
}

fn has_flyaway() -> Case {
    case("has_flyaway", flyaway_row, |args| vec![truth("one", flyaway_twin(args))])
}

#[test]
fn pieces_with_and_without_a_flyaway_are_tried() {
    let rows = has_flyaway().rows;
    let with = rows.iter().filter(|row| flyaway_twin(&mut Args::new(row))).count();
    assert!(4 * with > rows.len() && 4 * with < 3 * rows.len(), "{with} of {}", rows.len());
}

fn nth_set_bit() -> Case {
    let bit_row = |mask: u64, n: u32| row().bits(mask as u32).bits((mask >> u32::BITS) as u32).bits(n).end();
    let mut case = case(
        "nth_set_bit",
        |random| {
            loop {
                let mut mask = u64::from(random.bits()) << u32::BITS | u64::from(random.bits());
                for _ in 0..random.below(4) {
                    mask &= u64::from(random.bits()) << u32::BITS | u64::from(random.bits());
                }
                if mask != 0 {
                    return bit_row(mask, random.below(mask.count_ones()));
                }
            }
        },
        |args| {
            let mask = u64::from(args.bits()) | u64::from(args.bits()) << u32::BITS;
            vec![number("place", detail::nth_set_bit(mask, args.bits()).into(), 1.0)]
        },
    );
    let ends = 1 << 63 | 1 << 32 | 1 << 31 | 1;
    for mask in [u64::MAX, ends, 1, 1 << 63, u64::from(u32::MAX), !u64::from(u32::MAX)] {
        case.rows.extend((0..mask.count_ones()).map(|n| bit_row(mask, n)));
    }
    case
}
