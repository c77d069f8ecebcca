#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/strip.glsl"

void run() {
    float across = take_float();
    vec4 normals = strip_normals(across);
    give(normals.xyz);
    give(normals.w);
}
