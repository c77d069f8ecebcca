#version 460
#extension GL_GOOGLE_include_directive : require
#include "entries.glsl"

void run() {
    float theta_sum = take_float();
    float cos_i = take_float();
    float cos_half_phi = take_float();
    Scattering s = take_scattering();
    vec3 r, tt;
    bcsdf(theta_sum, cos_i, cos_half_phi, 0.0, s, r, tt);
    give(r);
    give(tt);
}
