#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/self_shadow.glsl"

void run() {
    float x = take_float();
    float y = take_float();
    float light_x = take_float();
    float light_y = take_float();
    uint ply_count = take_uint();
    uint across = take_uint();
    uint slices = take_uint();
    give(self_shadow_place(vec2(x, y), vec2(light_x, light_y), ply_count, uvec2(across, slices)));
}
