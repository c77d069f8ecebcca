#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/strip.glsl"

void run() {
    vec3 tangent = take_vec3();
    vec3 to_eye = take_vec3();
    give(strip_side(tangent, to_eye));
}
