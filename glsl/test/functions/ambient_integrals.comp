#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    uint lobe = take_lobe();
    float width = take_float();
    float x_o = take_float();
    float cos_o = take_float();
    give(ambient_integrals(lobe, x_o, cos_o, width, TABLE_ENTRIES));
}
