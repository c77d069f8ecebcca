#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/tone.glsl"

void run() {
    vec3 linear = take_vec3();
    give(tone_filmic(linear));
}
