#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/angle.glsl"

void run() {
    float y = take_float();
    float x = take_float();
    give(angle_of(y, x));
}
