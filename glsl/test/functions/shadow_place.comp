#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/shadow_map.glsl"

void run() {
    ShadowView view;
    for (int column = 0; column < 4; ++column) {
        view.clip_from_world[column] = take_vec4();
    }
    view.depth_axis = take_vec4();
    vec3 position = take_vec3();
    float resolution = take_float();
    give(shadow_place(view, position, resolution));
}
