#version 460
// Culls a piece of yarn or decides how finely its core fibers, one to a ply, are cut.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"
#include "../yarn/core.glsl"
#include "level.glsl"
#include "shadow_limits.glsl"

layout(vertices = 1) out;

layout(location = 0) in uint segment_index[];
layout(location = 0) patch out uint patch_segment;
layout(location = 1) patch out uint patch_pieces;

void main() {
    Segment segment = segment_at(segment_index[0]);
    vec3 b[4];
    fetch_bezier(segment.first_point, b);
    bool culled = CULLING && outside_frustum(b, yarn.reach + yarn.fiber_radius, frame.frustum_world);
    float pixel_mm = frame.pixel_tangent * nearest_depth(b, depth_axis(), yarn.reach, frame.near_mm);
    // The core is thickest where the piece is farthest away.
    float extent_mm = length(b[1] - b[0]) + length(b[2] - b[1]) + length(b[3] - b[2]) + 2.0 * yarn.reach;
    bool empty = core_thickness(detail_at(pixel_mm + frame.pixel_tangent * extent_mm).level, yarn) <= 0.0;

    // Besides the ply's own turn, the texture follows the turn of its ellipse as seen, which is uneven.
    float uneven_mm = yarn.ply_radius * abs(yarn.ellipse_long / yarn.ellipse_short - 1.0);
    uint needed = subdivisions(b, segment.ply_turns_delta, 0.0, yarn.ply_offset, uneven_mm,
                               frame.tolerance_px * pixel_mm, PIECES_PER_TURN, yarn.max_subdivisions + 1u);
    uint pieces = min(needed, yarn.max_subdivisions);
    patch_segment = segment_index[0];
    patch_pieces = pieces;
    bool drawn = !culled && !empty;
    gl_TessLevelOuter[0] = drawn ? float(yarn.ply_count) : 0.0;
    gl_TessLevelOuter[1] = drawn ? float(pieces) : 0.0;
    if (STATISTICS) {
        // The regular fibers' pass counts the same pieces.
        if (!REGULAR_FIBERS) {
            count_patch(culled);
            count_coarse(drawn && needed > yarn.max_subdivisions);
            if (!culled) {
                count_shadow_limits(segment.first_point);
            }
        }
        count_segments(drawn ? yarn.ply_count * pieces : 0);
    }
}
