#version 460
#extension GL_GOOGLE_include_directive : require
#include "../packed_kernel.glsl"

void run() {
    Piece piece = take_packed();
    Piece next = take_packed();
    Curve curve = take_curve();
    uint index = take_uint();
    Segment segment = unpacked_segment(piece, next, curve, index, take_uint());
    give_word(segment.first_point);
    give_word(segment.curve);
    give_word(segment.migration_period_count);
    give_word(uint(segment.migration_period));
    give(vec3(segment.ply_turns, segment.fiber_turns, segment.migration_turns));
    give(vec3(segment.ply_turns_delta, segment.fiber_turns_delta, segment.migration_turns_delta));
    give(segment.length_start);
    give(segment.length_mm);
}
