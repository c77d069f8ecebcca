#version 460
// Culls a piece of yarn or decides how many fibers and subdivisions it gets.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"
#include "../yarn/level.glsl"

layout(vertices = 1) out;

layout(location = 0) in uint segment_index[];
layout(location = 1) in uint first_fiber[];
layout(location = 0) patch out uint patch_segment;
layout(location = 1) patch out uint patch_first_fiber;
layout(location = 2) patch out uint patch_fibers;
layout(location = 3) patch out uint patch_pieces;

void count(bool culled, uint fiber_segments) {
    if (first_fiber[0] == 0) {
        if (culled) {
            atomicAdd(statistics.patches_culled, 1);
        } else {
            atomicAdd(statistics.patches_drawn, 1);
        }
    }
    uint before = atomicAdd(statistics.fiber_segments_low, fiber_segments);
    if (before + fiber_segments < before) {
        atomicAdd(statistics.fiber_segments_high, 1);
    }
}

void main() {
    Segment segment = segments[segment_index[0]];
    vec3 b[4];
    fetch_bezier(segment, b);
    bool culled = CULLING && outside_frustum(b, yarn.reach + yarn.fiber_radius, frame.frustum_world);

    uint fiber_count = min(FIBERS_PER_PATCH, yarn.fiber_count - first_fiber[0]);
    float distance_mm = nearest_distance(b, frame.eye_world.xyz, yarn.reach, frame.near_mm);
    float fiber_reach = yarn.ellipse_long;
    if (FLYAWAYS) {
        // Loops and hairs turn about the ply farther out than its other fibers.
        float hair = yarn.hair_probability > 0.0 ? yarn.hair_start_mean + yarn.hair_gain_mean : 0.0;
        float loop = yarn.loop_probability > 0.0 ? yarn.loop_radius_mean : 0.0;
        fiber_reach *= max(1.0, max(hair, loop));
    }
    uint pieces = subdivisions(b, segment.ply_turns_delta, segment.fiber_turns_delta, yarn.ply_offset,
                               fiber_reach, frame.tolerance_per_mm * distance_mm, yarn.max_subdivisions);
    if (FLYAWAYS) {
        pieces = period_pieces(pieces, period_rate(segment, yarn), yarn.max_subdivisions);
    }
    patch_segment = segment_index[0];
    patch_first_fiber = first_fiber[0];
    // The evaluation stage sees levels before clamping, so it gets the counts themselves.
    patch_fibers = fiber_count;
    patch_pieces = pieces;
    gl_TessLevelOuter[0] = culled ? 0.0 : float(fiber_count);
    gl_TessLevelOuter[1] = culled ? 0.0 : float(pieces);
    if (STATISTICS) {
        count(culled, culled ? 0 : fiber_count * pieces);
    }
}
