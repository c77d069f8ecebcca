#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/occlusion.glsl"

void run() {
    vec4 cubic = take_vec4();
    float distance = take_float();
    give(distance_occlusion(cubic, distance));
}
