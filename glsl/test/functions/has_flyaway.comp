#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    Segment segment = take_segment();
    Fiber fiber = take_fiber();
    uint fiber_index = take_uint();
    Yarn yarn = take_yarn();
    give(has_flyaway(segment, fiber, fiber_index, yarn));
}
