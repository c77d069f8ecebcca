#version 460
#extension GL_GOOGLE_include_directive : require
#include "../turning_kernel.glsl"

void run() {
    Turning turning = take_turning();
    float turned_share = take_float();
    float t = take_float();
    give(share_before(turning, turned_share, t));
}
