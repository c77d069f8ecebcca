#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    float cos_half_phi = take_float();
    float k = take_float();
    give(azimuthal_tt(cos_half_phi, k, take_float()));
}
