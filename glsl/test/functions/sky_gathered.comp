#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/sky.glsl"

void run() {
    vec3 toward = take_vec3();
    give(sky_gathered(toward, take_vec3()));
}
