#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/shadow_map.glsl"

void run() {
    uint tap = take_uint();
    vec2 place = shadow_tap(tap, take_float());
    give(place.x);
    give(place.y);
}
