#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/chord_shadow.glsl"
#include "../plies.glsl"

layout(set = 0, binding = 3) uniform sampler3D table;

void run() {
    float x = take_float();
    float y = take_float();
    float light_x = take_float();
    float light_y = take_float();
    Plies plies = take_plies();
    give(chord_depth(table, vec2(x, y), vec2(light_x, light_y), plies));
}
