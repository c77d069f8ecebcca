#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/chord_shadow.glsl"

void run() {
    float x = take_float();
    float y = take_float();
    float light_x = take_float();
    float light_y = take_float();
    float offset = take_float();
    float short_axis = take_float();
    float long_axis = take_float();
    give(ply_chord(vec2(x, y), vec2(light_x, light_y), offset, vec2(short_axis, long_axis)));
}
