#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    uint lobe = take_lobe();
    float width = take_float();
    float theta_sum = take_float();
    float cos_i = take_float();
    float variance = take_float();
    give(longitudinal(theta_sum, cos_i, width, variance, lobe, TABLE_ENTRIES));
}
