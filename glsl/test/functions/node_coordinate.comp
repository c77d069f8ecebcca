#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/table.glsl"

void run() {
    float share = take_float();
    uint texels = take_uint();
    give(node_coordinate(share, texels));
}
