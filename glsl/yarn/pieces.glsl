// Reads pieces of yarn from the buffers of passes/bindings.glsl.
#ifndef WORSTED_PIECES
#define WORSTED_PIECES

#include "../lib/curve.glsl"
#include "packed.glsl"

// From one piece's first control point to the next one's.
const uint POINT_STRIDE = BASIS == BASIS_BEZIER ? 3u : 1u;

// First of a piece's four control points.
uint first_point_of(uint index) {
    return curves[packed_curve(yarn_pieces[index])].first_point + POINT_STRIDE * index;
}

// Rest length of a piece in mm.
float length_mm_of(uint index) {
    Piece piece = yarn_pieces[index];
    return packed_length_mm(packed_extent(piece, yarn_pieces[index + 1u]), curves[packed_curve(piece)]);
}

Segment segment_at(uint index) {
    Piece piece = yarn_pieces[index];
    return unpacked_segment(piece, yarn_pieces[index + 1u], curves[packed_curve(piece)], index, POINT_STRIDE);
}

#endif
