#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../bsdf/simple.glsl"

void run() {
    vec3 spread = take_vec3();
    vec3 side = take_vec3();
    vec3 toward = take_vec3();
    vec3 to_light = take_vec3();
    vec3 to_eye = take_vec3();
    give(half_angle_variance(spread, side, toward, to_light, to_eye));
}
