#version 460
#extension GL_GOOGLE_include_directive : require
#include "../test/kernel.glsl"
#include "../shading/self_shadow.glsl"

layout(set = 0, binding = 2) uniform sampler3D table;

void run() {
    float x = take_float();
    float y = take_float();
    float light_x = take_float();
    float light_y = take_float();
    uint ply_count = take_uint();
    uvec2 size = uvec2(textureSize(table, 0).xz);
    give(self_shadow_depth(table, self_shadow_place(vec2(x, y), vec2(light_x, light_y), ply_count, size)));
}
