#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    uint a = take_uint();
    uint b = take_uint();
    give(normal_from_words(a, b));
}
