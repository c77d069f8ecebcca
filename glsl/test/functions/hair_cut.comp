#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Period period = take_period();
    give(hair_cut(period));
}
