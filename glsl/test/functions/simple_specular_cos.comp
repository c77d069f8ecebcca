#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../bsdf/simple.glsl"

void run() {
    vec3 tangent = take_vec3();
    vec3 to_light = take_vec3();
    vec3 to_eye = take_vec3();
    float width = take_float();
    float variance = take_float();
    give(simple_specular_cos(tangent, to_light, to_eye, width, variance));
}
