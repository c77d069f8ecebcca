#version 460
// Places one vertex of one fiber.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"
#include "../yarn/turning.glsl"
#include "../shared/debug_views.glsl"
#include "../lib/motion.glsl"
#include "level.glsl"
#include "shown.glsl"
#include "surface.glsl"
#include "varying.glsl"

layout(isolines, equal_spacing) in;

layout(location = 0) patch in uint patch_segment;
layout(location = 1) patch in uint patch_first_fiber;
layout(location = 2) patch in uint patch_fibers;
layout(location = 3) patch in uint patch_pieces;
layout(location = 4) patch in uvec2 patch_mask;
layout(location = 5) patch in vec3 patch_turns;         // of ply, fibers and migration: at the piece's start
layout(location = 6) patch in vec3 patch_turns_delta;
layout(location = 7) patch in vec2 patch_length;        // rest length before the piece, and its own
layout(location = 8) patch in uvec4 patch_curve;        // first point, curve, migration period, their number
layout(location = 9) patch in vec3 patch_bezier[4];
layout(location = 13) patch in vec3 patch_normals[2];
layout(location = 23) patch in uint patch_uneven;         // whether the pieces are cut by the table
layout(location = 24) patch in vec4 patch_breaks[TABLED_BREAKS / 4u];

layout(location = 0) out vec3 position_world;
layout(location = 1) out vec4 tangent_world;   // a: share of the fiber's width
layout(location = 2) out vec3 section_place;   // in the yarn's cross-section along its ply's normal and binormal; from the ply's centre; mm
layout(location = 3) out uint fiber_index;
layout(location = 4) out ivec4 joining;        // entry, exit, what a debug view shows, place along the piece
layout(location = 5) out vec3 ply_normal;
layout(location = 6) out vec3 ply_binormal;
layout(location = 7) out uint piece;
layout(location = 8) out vec3 vertex_radiance;
layout(location = 9) out vec3 position_before;  // in the frame before, with what the strip's side has turned to there
layout(location = 10) out vec3 side_before;
layout(location = 11) out vec3 position_after;  // in the frame after
layout(location = 12) out vec3 side_after;
layout(location = 13) out uint curve;

uint drawn_fiber;

Segment handed_segment() {
    return Segment(patch_curve.x, patch_curve.y, int(patch_curve.z), patch_curve.w, patch_turns.x, patch_turns.y,
                   patch_turns.z, patch_length.x, patch_turns_delta.x, patch_turns_delta.y, patch_turns_delta.z,
                   patch_length.y);
}

// Where the piece is cut for the `place`-th time.
float cut_at(float place) {
    float share = place / float(patch_pieces);
    return SWIFT_TURNS && patch_uneven != 0u ? tabled_break(patch_breaks, share) : share;
}

// Where the vertices beside that at t = cut_at(place) lie: outside of 0 to 1 where there is none.
vec2 cuts_beside(float place, float t) {
    float before = t - 1.0 / float(patch_pieces);
    float behind = t + 1.0 / float(patch_pieces);
    if (SWIFT_TURNS && patch_uneven != 0u) {
        before = place > 0.5 ? cut_at(place - 1.0) : -1.0;
        behind = place + 0.5 < float(patch_pieces) ? cut_at(place + 1.0) : 2.0;
    }
    return vec2(before, behind);
}

// Factor of the fiber's own width where level of detail is at work: `flies` where it stands out of the ply as a
// loop or a hair, for which no core stands.
float drawn_width(uint slot, vec3 position, bool flies) {
    Detail detail = detail_at(pixel_mm_at(position));
    float width = width_factor(slot_weight(slot, detail), detail.share);
    return flies ? width : width * rank_weight(drawn_fiber / yarn.ply_count, detail.kept);
}

// Radiance of a fiber whose width a pixel does not resolve.
vec3 radiance_at(FiberPoint f, vec2 place) {
    Strand strand;
    strand.position = f.position;
    strand.tangent = f.tangent;
    vec3 to_eye = direction_or(frame.eye_world.xyz - f.position, vec3(0.0, 0.0, 1.0));
    strand.side = strip_side(f.tangent, to_eye);
    strand.toward = cross(strand.side, strand.tangent);
    strand.near_place = place / yarn.outer_radius;
    strand.far_place = strand.near_place;
    strand.far_share = 0.0;
    strand.ply_normal = f.ply_normal;
    strand.ply_binormal = f.ply_binormal;
    strand.piece = patch_segment;
    strand.spread = vec3(0.0);
    strand.normals = STRIP_MEAN_NORMALS;
    return shade(strand, to_eye);
}

