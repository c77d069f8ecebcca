#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Fiber fiber = take_fiber();
    Period period = take_period();
    float x = take_float();
    float x_rate = take_float();
    Yarn yarn = take_yarn();
    give(hair_shape(fiber, period, x, x_rate, yarn));
}
