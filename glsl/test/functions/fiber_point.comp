#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/fiber.glsl"

void run() {
    YarnPoint yarn_at;
    yarn_at.center = take_vec3();
    yarn_at.tangent = take_vec3();
    yarn_at.normal = take_vec3();
    yarn_at.speed = take_float();
    yarn_at.bend = take_vec3();
    Twist twist;
    twist.ply = take_float();
    twist.fiber = take_float();
    twist.ply_rate = take_float();
    twist.fiber_rate = take_float();
    Yarn yarn;
    yarn.ply_count = take_uint();
    yarn.ply_offset = take_float();
    yarn.ellipse_short = take_float();
    yarn.ellipse_long = take_float();
    yarn.beyond_short = take_float();
    yarn.beyond_long = take_float();
    yarn.migration_max = take_float();
    Fiber fiber;
    fiber.angle = take_float();
    fiber.ply = take_uint();
    FiberShape shape;
    shape.radius = take_float();
    shape.radius_rate = take_float();
    shape.angle = take_float();
    shape.angle_rate = take_float();
    shape.width = take_float();
    FiberPoint f = fiber_point(yarn_at, twist, yarn, fiber, shape);
    give(f.ply_center);
    give(f.ply_normal);
    give(f.ply_binormal);
    give(f.position);
    give(f.tangent);
    give(f.center_distance);
    give(f.width);
}
