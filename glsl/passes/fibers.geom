#version 460
// Widens a line of fiber into a camera-facing strip, by its true width in world space.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "moved.glsl"
#include "../lib/strip.glsl"
#include "../yarn/breaks.glsl"
#include "varying.glsl"

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

layout(location = 0) in vec3 position_world[];
layout(location = 1) in vec4 tangent_world[];
layout(location = 2) in vec3 section_place[];
layout(location = 3) in uint fiber_index[];
layout(location = 4) in ivec4 joining[];
layout(location = 5) in vec3 ply_normal[];
layout(location = 6) in vec3 ply_binormal[];
layout(location = 7) in uint piece[];
layout(location = 8) in vec3 vertex_radiance[];
layout(location = 9) in vec3 position_before[];
layout(location = 10) in vec3 side_before[];
layout(location = 11) in vec3 position_after[];
layout(location = 12) in vec3 side_after[];
layout(location = 13) in uint curve[];

// Centroid: a fiber is often thinner than a pixel, whose centre then lies outside its triangles.
layout(location = 0) centroid out vec3 fragment_position;
layout(location = 1) centroid out vec3 fragment_tangent;
layout(location = 2) centroid out vec3 fragment_side;
layout(location = 3) centroid out vec3 fragment_place;     // section_place as shares of outer_radius
layout(location = 4) flat out uvec3 fragment_fiber;  // index, what a debug view shows, piece of yarn
layout(location = 5) noperspective out float fragment_across; // -1 to 1
layout(location = 6) centroid out vec3 fragment_normal;       // of the ply, and its binormal
layout(location = 7) centroid out vec3 fragment_binormal;
layout(location = 8) centroid out vec3 fragment_radiance;     // where it is shaded at its vertices

// Of the layers. Differences of what is seen, not places: those of thin triangles have no digits to lose.
layout(location = 9) out vec4 fragment_motion;  // to the frame before, and to the frame after: passes/moved.glsl
layout(location = 10) flat out uint fragment_curve;

// Which end of the line comes first along the yarn is the driver's choice.
int first_end() {
    return joining[0].w < joining[1].w ? 0 : 1;
}

void main() {
    if (FLYAWAYS) {
        int first = first_end();
        if (is_broken(joining[first].y, joining[1 - first].x)) {
            return;
        }
    }
    if (CORE_FIBERS && max(tangent_world[0].w, tangent_world[1].w) <= 0.0) {
        return;
    }
    for (int end = 0; end < 2; ++end) {
        vec3 to_eye = direction_or(frame.eye_world.xyz - position_world[end], vec3(0.0, 0.0, 1.0));
        vec3 side = strip_side(tangent_world[end].xyz, to_eye);
        for (int edge = -1; edge <= 1; edge += 2) {
            float across_mm = float(edge) * tangent_world[end].w * yarn.fiber_radius;
            vec3 corner = position_world[end] + across_mm * side;
            fragment_position = corner;
            fragment_tangent = tangent_world[end].xyz;
            fragment_side = side;
            fragment_across = float(edge);
            if (READS_PLACE) {
                fragment_place = section_place[end] / yarn.outer_radius;
            }
            if (READS_PLY_FRAME) {
                fragment_normal = ply_normal[end];
                fragment_binormal = ply_binormal[end];
            }
            if (READS_FIBER) {
                fragment_fiber = uvec3(fiber_index[end], uint(joining[first_end()].z), piece[end]);
            }
            if (AT_VERTICES) {
                fragment_radiance = vertex_radiance[end];
            }
            gl_Position = frame.clip_from_world * vec4(corner, 1.0);
            if (MOTION_LAYER && NEIGHBOURS) {
                vec3 before = position_before[end] + across_mm * side_before[end];
                vec3 after = position_after[end] + across_mm * side_after[end];
                fragment_motion = motion_of_corner(gl_Position, before, after);
            }
            if (ID_LAYER) {
                fragment_curve = curve[end];
            }
            EmitVertex();
        }
    }
    EndPrimitive();
}
