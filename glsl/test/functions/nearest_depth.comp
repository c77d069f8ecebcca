#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/level.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    vec4 depth = take_vec4();
    float margin = take_float();
    float nearest = take_float();
    give(nearest_depth(b, depth, margin, nearest));
}
