#version 460
#extension GL_GOOGLE_include_directive : require
#include "../packed_kernel.glsl"

void run() {
    give_words(packed_length(take_packed()));
}
