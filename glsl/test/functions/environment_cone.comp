#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/environment.glsl"

void run() {
    vec4 environment[9];
    for (int i = 0; i < 9; ++i) {
        environment[i] = vec4(take_vec3(), 0.0);
    }
    vec3 tangent = take_vec3();
    float sin_theta = take_float();
    float variance = take_float();
    give(environment_cone(environment, tangent, sin_theta, variance));
}
