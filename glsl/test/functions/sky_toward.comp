#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/sky.glsl"

void run() {
    vec4 sky = take_vec4();
    give(sky_toward(sky, take_vec3()));
}
