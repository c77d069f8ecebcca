//! `glsl/yarn/packed.glsl`: whole numbers are held to be equal, as halves of words, which floats hold exactly.

use crate::harness::{Args, Case, Part, Row, number, numbers};
use crate::inputs::{Random, RowBuilder, random_rows, row};
use worsted::gpu_types::LENGTH_STRIPE;
use worsted::yarn::packed::{self, MOST_CURVES, PackedCurve, WHOLE_LENGTH};
use worsted::yarn::strand::MOST_MIGRATIONS;

/// Of turns in [0, 1): a few steps of f32 below 1.
const TURNS_BOUND: f64 = 3e-7;

pub fn cases() -> Vec<Case> {
    let mut all = vec![packed_curve(), packed_length(), packed_extent(), units_float()];
    all.extend([turns_after(), turns_over(), packed_length_mm(), unpacked_segment()]);
    all
}

fn word(name: &'static str, word: u32) -> Part {
    numbers(name, vec![f64::from(word & 0xffff), f64::from(word >> 16)], 1.0).within(0.0)
}

fn words(name: &'static str, words: u64) -> Part {
    let halves = (0..4).map(|k| f64::from((words >> (16 * k)) as u16)).collect();
    numbers(name, halves, 1.0).within(0.0)
}

fn two(row: RowBuilder, words: u64) -> RowBuilder {
    row.bits(words as u32).bits((words >> 32) as u32)
}

fn take_two(args: &mut Args<'_>) -> u64 {
    u64::from(args.bits()) | u64::from(args.bits()) << 32
}

fn take_packed(args: &mut Args<'_>) -> [u32; 2] {
    [args.bits(), args.bits()]
}

/// A length along a curve: any, near either end, or near where its low word is full.
fn units(random: &mut Random) -> u64 {
    let any = u64::from(random.bits()) << 10 | u64::from(random.bits() >> 22);
    match random.below(4) {
        0 => any >> random.below(42),
        1 => WHOLE_LENGTH - 1 - (any >> random.below(42)),
        2 => (any >> 32 << 32).wrapping_sub(u64::from(random.below(3))) % WHOLE_LENGTH,
        _ => any,
    }
}

/// Of curves of a thousandth of a turn to ten million, either way.
fn rate(random: &mut Random) -> i64 {
    let turns = random.magnitude(1e-3, 1e7);
    packed::packed_rate(if random.below(2) == 0 { turns } else { -turns })
}

/// A piece and the one behind it, often of the same curve.
fn neighbours(random: &mut Random) -> RowBuilder {
    let curve = random.below(MOST_CURVES as u32);
    let next = if random.below(4) == 0 { random.below(MOST_CURVES as u32) } else { curve };
    let (a, b) = (units(random), units(random));
    let pieces = [packed::packed_piece(a.min(b), curve), packed::packed_piece(a.max(b), next)];
    pieces.iter().flatten().fold(row(), |row, &word| row.bits(word))
}

fn packed_curve() -> Case {
    let rows = random_rows("packed_curve", |random| row().bits(random.bits()).bits(random.bits()).end());
    let twin = |args: &mut Args<'_>| vec![word("curve", packed::packed_curve(take_packed(args)))];
    Case { function: "packed_curve", rows, twin, invariant: None }
}

fn packed_length() -> Case {
    let rows = random_rows("packed_length", |random| row().bits(random.bits()).bits(random.bits()).end());
    let twin = |args: &mut Args<'_>| vec![words("units", packed::packed_length(take_packed(args)))];
    Case { function: "packed_length", rows, twin, invariant: None }
}

fn packed_extent() -> Case {
    let twin = |args: &mut Args<'_>| {
        let (piece, next) = (take_packed(args), take_packed(args));
        vec![words("units", packed::packed_extent(piece, next))]
    };
    let rows = random_rows("packed_extent", |random| neighbours(random).end());
    Case { function: "packed_extent", rows, twin, invariant: None }
}

fn units_float() -> Case {
    let rows = random_rows("units_float", |random| two(row(), units(random)).end());
    let twin =
        |args: &mut Args<'_>| vec![number("units", packed::units_float(take_two(args)), 1e-3).within(2e-7)];
    Case { function: "units_float", rows, twin, invariant: None }
}

