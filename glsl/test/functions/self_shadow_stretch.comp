#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/self_shadow.glsl"

void run() {
    float sin_angle = take_float();
    give(self_shadow_stretch(sin_angle));
}
