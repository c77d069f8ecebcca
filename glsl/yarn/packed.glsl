// Pieces of yarn as they lie in memory: exact rest length and curve in 8 bytes, from which turns follow by fixed-point
// arithmetic that loses no whole turn; twin: src/yarn/packed.rs.
#ifndef WORSTED_PACKED
#define WORSTED_PACKED

#include "../shared/layouts.glsl"
#include "segment.glsl"

// Bits of a rest length, in units of the curve's whole length / 2^42: 10 of them share a word with the curve.
const uint LENGTH_HIGH_BITS = 10u;
const uint LENGTH_HIGH_MASK = (1u << LENGTH_HIGH_BITS) - 1u;
// The whole curve's length in units, low word first.
const uvec2 WHOLE_LENGTH = uvec2(0u, 1u << LENGTH_HIGH_BITS);
// Migrations after which those of an open curve count from 0 again.
const uint MOST_MIGRATIONS = 1u << 22;

// A curve's place in the table of curves.
uint packed_curve(Piece piece) {
    return piece.length_high_curve >> LENGTH_HIGH_BITS;
}

// Rest length before a piece, in units.
uvec2 packed_length(Piece piece) {
    return uvec2(piece.length_low, piece.length_high_curve & LENGTH_HIGH_MASK);
}

// Rest length of a piece in units; `next` is the one behind it in memory, which may be of another curve.
uvec2 packed_extent(Piece piece, Piece next) {
    uvec2 start = packed_length(piece);
    uvec2 end = packed_curve(piece) == packed_curve(next) ? packed_length(next) : WHOLE_LENGTH;
    return uvec2(end.x - start.x, end.y - start.y - (end.x < start.x ? 1u : 0u));
}

// The number of units as a float.
float units_float(uvec2 units) {
    return float(units.y) * 4294967296.0 + float(units.x);
}

// Turns after `units` of a curve that begins at `phase` (2^-32 turns) and makes `rate` (2^-64 turns, two's complement) in
// each, modulo 2^32: the whole ones, rounded down, and what is left, in [0, 1].
float turns_after(uint phase, uvec2 rate, uvec2 units, out int whole) {
    uint low_high, low_low, cross_high, cross_low, other_high, other_low;
    umulExtended(units.x, rate.x, low_high, low_low);
    umulExtended(units.x, rate.y, cross_high, cross_low);
    umulExtended(units.y, rate.x, other_high, other_low);
    uint carry_a, carry_b, carry_c;
    uint fraction = uaddCarry(low_high, cross_low, carry_a);
    fraction = uaddCarry(fraction, other_low, carry_b);
    fraction = uaddCarry(fraction, phase, carry_c);
    uint turns = cross_high + other_high + units.y * rate.y + carry_a + carry_b + carry_c;
    // Below 0 the high word stands for 2^32 less than it says.
    turns -= (rate.y >> 31) != 0u ? units.x : 0u;
    whole = int(turns);
    return float(fraction) * (1.0 / 4294967296.0);
}

// Turns over `units`.
float turns_over(uvec2 rate, uvec2 units) {
    bool negative = (rate.y >> 31) != 0u;
    // The magnitude first: close to 0 the two words of a negative number would cancel.
    uvec2 size = negative ? uvec2(~rate.x + 1u, ~rate.y + (rate.x == 0u ? 1u : 0u)) : rate;
    float turns = units_float(size) * (1.0 / 4294967296.0) * (units_float(units) * (1.0 / 4294967296.0));
    return negative ? -turns : turns;
}

// Rest length of a piece in mm.
float packed_length_mm(uvec2 extent, Curve curve) {
    return units_float(extent) * (1.0 / 4398046511104.0) * curve.length_mm;
}

// Everything of piece `index`. `stride` is from one piece's first control point to the next one's.
Segment unpacked_segment(Piece piece, Piece next, Curve curve, uint index, uint stride) {
    uvec2 length = packed_length(piece);
    uvec2 extent = packed_extent(piece, next);
    Segment segment;
    segment.first_point = curve.first_point + stride * index;
    segment.curve = curve.curve;
    segment.migration_period_count = curve.migration_period_count;
    int whole;
    segment.ply_turns = turns_after(curve.ply_phase, curve.ply_rate, length, whole);
    segment.fiber_turns = turns_after(curve.fiber_phase, curve.fiber_rate, length, whole);
    segment.length_start = LENGTH_STRIPE * turns_after(0u, curve.stripe_rate, length, whole);
    segment.migration_turns = turns_after(curve.migration_phase, curve.migration_rate, length, whole);
    bool wraps = curve.migration_period_count == MOST_MIGRATIONS;
    segment.migration_period = wraps ? whole & int(MOST_MIGRATIONS - 1u) : whole;
    segment.ply_turns_delta = turns_over(curve.ply_rate, extent);
    segment.fiber_turns_delta = turns_over(curve.fiber_rate, extent);
    segment.migration_turns_delta = turns_over(curve.migration_rate, extent);
    segment.length_mm = packed_length_mm(extent, curve);
    return segment;
}

#endif
