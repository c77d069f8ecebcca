#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/occlusion.glsl"

void run() {
    float visibility = take_float();
    vec4 lean = take_vec4();
    float distance = take_float();
    give(reflected_occlusion(visibility, lean, distance, take_float()));
}
