#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/fiber.glsl"

void run() {
    Segment segment;
    segment.ply_turns = take_float();
    segment.fiber_turns = take_float();
    segment.migration_turns = take_float();
    segment.ply_turns_delta = take_float();
    segment.fiber_turns_delta = take_float();
    segment.migration_turns_delta = take_float();
    float t = take_float();
    Twist twist = twist_at(segment, t);
    give(vec3(cos(twist.ply), sin(twist.ply), twist.ply_rate));
    give(vec3(cos(twist.fiber), sin(twist.fiber), twist.fiber_rate));
    give(vec3(cos(twist.migration), sin(twist.migration), twist.migration_rate));
}
