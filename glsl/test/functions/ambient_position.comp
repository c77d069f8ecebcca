#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    float x_o = take_float();
    give(ambient_position(x_o, take_float()));
}
