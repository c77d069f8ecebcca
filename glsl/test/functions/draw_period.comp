#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Segment segment = take_segment();
    Fiber fiber = take_fiber();
    uint fiber_index = take_uint();
    int index = int(take_uint());
    Yarn yarn = take_yarn();
    give(draw_period(segment, fiber, fiber_index, index, yarn));
}
