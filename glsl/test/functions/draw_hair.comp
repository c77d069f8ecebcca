#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    uvec3 words = take_words();
    float fiber_radius = take_float();
    Yarn yarn = take_yarn();
    Period period;
    period.index = 0;
    period.kind = KIND_HAIR;
    period.root_first = take_uint() != 0;
    draw_hair(period, words, fiber_radius, yarn);
    give(period);
}
