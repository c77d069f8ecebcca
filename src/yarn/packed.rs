//! Pieces of yarn as they lie in memory: exact rest length and curve in 8 bytes, from which turns follow by fixed-point
//! arithmetic that loses no whole turn; twin of `glsl/yarn/packed.glsl`.

use super::fiber::{PieceTurns, Turns};
use super::strand::MOST_MIGRATIONS;

/// Bits of a rest length, in units of the curve's whole length / 2^42.
pub const LENGTH_BITS: u32 = 42;
/// Of these, how many share a word with the curve; `LENGTH_HIGH_BITS` in GLSL.
pub const LENGTH_HIGH_BITS: u32 = LENGTH_BITS - 32;
/// Curves that fit beside them. The last one stands behind all others, so that every piece has a next.
pub const MOST_CURVES: usize = 1 << (32 - LENGTH_HIGH_BITS);
/// The whole curve's length in units.
pub const WHOLE_LENGTH: u64 = 1 << LENGTH_BITS;

/// A share of a curve's length in [0, 1) in units; 1 has no place, and is the last unit.
pub fn length_units(length_mm: f64, whole_mm: f64) -> u64 {
    if whole_mm <= 0.0 {
        return 0;
    }
    ((length_mm / whole_mm * WHOLE_LENGTH as f64).round() as u64).min(WHOLE_LENGTH - 1)
}

/// A piece's two words. `curve` is its place in the table of curves, less than [`MOST_CURVES`].
pub fn packed_piece(units: u64, curve: u32) -> [u32; 2] {
    [units as u32, (units >> 32) as u32 | curve << LENGTH_HIGH_BITS]
}

/// A curve's place in the table of curves.
pub fn packed_curve(piece: [u32; 2]) -> u32 {
    piece[1] >> LENGTH_HIGH_BITS
}

/// Rest length before a piece, in units.
pub fn packed_length(piece: [u32; 2]) -> u64 {
    let high = piece[1] & ((1 << LENGTH_HIGH_BITS) - 1);
    u64::from(high) << 32 | u64::from(piece[0])
}

/// Rest length of a piece in units; `next` is the one behind it in memory, which may be of another curve.
pub fn packed_extent(piece: [u32; 2], next: [u32; 2]) -> u64 {
    let same = packed_curve(piece) == packed_curve(next);
    let end = if same { packed_length(next) } else { WHOLE_LENGTH };
    end.wrapping_sub(packed_length(piece))
}

/// The number of units.
pub fn units_float(units: u64) -> f64 {
    units as f64
}

/// 2^-64 turns in each unit of a curve that makes so many in all. A whole number of turns is exact: a closed curve
/// closes. Beyond 2^41 turns only what is left of the whole ones is right.
pub fn packed_rate(turns: f64) -> i64 {
    // 2^64 / 2^42.
    let rate = turns * (1_u64 << (64 - LENGTH_BITS)) as f64;
    rate.round() as i128 as i64
}

/// Turns in [0, 1) as 2^-32 of one.
pub fn packed_phase(turns: f64) -> u32 {
    (turns.rem_euclid(1.0) * 2_f64.powi(32)) as u32
}

/// Turns after `units` of a curve that begins at `phase` (2^-32 turns) and makes `rate` (2^-64 turns) in each: the whole
/// ones, rounded down, modulo 2^32, and what is left, in [0, 1).
pub fn turns_after(phase: u32, rate: i64, units: u64) -> (i32, f64) {
    let turns = i128::from(rate) * i128::from(units) + (i128::from(phase) << 32);
    ((turns >> 64) as i32, (turns as u64) as f64 / 2_f64.powi(64))
}

/// Turns over `units`.
pub fn turns_over(rate: i64, units: u64) -> f64 {
    rate as f64 / 2_f64.powi(64) * units_float(units)
}

/// Rest length of a piece in mm.
pub fn packed_length_mm(extent: u64, curve: &PackedCurve) -> f64 {
    units_float(extent) / units_float(WHOLE_LENGTH) * curve.length_mm
}

