#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    uint word = take_uint();
    give(uniform_from_word(word));
}
