#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/environment.glsl"

void run() {
    vec4 environment[9];
    for (int i = 0; i < 9; ++i) {
        environment[i] = vec4(take_vec3(), 0.0);
    }
    vec4 normals = take_vec4();
    vec3 side = take_vec3();
    vec3 toward = take_vec3();
    give(environment_diffuse(environment, normals, side, toward));
}
