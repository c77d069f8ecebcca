#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    uint low = take_uint();
    uint high = take_uint();
    uint n = take_uint();
    give(float(nth_set_bit(uvec2(low, high), n)));
}
