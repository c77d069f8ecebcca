#version 460
// Places one vertex of a core fiber: the ply's centre, and how the ply is seen there.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"
#include "../yarn/core.glsl"
#include "../lib/motion.glsl"
#include "level.glsl"
#include "shown.glsl"

layout(isolines, equal_spacing) in;

layout(location = 0) patch in uint patch_segment;
layout(location = 1) patch in uint patch_pieces;

layout(location = 0) out vec3 position_world;
layout(location = 1) out vec3 tangent_world;
layout(location = 2) out vec3 side_world;
layout(location = 3) out vec4 section;       // width, depth, shear (mm), turns as read
layout(location = 4) out vec4 place;         // from_yarn along side and toward, level, turns as expected
layout(location = 5) out uvec3 core;         // ply, what a debug view shows, piece of yarn
layout(location = 6) out vec3 toward_world;
layout(location = 9) out vec3 position_before;  // in the frame before, with what side and toward have turned to there
layout(location = 10) out vec3 side_before;
layout(location = 11) out vec3 toward_before;
layout(location = 12) out vec3 position_after;  // in the frame after
layout(location = 13) out vec3 side_after;
layout(location = 14) out vec3 toward_after;
layout(location = 15) out uint curve;

// A fiber at the ply's centre.
FiberPoint center_of(Segment segment, Span span, uint ply, float t) {
    return fetch_fiber_point(segment, span, Fiber(0.0, 0.0, 0.0, ply), t, FiberShape(0.0, 0.0, 0.0, 0.0, 1.0));
}

void place_in_neighbours(Segment segment, FiberPoint center, CoreSection seen, uint ply, float t) {
    vec3 normal = center.ply_normal;
    vec3 binormal = center.ply_binormal;
    FiberPoint before = center_of(segment, fetch_neighbour_span(segment.first_point, false), ply, t);
    position_before = before.position;
    side_before = carried_vector(seen.side, normal, binormal, before.ply_normal, before.ply_binormal);
    toward_before = carried_vector(seen.toward, normal, binormal, before.ply_normal, before.ply_binormal);
    FiberPoint after = center_of(segment, fetch_neighbour_span(segment.first_point, true), ply, t);
    position_after = after.position;
    side_after = carried_vector(seen.side, normal, binormal, after.ply_normal, after.ply_binormal);
    toward_after = carried_vector(seen.toward, normal, binormal, after.ply_normal, after.ply_binormal);
}

void main() {
    uint ply = uint(gl_TessCoord.y * float(yarn.ply_count) + 0.5);
    float t = floor(gl_TessCoord.x * float(patch_pieces) + 0.5) / float(patch_pieces);
    Segment segment = segment_at(patch_segment);
    FiberPoint center = center_of(segment, fetch_span(segment.first_point), ply, t);
    vec3 to_eye = direction_or(frame.eye_world.xyz - center.position, vec3(0.0, 0.0, 1.0));
    float turns_per_mm = segment.length_mm > 0.0 ? segment.ply_turns_delta / segment.length_mm : 0.0;
    vec3 axis = core_axis(center.ply_normal, center.ply_binormal, turns_per_mm, yarn.ply_offset);
    CoreSection seen = core_section(center.ply_normal, center.ply_binormal, axis, to_eye, yarn.ellipse_short,
                                    yarn.ellipse_long);
    position_world = center.position;
    gl_Position = frame.clip_from_world * vec4(center.position, 1.0);
    tangent_world = center.tangent;
    side_world = seen.side;
    toward_world = seen.toward;
    section = vec4(seen.width, seen.depth, seen.shear, core_turns(twist_at(segment, t).fiber, seen.phase));
    float expected = t * (segment.fiber_turns_delta + segment.ply_turns_delta);
    place = vec4(seen.from_yarn, detail_at(pixel_mm_at(center.position)).level, expected);
    core = uvec3(ply, uint(shown(segment, center, KIND_CORE, t)), patch_segment);
    if (MOTION_LAYER && NEIGHBOURS) {
        place_in_neighbours(segment, center, seen, ply, t);
    }
    if (ID_LAYER) {
        curve = segment.curve;
    }
}
