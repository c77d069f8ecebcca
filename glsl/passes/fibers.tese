#version 460
// Places one vertex of one fiber.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"

layout(isolines, equal_spacing) in;

layout(location = 0) patch in uint patch_segment;
layout(location = 1) patch in uint patch_first_fiber;
layout(location = 2) patch in uint patch_fibers;
layout(location = 3) patch in uint patch_pieces;

layout(location = 0) out vec3 position_world;
layout(location = 1) out vec4 tangent_world;   // a: share of the fiber's width
layout(location = 2) out float center_distance;
layout(location = 3) out uint fiber_index;
layout(location = 4) out ivec4 joining;        // entry, exit, kind, place along the piece

void main() {
    // TessCoord is 16.16 fixed point on some drivers: round, never floor.
    fiber_index = patch_first_fiber + uint(gl_TessCoord.y * float(patch_fibers) + 0.5);
    float place = floor(gl_TessCoord.x * float(patch_pieces) + 0.5);
    float t = place / float(patch_pieces);
    FiberPoint f;
    if (FLYAWAYS) {
        StrandVertex vertex;
        f = fetch_fiber_vertex(patch_segment, fiber_index, t, patch_pieces, vertex);
        joining = ivec4(vertex.entry, vertex.exit, int(vertex.period.kind), int(place));
    } else {
        Period period;
        f = fetch_fiber_at(patch_segment, fiber_index, t, period);
        joining = ivec4(0, 0, 0, int(place));
    }
    position_world = f.position;
    tangent_world = vec4(f.tangent, f.width);
    center_distance = f.center_distance;
}
