#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    Fiber fiber = take_fiber();
    Period period = take_period();
    Yarn yarn = take_yarn();
    vec2 range = flying_range(fiber, period, yarn);
    give(range.x);
    give(range.y);
}
