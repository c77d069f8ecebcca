#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../bsdf/simple.glsl"

void run() {
    float cos_half_phi = take_float();
    float theta_h = take_float();
    float width = take_float();
    float variance = take_float();
    give(simple_specular(cos_half_phi, theta_h, width, variance));
}
