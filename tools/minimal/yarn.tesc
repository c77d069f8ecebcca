#version 460
#extension GL_GOOGLE_include_directive : require
#include "yarn.glsl"

layout(vertices = 1) out;

layout(location = 0) in uint piece_index[];
layout(location = 1) in uint first_fiber[];
layout(location = 0) patch out uint patch_piece;
layout(location = 1) patch out uint patch_first_fiber;
layout(location = 2) patch out uint patch_fibers;
layout(location = 3) patch out uint patch_steps;

void main() {
    PieceTurns piece = pieces[piece_index[0]];
    vec3 b[4];
    bezier_of(piece, b);
    bool culled = outside_frustum(b, look.reach + yarn.fiber_radius, frame.frustum_world);
    float pixel_mm = frame.pixel_tangent * nearest_depth(b, depth_axis(), look.reach, frame.near_mm);
    uint steps = subdivisions(b, piece.ply_delta, piece.fiber_delta, yarn.ply_offset, yarn.ellipse_long,
                              frame.tolerance_px * pixel_mm, 6.0, yarn.max_subdivisions);
    patch_piece = piece_index[0];
    patch_first_fiber = first_fiber[0];
    patch_fibers = min(FIBERS_PER_PATCH, yarn.fiber_count - first_fiber[0]);
    patch_steps = steps;
    gl_TessLevelOuter[0] = culled ? 0.0 : float(patch_fibers);
    gl_TessLevelOuter[1] = culled ? 0.0 : float(steps);
}
