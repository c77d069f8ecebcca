#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/angle.glsl"

void run() {
    vec3 tangent = take_vec3();
    vec3 a = take_vec3();
    vec3 b = take_vec3();
    give(cos_half_azimuth(tangent, a, b));
}
