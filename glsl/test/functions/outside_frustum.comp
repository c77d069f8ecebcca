#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/level.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    float margin = take_float();
    vec4 planes[5];
    for (int k = 0; k < 5; ++k) {
        planes[k] = take_vec4();
    }
    give(outside_frustum(b, margin, planes) ? 1.0 : 0.0);
}
