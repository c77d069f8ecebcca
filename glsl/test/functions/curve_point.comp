#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/curve.glsl"

void run() {
    uint basis = take_uint();
    vec3 p[4];
    take_piece(p);
    float t = take_float();
    CurvePoint c = curve_point(p, basis, t);
    give(c.position);
    give(c.derivative);
    give(c.second_derivative);
}
