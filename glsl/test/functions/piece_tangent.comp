#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/fiber.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    vec3 derivative = take_vec3();
    give(piece_tangent(b, derivative));
}
