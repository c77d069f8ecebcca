#version 460
#extension GL_GOOGLE_include_directive : require
#include "yarn.glsl"

layout(isolines, equal_spacing) in;

layout(location = 0) patch in uint patch_piece;
layout(location = 1) patch in uint patch_first_fiber;
layout(location = 2) patch in uint patch_fibers;
layout(location = 3) patch in uint patch_steps;

layout(location = 0) out vec3 position_world;
layout(location = 1) out vec3 tangent_world;

void main() {
    PieceTurns piece = pieces[patch_piece];
    Fiber fiber = fibers[patch_first_fiber + uint(gl_TessCoord.y * float(patch_fibers) + 0.5)];
    float t = floor(gl_TessCoord.x * float(patch_steps) + 0.5) / float(patch_steps);
    vec3 b[4];
    bezier_of(piece, b);
    YarnPoint at = yarn_point(b, unit_from_octahedral(control_points[piece.first_point + 1u].normal_octahedral),
                              unit_from_octahedral(control_points[piece.first_point + 2u].normal_octahedral), t);
    Twist twist;
    twist.ply = TWO_PI * fract(piece.ply + t * piece.ply_delta);
    twist.fiber = TWO_PI * fract(piece.fiber + t * piece.fiber_delta);
    twist.migration = TWO_PI * fract(piece.migration + t * piece.migration_delta);
    twist.ply_rate = TWO_PI * piece.ply_delta;
    twist.fiber_rate = TWO_PI * piece.fiber_delta;
    twist.migration_rate = TWO_PI * piece.migration_delta;
    FiberPoint f = fiber_point(at, twist, yarn, fiber, migration_shape(fiber, twist.migration, twist.migration_rate, yarn));
    position_world = f.position;
    tangent_world = f.tangent;
}