// The same place of the fiber where the frame before or after has it.
FiberPoint neighbour_point(Segment segment, float t, vec2 beside, bool after) {
    Span span = fetch_neighbour_span(segment.first_point, after);
    if (FLYAWAYS) {
        StrandVertex vertex;
        return fetch_fiber_vertex(segment, span, drawn_fiber, t, beside, vertex);
    }
    Period period;
    return fetch_fiber_at(segment, span, drawn_fiber, t, period);
}

void place_in_neighbours(Segment segment, FiberPoint f, float t, vec2 beside) {
    vec3 to_eye = direction_or(frame.eye_world.xyz - f.position, vec3(0.0, 0.0, 1.0));
    vec3 side = strip_side(f.tangent, to_eye);
    FiberPoint before = neighbour_point(segment, t, beside, false);
    FiberPoint after = neighbour_point(segment, t, beside, true);
    position_before = before.position;
    side_before = carried_vector(side, f.ply_normal, f.ply_binormal, before.ply_normal, before.ply_binormal);
    position_after = after.position;
    side_after = carried_vector(side, f.ply_normal, f.ply_binormal, after.ply_normal, after.ply_binormal);
}

void main() {
    // TessCoord is 16.16 fixed point on some drivers: round, never floor.
    uint line = uint(gl_TessCoord.y * float(patch_fibers) + 0.5);
    uint slot = patch_first_fiber + (CORE_FIBERS ? nth_set_bit(patch_mask, line) : line);
    drawn_fiber = CORE_FIBERS ? fiber_of_slot(slot, yarn) : slot;
    float place = floor(gl_TessCoord.x * float(patch_pieces) + 0.5);
    float t = cut_at(place);
    Segment segment = handed_segment();
    Span span = Span(patch_bezier, patch_normals[0], patch_normals[1]);
    FiberPoint f;
    bool flies = false;
    ivec4 joins;
    if (FLYAWAYS) {
        StrandVertex vertex;
        f = fetch_fiber_vertex(segment, span, drawn_fiber, t, cuts_beside(place, t), vertex);
        // Beyond its tip a hair's period goes on as a fiber that only migrates.
        bool migrates = vertex.period.kind == KIND_HAIR && !on_hair(vertex.period, vertex.x);
        uint kind = migrates ? KIND_MIGRATION : vertex.period.kind;
        flies = kind != KIND_MIGRATION && f.radius > flying_radius(fibers[drawn_fiber], yarn);
        joins = ivec4(vertex.entry, vertex.exit, shown(segment, f, kind, vertex.t), int(place));
    } else {
        Period period;
        f = fetch_fiber_at(segment, span, drawn_fiber, t, period);
        joins = ivec4(0, 0, shown(segment, f, period.kind, t), int(place));
    }
    if (FLYAWAYS) {
        joining = joins;
    }
    position_world = f.position;
    tangent_world = vec4(f.tangent, CORE_FIBERS ? f.width * drawn_width(slot, f.position, flies) : f.width);
    vec3 from_center = f.position - f.yarn_center;
    vec2 section = vec2(dot(from_center, f.ply_normal), dot(from_center, f.ply_binormal));
    if (READS_PLACE) {
        section_place = vec3(section, distance(f.position, f.ply_center));
    }
    if (READS_PLY_FRAME) {
        ply_normal = f.ply_normal;
        ply_binormal = f.ply_binormal;
    }
    if (READS_FIBER) {
        joining = joins;
        fiber_index = drawn_fiber;
        piece = patch_segment;
    }
    if (AT_VERTICES) {
        vertex_radiance = radiance_at(f, section);
    }
    if (MOTION_LAYER && NEIGHBOURS) {
        place_in_neighbours(segment, f, t, FLYAWAYS ? cuts_beside(place, t) : vec2(0.0));
    }
    if (ID_LAYER) {
        curve = segment.curve;
    }
}
