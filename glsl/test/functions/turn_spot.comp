#version 460
#extension GL_GOOGLE_include_directive : require
#include "../turning_kernel.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    float t = take_float();
    vec2 spot = turn_spot(b, t);
    give(spot.x);
    give(spot.y);
}
