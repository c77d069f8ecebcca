#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/density.glsl"

void run() {
    float radius = take_float();
    float beta = take_float();
    give(fiber_density(radius, beta, take_float()));
}
