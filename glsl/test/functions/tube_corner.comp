#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/tube.glsl"

void run() {
    vec3 center = take_vec3();
    vec3 tangent = take_vec3();
    vec3 toward = take_vec3();
    float radius = take_float();
    uint row = take_uint();
    float edge = take_float();
    give(tube_corner(center, tangent, toward, radius, row, edge));
}
