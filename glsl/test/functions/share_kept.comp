#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    float fiber_px = take_float();
    float ply_px = take_float();
    float thin = take_float();
    give(share_kept(fiber_px, ply_px, thin));
}
