#version 460
#extension GL_GOOGLE_include_directive : require
#include "../test/kernel.glsl"
#include "../shading/occlusion.glsl"

layout(set = 0, binding = 2) uniform sampler2D table;

void run() {
    float x = take_float();
    float y = take_float();
    give(texture_occlusion(table, occlusion_place(vec2(x, y), uint(textureSize(table, 0).x))));
}