fn turns_after() -> Case {
    let mut rows = random_rows("turns_after", |random| {
        let phase = row().bits(random.bits());
        two(two(phase, rate(random) as u64), units(random)).end()
    });
    let extreme = [0, 1, -1, 1 << 32, -(1 << 32), i64::MAX, i64::MIN, i64::MIN + 1];
    for rate in extreme {
        for units in [0, 1, u64::from(u32::MAX), 1 << 32, WHOLE_LENGTH - 1, WHOLE_LENGTH] {
            let row = |phase| two(two(row().bits(phase), rate as u64), units).end();
            rows.extend([0, 1 << 31, u32::MAX].map(row));
        }
    }
    let twin = |args: &mut Args<'_>| {
        let (whole, left) = packed::turns_after(args.bits(), take_two(args) as i64, take_two(args));
        vec![number("left", left, 1.0).within(TURNS_BOUND), word("whole", whole as u32)]
    };
    Case { function: "turns_after", rows, twin, invariant: None }
}

fn turns_over() -> Case {
    let rows: Vec<Row> =
        random_rows("turns_over", |random| two(two(row(), rate(random) as u64), units(random)).end());
    let twin = |args: &mut Args<'_>| {
        let turns = packed::turns_over(take_two(args) as i64, take_two(args));
        vec![number("turns", turns, 1e-6).within(1e-6)]
    };
    Case { function: "turns_over", rows, twin, invariant: None }
}

fn packed_length_mm() -> Case {
    let rows = random_rows("packed_length_mm", |random| {
        two(row(), units(random)).real(random.magnitude(1e-2, 1e8)).end()
    });
    let twin = |args: &mut Args<'_>| {
        let extent = take_two(args);
        let curve = PackedCurve { length_mm: args.real(), ..Default::default() };
        vec![number("length", packed::packed_length_mm(extent, &curve), 1e-6)]
    };
    Case { function: "packed_length_mm", rows, twin, invariant: None }
}

fn unpacked_segment() -> Case {
    let rows = random_rows("unpacked_segment", |random| {
        let pieces = neighbours(random).bits(random.bits()).bits(random.bits());
        let count = if random.below(2) == 0 { MOST_MIGRATIONS } else { random.below(1000) };
        let phases = (0..3).fold(pieces.bits(count), |row, _| row.bits(random.bits()));
        let rates = (0..4).fold(phases, |row, _| two(row, rate(random) as u64));
        let length = rates.real(random.magnitude(1e-2, 1e8));
        length.bits(random.bits()).bits([1, 3][random.below(2) as usize]).end()
    });
    Case { function: "unpacked_segment", rows, twin: unpacked_twin, invariant: None }
}

fn unpacked_twin(args: &mut Args<'_>) -> Vec<Part> {
    let (piece, next) = (take_packed(args), take_packed(args));
    let curve = PackedCurve {
        first_point: args.bits(),
        curve: args.bits(),
        migration_period_count: args.bits(),
        phases: std::array::from_fn(|_| args.bits()),
        rates: std::array::from_fn(|_| take_two(args) as i64),
        stripe_rate: take_two(args) as i64,
        length_mm: args.real(),
    };
    let segment = packed::unpacked_segment(piece, next, &curve, args.bits(), args.bits());
    let turns = [segment.turns.ply, segment.turns.fiber, segment.turns.migration];
    let stripe = f64::from(LENGTH_STRIPE);
    vec![
        word("first point", segment.first_point),
        word("curve", curve.curve),
        word("count", curve.migration_period_count),
        word("period", segment.migration_period as u32),
        numbers("turns", turns.map(|turns| turns.start).to_vec(), 1.0).within(TURNS_BOUND),
        numbers("deltas", turns.map(|turns| turns.delta).to_vec(), 1e-6).within(1e-6),
        number("length before", stripe * segment.stripes_start, stripe).within(TURNS_BOUND),
        number("length", segment.length_mm, 1e-6),
    ]
}
