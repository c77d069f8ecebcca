#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    float cos_o = take_float();
    give(grazing_moment(cos_o, take_float()));
}
