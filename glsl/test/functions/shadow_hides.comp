#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/shadow_map.glsl"

void run() {
    uint depth_bits = take_uint();
    uint number = take_uint();
    float depth = take_float();
    uint piece = take_uint();
    float window = take_float();
    give(shadow_hides(uvec2(depth_bits, number), depth, piece, window) ? 1.0 : 0.0);
}
