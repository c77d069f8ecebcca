#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../bsdf/simple.glsl"

void run() {
    vec4 normals = take_vec4();
    vec3 side = take_vec3();
    vec3 toward = take_vec3();
    vec3 to_light = take_vec3();
    give(filtered_cosine(normals, side, toward, to_light));
}
