#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/fiber.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    vec3 normal_start = take_vec3();
    vec3 normal_end = take_vec3();
    float t = take_float();
    YarnPoint y = yarn_point(b, normal_start, normal_end, t);
    give(y.center);
    give(y.tangent);
    give(y.normal);
    give(y.speed);
    give(y.bend);
}
