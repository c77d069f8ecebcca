#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Segment segment = take_segment();
    Fiber fiber = take_fiber();
    float t = take_float();
    Yarn yarn = take_yarn();
    give(period_turns(segment, fiber, t, yarn));
}
