#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/motion.glsl"

void run() {
    vec3 v = take_vec3();
    vec3 normal = take_vec3();
    vec3 binormal = take_vec3();
    vec3 normal_then = take_vec3();
    vec3 binormal_then = take_vec3();
    give(carried_vector(v, normal, binormal, normal_then, binormal_then));
}
