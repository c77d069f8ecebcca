#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    float identity = take_float();
    float share = take_float();
    give(thinning_weight(identity, share));
}
