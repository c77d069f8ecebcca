#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/shadow_map.glsl"

void run() {
    give(float(shadow_face(take_vec3())));
}
