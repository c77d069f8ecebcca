#version 460
#extension GL_GOOGLE_include_directive : require
#include "../turning_kernel.glsl"

void run() {
    vec3 b[4];
    take_piece(b);
    give(turning_of(b).swift);
}
