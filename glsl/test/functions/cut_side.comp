#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Period period = take_period();
    float x = take_float();
    give(float(cut_side(period, x)));
}
