#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/environment.glsl"

void run() {
    vec4 environment[9];
    for (int i = 0; i < 9; ++i) {
        environment[i] = vec4(take_vec3(), 0.0);
    }
    vec3 first = take_vec3();
    vec3 squares = take_vec3();
    vec3 products = take_vec3();
    float one = take_float();
    float two = take_float();
    give(environment_mean(environment, first, squares, products, vec2(one, two)));
}
