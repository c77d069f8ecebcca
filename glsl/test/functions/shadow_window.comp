#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/shadow_map.glsl"

void run() {
    float along = take_float();
    float radius = take_float();
    float piece_length = take_float();
    give(shadow_window(along, radius, piece_length));
}
