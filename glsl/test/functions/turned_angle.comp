#version 460
#extension GL_GOOGLE_include_directive : require
#include "../turning_kernel.glsl"

void run() {
    Turning turning = take_turning();
    float t = take_float();
    give(turned_angle(turning, t));
}
