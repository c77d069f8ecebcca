#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/occlusion.glsl"

void run() {
    float x = take_float();
    float y = take_float();
    uint across = take_uint();
    vec2 place = occlusion_place(vec2(x, y), across);
    give(place.x);
    give(place.y);
}
