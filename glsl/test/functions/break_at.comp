#version 460
#extension GL_GOOGLE_include_directive : require
#include "../turning_kernel.glsl"

void run() {
    Turning turning = take_turning();
    float turned_share = take_float();
    float share = take_float();
    give(break_at(turning, turned_share, share));
}
