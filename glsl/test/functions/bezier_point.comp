#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/curve.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    float t = take_float();
    CurvePoint c = bezier_point(b, t);
    give(c.position);
    give(c.derivative);
    give(c.second_derivative);
}
