#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"
#include "../../lib/coverage.glsl"

void run() {
    float alpha = take_float();
    uint samples = take_uint();
    uint word = take_uint();
    give_bits(coverage_mask(alpha, samples, word));
}
