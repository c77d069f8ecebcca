#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/core.glsl"

void run() {
    float level = take_float();
    Yarn yarn;
    for (uint k = 0; k < CORE_LEVELS; ++k) {
        yarn.core_thickness[k] = take_float();
    }
    give(core_thickness(level, yarn));
}
