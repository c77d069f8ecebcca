#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/special.glsl"

void run() {
    give(normal_density(take_float()));
}
