#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Fiber fiber = take_fiber();
    float phase = take_float();
    float phase_rate = take_float();
    Yarn yarn = take_yarn();
    give(migration_shape(fiber, phase, phase_rate, yarn));
}
