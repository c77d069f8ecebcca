#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    Scattering s = take_scattering();
    float theta_sum = take_float();
    float cos_i = take_float();
    float cos_half_phi = take_float();
    float variance = take_float();
    vec3 r, tt;
    bcsdf(theta_sum, cos_i, cos_half_phi, variance, s, r, tt);
    give(r);
    give(tt);
}
