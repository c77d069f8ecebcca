#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    float pixel_mm = take_float();
    float threshold = take_float();
    float thin = take_float();
    Yarn yarn;
    yarn.fiber_radius = take_float();
    yarn.ply_radius = take_float();
    yarn.core_ranks = take_float();
    Detail detail = detail_of(pixel_mm, threshold, thin, yarn);
    give(detail.kept);
    give(detail.share);
    give(detail.level);
}
