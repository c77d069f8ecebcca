#version 460
// Places one vertex of one fiber.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"

layout(isolines, equal_spacing) in;

layout(location = 0) patch in uint patch_segment;
layout(location = 1) patch in uint patch_first_fiber;
layout(location = 2) patch in uint patch_fibers;

layout(location = 0) out vec3 position_world;
layout(location = 1) out vec3 tangent_world;
layout(location = 2) out float center_distance;
layout(location = 3) out uint fiber_index;

void main() {
    // TessCoord is 16.16 fixed point on some drivers: round, never floor.
    fiber_index = patch_first_fiber + uint(gl_TessCoord.y * float(patch_fibers) + 0.5);
    FiberPoint f = fetch_fiber_point(patch_segment, fiber_index, gl_TessCoord.x);
    position_world = f.position;
    tangent_world = f.tangent;
    center_distance = f.center_distance;
}
