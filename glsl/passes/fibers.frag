#version 460
// Shades a single fiber.
#extension GL_GOOGLE_include_directive : require
#include "covered.glsl"
#include "surface.glsl"
#include "../lib/frame.glsl"
#include "varying.glsl"

layout(location = 0) centroid in vec3 fragment_position;
layout(location = 1) centroid in vec3 fragment_tangent;
layout(location = 2) centroid in vec3 fragment_side;
layout(location = 3) centroid in vec3 fragment_place;
layout(location = 4) flat in uvec3 fragment_fiber;  // index, what a debug view shows, piece of yarn
layout(location = 5) noperspective in float fragment_across; // -1 to 1 inside
layout(location = 6) centroid in vec3 fragment_normal;
layout(location = 7) centroid in vec3 fragment_binormal;
layout(location = 8) centroid in vec3 fragment_radiance;

layout(location = 0) out vec4 radiance;

// Straight pieces cut a fiber's way around its ply short; its distance from the ply's centre stays true.
vec2 round_place() {
    vec2 ply = vec2(yarn.ply_offset / yarn.outer_radius, 0.0);
    vec2 from_ply = fragment_place.xy - ply;
    return ply + from_ply * (fragment_place.z / max(length(from_ply), 1e-6));
}

void main() {
    if (AT_VERTICES) {
        radiance = vec4(fragment_radiance, 1.0);
        return;
    }
    Strand strand;
    strand.position = fragment_position;
    strand.tangent = direction_or(fragment_tangent, vec3(1.0, 0.0, 0.0));
    strand.side = normal_perpendicular_to(strand.tangent, fragment_side);
    strand.toward = cross(strand.side, strand.tangent);
    strand.near_place = vec2(0.0);
    if (READS_PLACE) {
        strand.near_place = round_place();
    }
    strand.far_place = strand.near_place;
    strand.far_share = 0.0;
    strand.ply_normal = vec3(0.0);
    strand.ply_binormal = vec3(0.0);
    if (READS_PLY_FRAME) {
        // Between the ends of a straight piece they are neither of length 1 nor quite perpendicular.
        vec3 axis = direction_or(cross(fragment_normal, fragment_binormal), vec3(1.0, 0.0, 0.0));
        strand.ply_normal = normal_perpendicular_to(axis, fragment_normal);
        strand.ply_binormal = cross(axis, strand.ply_normal);
    }
    strand.spread = vec3(0.0);
    strand.normals = fiber_normals(covered_values(fragment_across, gl_SampleMaskIn[0]));
    strand.piece = 0u;
    strand.ply = 0u;
    strand.shown = 0u;
    if (READS_FIBER) {
        strand.piece = fragment_fiber.z;
        strand.ply = DEBUG_VIEW == VIEW_PLY ? fibers[fragment_fiber.x].ply : 0u;
        strand.shown = fragment_fiber.y;
    }
    radiance = strand_color(strand);
}
