#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Segment segment = take_segment();
    Fiber fiber = take_fiber();
    uint fiber_index = take_uint();
    float t = take_float();
    float before = take_float();
    float behind = take_float();
    Yarn yarn = take_yarn();
    StrandVertex vertex = strand_vertex(segment, fiber, fiber_index, t, vec2(before, behind), yarn);
    give(vertex.t);
    give(vertex.x);
    give(float(vertex.entry));
    give(float(vertex.exit));
    give(vertex.period);
}
