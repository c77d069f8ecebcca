#version 460
#extension GL_GOOGLE_include_directive : require
#include "../test/kernel.glsl"
#include "../lib/curve.glsl"

void run() {
    uint basis = take_uint();
    vec3 p[4];
    take_piece(p);
    bezier_from_basis(p, basis);
    CurvePoint c = bezier_point(p, take_float());
    give(c.position);
    give(c.derivative);
}
