#version 460
#extension GL_GOOGLE_include_directive : require
#include "../turning_kernel.glsl"

void run() {
    Turning turning = take_turning();
    vec3 b[4];
    take_piece(b);
    uint even = take_uint();
    uint calm = take_uint();
    float reach = take_float();
    float tolerance = take_float();
    uint largest = take_uint();
    Cut cut = uneven_cut(turning, b, even, calm, reach, tolerance, largest);
    give(float(cut.pieces));
    give(cut.share);
}
