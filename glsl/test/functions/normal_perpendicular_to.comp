#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/frame.glsl"

void run() {
    vec3 tangent = take_vec3();
    vec3 normal = take_vec3();
    give(normal_perpendicular_to(tangent, normal));
}
