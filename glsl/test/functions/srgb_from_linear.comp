#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/tone.glsl"

void run() {
    float linear = take_float();
    give(srgb_from_linear(linear));
}
