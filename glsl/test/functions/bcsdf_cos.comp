#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    Scattering s = take_scattering();
    vec3 tangent = take_vec3();
    vec3 to_light = take_vec3();
    vec3 to_eye = take_vec3();
    float variance = take_float();
    vec3 r, tt;
    bcsdf_cos(tangent, to_light, to_eye, variance, s, r, tt);
    give(r);
    give(tt);
}
