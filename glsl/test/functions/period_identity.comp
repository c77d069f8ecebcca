#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Segment segment = take_segment();
    int index = int(take_uint());
    Yarn yarn = take_yarn();
    give_bits(uint(period_identity(segment, index, yarn)));
}
