#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    float thinning = take_float();
    float share = take_float();
    give(width_factor(thinning, share));
}
