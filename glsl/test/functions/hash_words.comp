#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    uvec3 words = take_words();
    uint w = take_uint();
    uvec4 hashed = hash_words(uvec4(words, w));
    give_bits(hashed.x);
    give_bits(hashed.y);
    give_bits(hashed.z);
    give_bits(hashed.w);
}
