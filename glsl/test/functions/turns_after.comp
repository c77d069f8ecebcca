#version 460
#extension GL_GOOGLE_include_directive : require
#include "../packed_kernel.glsl"

void run() {
    uint phase = take_uint();
    uvec2 rate = take_uvec2();
    int whole;
    give(turns_after(phase, rate, take_uvec2(), whole));
    give_word(uint(whole));
}
