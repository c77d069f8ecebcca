#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    uint lobe = take_lobe();
    vec4 factors = scattering_table_at(lobe, take_float(), TABLE_ENTRIES);
    give(factors.xyz);
    give(factors.w);
}
