#version 460
#extension GL_GOOGLE_include_directive : require
#include "../packed_kernel.glsl"

void run() {
    give_word(packed_curve(take_packed()));
}
