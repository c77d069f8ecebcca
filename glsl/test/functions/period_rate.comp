#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Segment segment = take_segment();
    Yarn yarn = take_yarn();
    give(period_rate(segment, yarn));
}
