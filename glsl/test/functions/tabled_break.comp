#version 460
#extension GL_GOOGLE_include_directive : require
#include "../turning_kernel.glsl"

void run() {
    vec4 breaks[TABLED_BREAKS / 4u];
    for (uint k = 0u; k < TABLED_BREAKS; ++k) {
        breaks[k / 4u][k % 4u] = take_float();
    }
    float share = take_float();
    give(tabled_break(breaks, share));
}
