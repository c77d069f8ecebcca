#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    Fiber fiber = take_fiber();
    Yarn yarn = take_yarn();
    give(flying_radius(fiber, yarn));
}
