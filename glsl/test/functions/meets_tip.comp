#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Segment segment = take_segment();
    Fiber fiber = take_fiber();
    uint fiber_index = take_uint();
    int index = int(take_uint());
    float u = take_float();
    float u_neighbour = take_float();
    Yarn yarn = take_yarn();
    Period period;
    float tip;
    bool meets = meets_tip(segment, fiber, fiber_index, index, u, u_neighbour, yarn, period, tip);
    give(meets);
    give(meets ? tip : 0.0);
}
