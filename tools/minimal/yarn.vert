#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/constants.glsl"

layout(location = 0) out uint piece_index;
layout(location = 1) out uint first_fiber;

void main() {
    piece_index = uint(gl_VertexIndex);
    first_fiber = uint(gl_InstanceIndex) * FIBERS_PER_PATCH;
}
