#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    uvec3 words = take_words();
    float mean = take_float();
    float deviation = take_float();
    give(draw_positive(words, mean, deviation));
}
