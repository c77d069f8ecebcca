#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/strip.glsl"

void run() {
    vec3 tangent = take_vec3();
    vec3 side = take_vec3();
    float across = take_float();
    give(strip_normal(tangent, side, across));
}
