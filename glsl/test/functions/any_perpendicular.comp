#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/frame.glsl"

void run() {
    vec3 v = take_vec3();
    give(any_perpendicular(v));
}
