#version 460
#extension GL_GOOGLE_include_directive : require
#include "../test/kernel.glsl"
#include "../shading/chord_shadow.glsl"
#include "../shading/self_shadow.glsl"
#include "../test/plies.glsl"

layout(set = 0, binding = 2) uniform sampler3D table;

void run() {
    float x = take_float();
    float y = take_float();
    float light_x = take_float();
    float light_y = take_float();
    bool by_chords = take_uint() != 0u;
    Plies plies = take_plies();
    vec2 position = vec2(x, y);
    vec2 light = vec2(light_x, light_y);
    if (by_chords) {
        give(chord_depth(table, position, light, plies));
    } else {
        uvec2 size = uvec2(textureSize(table, 0).xz);
        give(self_shadow_depth(table, self_shadow_place(position, light, plies.count, size)));
    }
}