/// What all pieces of a curve share.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PackedCurve {
    /// First control point of piece 0 if it were of this curve; wraps around.
    pub first_point: u32,
    /// The curve's number in its fabric.
    pub curve: u32,
    /// [`super::strand::Strands::period_counts`].
    pub migration_period_count: u32,
    /// Of plies, fibers and migration at the curve's start, in 2^-32 turns.
    pub phases: [u32; 3],
    /// Of the same, in 2^-64 turns per unit of length.
    pub rates: [i64; 3],
    /// Stripes of the length view, likewise.
    pub stripe_rate: i64,
    /// Its whole rest length in mm.
    pub length_mm: f64,
}

/// Everything of one piece, its turns reduced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnpackedSegment {
    /// First of its four control points.
    pub first_point: u32,
    /// Whole periods of the fibers' radius before it.
    pub migration_period: i32,
    /// Its turns; `start` in [0, 1).
    pub turns: PieceTurns,
    /// Rest length of the curve before it in stripes, their whole number left out.
    pub stripes_start: f64,
    /// Its rest length in mm.
    pub length_mm: f64,
}

/// Everything of piece `index`. `stride` is from one piece's first control point to the next one's.
pub fn unpacked_segment(
    piece: [u32; 2],
    next: [u32; 2],
    curve: &PackedCurve,
    index: u32,
    stride: u32,
) -> UnpackedSegment {
    let (length, extent) = (packed_length(piece), packed_extent(piece, next));
    let after = |k: usize| turns_after(curve.phases[k], curve.rates[k], length);
    let turns = |k: usize| Turns { start: after(k).1, delta: turns_over(curve.rates[k], extent) };
    let whole = after(2).0;
    let wraps = curve.migration_period_count == MOST_MIGRATIONS;
    UnpackedSegment {
        first_point: curve.first_point.wrapping_add(stride.wrapping_mul(index)),
        migration_period: if wraps { whole & (MOST_MIGRATIONS as i32 - 1) } else { whole },
        turns: PieceTurns { ply: turns(0), fiber: turns(1), migration: turns(2) },
        stripes_start: turns_after(0, curve.stripe_rate, length).1,
        length_mm: packed_length_mm(extent, curve),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_hold_lengths_and_curves_apart() {
        for units in [0, 1, u64::from(u32::MAX), 1 << 32, WHOLE_LENGTH - 1] {
            for curve in [0, 1, MOST_CURVES as u32 - 1] {
                let words = packed_piece(units, curve);
                assert_eq!((packed_length(words), packed_curve(words)), (units, curve));
            }
        }
        let (a, b) = (packed_piece(5, 7), packed_piece(12, 7));
        assert_eq!((packed_extent(a, b), packed_extent(a, packed_piece(12, 8))), (7, WHOLE_LENGTH - 5));
        assert_eq!((length_units(3.0, 3.0), length_units(0.0, 0.0)), (WHOLE_LENGTH - 1, 0));
        assert_eq!(length_units(1.5, 3.0), WHOLE_LENGTH / 2);
    }

    #[test]
    fn turns_are_counted_to_the_last_one() {
        for turns in [0.25, -0.3, 1.0, -3.0, -1e-3, 2.5e7, -2.5e7 - 0.125] {
            let rate = packed_rate(turns);
            for phase in [0.0, 0.1, 0.999] {
                for share in [0.0, 0.25, 0.5, 0.875] {
                    let units = (share * WHOLE_LENGTH as f64) as u64;
                    let (whole, left) = turns_after(packed_phase(phase), rate, units);
                    let expected = phase + share * turns;
                    // f64 itself is good to 4e-9 of 2.5e7 turns.
                    assert!((f64::from(whole) + left - expected).abs() < 1e-7, "{turns} {phase} {share}");
                    assert!((turns_over(rate, units) - share * turns).abs() < 1e-7);
                }
            }
            let closing = turns_after(7, packed_rate(turns.round()), WHOLE_LENGTH);
            assert_eq!(closing.1, turns_after(7, 0, 0).1, "a whole number of turns closes exactly");
            assert_eq!(f64::from(closing.0), turns.round());
        }
    }
}
