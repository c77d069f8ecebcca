#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/self_shadow.glsl"

layout(set = 0, binding = 3) uniform sampler3D table;

void run() {
    vec3 place = take_vec3();
    give(self_shadow_depth(table, place));
}
