#version 460
// Widens a line of core fiber into a strip that is arched toward the viewer, as its surface is.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "moved.glsl"
#include "../yarn/core.glsl"

layout(lines) in;
layout(triangle_strip, max_vertices = 10) out;

layout(location = 0) in vec3 position_world[];
layout(location = 1) in vec3 tangent_world[];
layout(location = 2) in vec3 side_world[];
layout(location = 3) in vec4 section[];
layout(location = 4) in vec4 place[];
layout(location = 5) in uvec3 core[];
layout(location = 6) in vec3 toward_world[];
layout(location = 9) in vec3 position_before[];
layout(location = 10) in vec3 side_before[];
layout(location = 11) in vec3 toward_before[];
layout(location = 12) in vec3 position_after[];
layout(location = 13) in vec3 side_after[];
layout(location = 14) in vec3 toward_after[];
layout(location = 15) in uint curve[];

layout(location = 0) centroid out vec3 fragment_position;
layout(location = 1) centroid out vec3 fragment_tangent;
layout(location = 2) centroid out vec3 fragment_side;
layout(location = 3) centroid out vec4 fragment_section;  // width, depth, shear (mm), turns
layout(location = 4) centroid out vec4 fragment_rates;    // of the first three and of the turn (radians), per mm
layout(location = 5) centroid out vec3 fragment_place;    // from_yarn along side and toward, level
layout(location = 6) flat out uvec3 fragment_core;        // ply, what a debug view shows, piece of yarn
layout(location = 7) noperspective out float fragment_across; // as a share of the ellipse
layout(location = 9) out vec4 fragment_motion;  // of the layers, as passes/fibers.geom has them
layout(location = 10) flat out uint fragment_curve;

// Across the strip, as shares of its half-width; the arch's height is sqrt(1 - across^2). A ply that is small in
// the picture gets half as many.
const float COLUMNS[5] = float[5](-1.0, -0.70710678, 0.0, 0.70710678, 1.0);
const float SMALL_PX = 8.0;

void emit(int end, float across, vec4 seen, vec4 rates) {
    float thickness = core_thickness(place[end].z, yarn);
    float v = across * thickness;
    float height = yarn.core_height * thickness * sqrt(max(0.0, 1.0 - across * across));
    vec2 offset_mm = vec2(seen.x * v, seen.y * height + seen.z * v);  // along side and toward
    fragment_position = position_world[end] + offset_mm.x * side_world[end] + offset_mm.y * toward_world[end];
    fragment_tangent = tangent_world[end];
    fragment_side = side_world[end];
    fragment_across = v;
    fragment_section = seen;
    fragment_rates = rates;
    fragment_place = place[end].xyz;
    fragment_core = core[end];
    gl_Position = frame.clip_from_world * vec4(fragment_position, 1.0);
    if (MOTION_LAYER && NEIGHBOURS) {
        vec3 before = position_before[end] + offset_mm.x * side_before[end] + offset_mm.y * toward_before[end];
        vec3 after = position_after[end] + offset_mm.x * side_after[end] + offset_mm.y * toward_after[end];
        fragment_motion = motion_of_corner(gl_Position, before, after);
    }
    if (ID_LAYER) {
        fragment_curve = curve[end];
    }
    EmitVertex();
}

void main() {
    // Which end of the line comes first along the yarn is the driver's choice: the length has the sign of the
    // differences, so that rates do not depend on it.
    float length_mm = dot(position_world[1] - position_world[0], tangent_world[0] + tangent_world[1]) * 0.5;
    float per_mm = abs(length_mm) > 1e-9 ? 1.0 / length_mm : 0.0;
    vec4 first = section[0];
    vec4 last = section[1];
    last.w = nearest_turn(last.w, first.w + place[1].w - place[0].w);
    vec4 rates = (last - first) * per_mm * vec4(1.0, 1.0, 1.0, TWO_PI);
    float width_px = 2.0 * first.x / (frame.pixel_tangent * max(gl_in[0].gl_Position.w, frame.near_mm));
    for (int column = 0; column < 5; column += width_px < SMALL_PX ? 2 : 1) {
        emit(0, COLUMNS[column], first, rates);
        emit(1, COLUMNS[column], last, rates);
    }
    EndPrimitive();
}
