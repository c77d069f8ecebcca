#version 460
// One vertex per patch: passes the piece's index on, since gl_PrimitiveID in later stages counts from
// the draw's first vertex on some drivers and from zero on others.
#extension GL_GOOGLE_include_directive : require
#include "../shared/constants.glsl"

layout(location = 0) out uint segment_index;
layout(location = 1) out uint first_fiber;

void main() {
    segment_index = uint(gl_VertexIndex);
    first_fiber = uint(gl_InstanceIndex) * FIBERS_PER_PATCH;
}
