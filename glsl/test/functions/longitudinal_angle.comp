#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/angle.glsl"

void run() {
    vec3 tangent = take_vec3();
    vec3 w = take_vec3();
    give(longitudinal_angle(tangent, w));
}
