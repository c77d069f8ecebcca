#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/level.glsl"

void run() {
    vec3 a = take_vec3();
    vec3 b = take_vec3();
    give(turning_angle(a, b));
}
