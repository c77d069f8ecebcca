#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/curve.glsl"

void run() {
    uint basis = take_uint();
    vec3 p[4];
    take_piece(p);
    bezier_from_basis(p, basis);
    for (int k = 0; k < 4; ++k) {
        give(p[k]);
    }
}
