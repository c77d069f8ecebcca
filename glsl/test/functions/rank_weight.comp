#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    uint rank = take_uint();
    float kept = take_float();
    give(rank_weight(rank, kept));
}
