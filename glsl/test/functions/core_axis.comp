#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/core.glsl"

void run() {
    vec3 ply_normal = take_vec3();
    vec3 ply_binormal = take_vec3();
    float ply_turns_per_mm = take_float();
    float ply_offset = take_float();
    give(core_axis(ply_normal, ply_binormal, ply_turns_per_mm, ply_offset));
}
