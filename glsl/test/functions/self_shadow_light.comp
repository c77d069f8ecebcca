#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/self_shadow.glsl"

void run() {
    float depth = take_float();
    float extinction = take_float();
    float sin_angle = take_float();
    give(self_shadow_light(depth, extinction, sin_angle));
}
