#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Segment segment = take_segment();
    Fiber fiber = take_fiber();
    uint fiber_index = take_uint();
    float t = take_float();
    uint pieces = take_uint();
    Yarn yarn = take_yarn();
    StrandVertex vertex = strand_vertex(segment, fiber, fiber_index, t, pieces, yarn);
    give(vertex.t);
    give(vertex.x);
    give(float(vertex.entry));
    give(float(vertex.exit));
    give(vertex.period);
}
