#version 460
#extension GL_GOOGLE_include_directive : require
#include "../packed_kernel.glsl"

void run() {
    uvec2 rate = take_uvec2();
    give(turns_over(rate, take_uvec2()));
}
