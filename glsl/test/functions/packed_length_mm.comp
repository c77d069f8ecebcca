#version 460
#extension GL_GOOGLE_include_directive : require
#include "../packed_kernel.glsl"

void run() {
    uvec2 extent = take_uvec2();
    Curve curve;
    curve.length_mm = take_float();
    give(packed_length_mm(extent, curve));
}
