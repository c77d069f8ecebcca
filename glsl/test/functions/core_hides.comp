#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/core.glsl"

void run() {
    vec2 from_ply;
    from_ply.x = take_float();
    from_ply.y = take_float();
    vec2 to_eye;
    to_eye.x = take_float();
    to_eye.y = take_float();
    float level = take_float();
    float margin = take_float();
    Yarn yarn;
    yarn.ellipse_short = take_float();
    yarn.ellipse_long = take_float();
    for (uint k = 0; k < CORE_LEVELS; ++k) {
        yarn.core_opaque[k] = take_float();
    }
    give(core_hides(from_ply, to_eye, level, margin, yarn) ? 1.0 : 0.0);
}
