#version 460
#extension GL_GOOGLE_include_directive : require
#include "yarn.glsl"
#include "../lib/strip.glsl"

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

layout(location = 0) in vec3 position_world[];
layout(location = 1) in vec3 tangent_world[];

layout(location = 0) centroid out vec3 fragment_position;
layout(location = 1) centroid out vec3 fragment_tangent;
layout(location = 2) centroid out vec3 fragment_side;
layout(location = 3) noperspective out float fragment_across;

void main() {
    for (int end = 0; end < 2; ++end) {
        vec3 to_eye = direction_or(frame.eye_world.xyz - position_world[end], vec3(0.0, 0.0, 1.0));
        vec3 side = strip_side(tangent_world[end], to_eye);
        for (int edge = -1; edge <= 1; edge += 2) {
            vec3 corner = position_world[end] + float(edge) * yarn.fiber_radius * side;
            fragment_position = corner;
            fragment_tangent = tangent_world[end];
            fragment_side = side;
            fragment_across = float(edge);
            gl_Position = frame.clip_from_world * vec4(corner, 1.0);
            EmitVertex();
        }
    }
    EndPrimitive();
}
