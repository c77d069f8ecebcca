#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/core.glsl"

void run() {
    float turns = take_float();
    float expected = take_float();
    give(nearest_turn(turns, expected));
}
