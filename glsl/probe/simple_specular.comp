#version 460
#extension GL_GOOGLE_include_directive : require
#include "../test/kernel.glsl"
#include "../bsdf/simple.glsl"

void run() {
    float strength = take_float();
    float cos_half_phi = take_float();
    float theta_h = take_float();
    float width = take_float();
    give(strength * simple_specular(cos_half_phi, theta_h, width, 0.0));
}
