#version 460
#extension GL_GOOGLE_include_directive : require
#include "../test/kernel.glsl"
#include "../yarn/fiber.glsl"

// As `fetch_fiber_at` of glsl/yarn/fetch.glsl places a fiber that only migrates.
void run() {
    uint basis = take_uint();
    vec3 b[4];
    take_piece(b);
    bezier_from_basis(b, basis);
    vec3 normal_start = unit_from_octahedral(take_uint());
    vec3 normal_end = unit_from_octahedral(take_uint());
    float t = take_float();
    Segment segment;
    segment.ply_turns = take_float();
    segment.ply_turns_delta = take_float();
    segment.fiber_turns = take_float();
    segment.fiber_turns_delta = take_float();
    segment.migration_turns = take_float();
    segment.migration_turns_delta = take_float();
    Yarn yarn;
    yarn.ply_count = take_uint();
    yarn.ply_offset = take_float();
    yarn.ellipse_short = take_float();
    yarn.ellipse_long = take_float();
    yarn.migration_min = take_float();
    yarn.migration_max = take_float();
    // A fiber that only migrates never lies beyond its ply.
    yarn.beyond_short = 0.0;
    yarn.beyond_long = 0.0;
    Fiber fiber;
    fiber.radius = take_float();
    fiber.angle = take_float();
    fiber.migration_phase = take_float();
    fiber.ply = take_uint();
    Twist twist = twist_at(segment, t);
    FiberShape shape = migration_shape(fiber, twist.migration, twist.migration_rate, yarn);
    FiberPoint f = fiber_point(yarn_point(b, normal_start, normal_end, t), twist, yarn, fiber, shape);
    give(f.yarn_center);
    give(f.ply_center);
    give(f.position);
}
