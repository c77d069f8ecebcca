#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/level.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    float ply_turns = take_float();
    float fiber_turns = take_float();
    float ply_offset = take_float();
    float ellipse_long = take_float();
    float tolerance = take_float();
    float per_turn = take_float();
    uint largest = take_uint();
    give(float(subdivisions(b, ply_turns, fiber_turns, ply_offset, ellipse_long, tolerance, per_turn, largest)));
}
