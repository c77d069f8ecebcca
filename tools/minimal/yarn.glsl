// All that the hand-cut pipeline reads; twin: `Look` and `Turns` in tools/minimal/main.rs.
#ifndef MINIMAL_YARN
#define MINIMAL_YARN

#include "../yarn/fiber.glsl"
#include "../yarn/level.glsl"

struct PieceTurns {
    float ply;
    float fiber;
    float migration;
    float ply_delta;
    float fiber_delta;
    float migration_delta;
    uint first_point;
    uint padding;
};

layout(std140, set = 0, binding = 0) uniform FrameBlock { Frame frame; };
layout(std140, set = 0, binding = 5) uniform LookBlock {
    vec4 to_light;
    vec4 irradiance;
    vec4 diffuse;
    vec4 specular;       // a: beta
    float reach;
} look;
layout(std430, set = 0, binding = 1) readonly buffer PointBlock { ControlPoint control_points[]; };
layout(std430, set = 0, binding = 2) readonly buffer PieceBlock { PieceTurns pieces[]; };
layout(std430, set = 0, binding = 3) readonly buffer FiberBlock { Fiber fibers[]; };
layout(std430, set = 0, binding = 4) readonly buffer YarnBlock { Yarn yarn; };

void bezier_of(PieceTurns piece, out vec3 b[4]) {
    for (uint k = 0; k < 4; ++k) {
        b[k] = control_points[piece.first_point + k].position;
    }
    bezier_from_basis(b, BASIS_CATMULL_ROM);
}

vec4 depth_axis() {
    return vec4(frame.clip_from_world[0].w, frame.clip_from_world[1].w, frame.clip_from_world[2].w,
                frame.clip_from_world[3].w);
}

#endif
