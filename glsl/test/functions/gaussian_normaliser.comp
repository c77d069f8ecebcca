#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    float cos_theta = take_float();
    give(gaussian_normaliser(cos_theta, take_float()));
}
