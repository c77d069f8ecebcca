#version 460
// Culls a piece of yarn or decides which fibers it is drawn with, and how finely.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../yarn/fetch.glsl"
#include "../yarn/turning.glsl"
#include "level.glsl"
#include "shadow_limits.glsl"

// Each looks at an eighth of the group's slots: lanes that a device would otherwise leave idle.
const uint LANES = 8u;
layout(vertices = LANES) out;

layout(location = 0) in uint segment_index[];
layout(location = 1) in uint first_fiber[];
layout(location = 0) patch out uint patch_segment;
layout(location = 1) patch out uint patch_first_fiber;
layout(location = 2) patch out uint patch_fibers;
layout(location = 3) patch out uint patch_pieces;
layout(location = 4) patch out uvec2 patch_mask;
layout(location = 5) patch out vec3 patch_turns;        // of ply, fibers and migration: at the piece's start
layout(location = 6) patch out vec3 patch_turns_delta;
layout(location = 7) patch out vec2 patch_length;       // rest length before the piece, and its own
layout(location = 8) patch out uvec4 patch_curve;       // first point, curve, migration period, their number
layout(location = 9) patch out vec3 patch_bezier[4];
layout(location = 13) patch out vec3 patch_normals[2];
layout(location = 15) patch out uint lane_masks[LANES];
layout(location = 23) patch out uint patch_uneven;        // whether the pieces are cut by the table
layout(location = 24) patch out vec4 patch_breaks[TABLED_BREAKS / 4u];

// The slots of this group whose fibers are drawn over some of the piece, of every eighth from this lane's on, one bit
// each.
uint drawn_slots(Segment segment, uint slot_count, Detail detail) {
    uint mask = 0u;
    for (uint i = 0u; i * LANES < slot_count; ++i) {
        uint local = i * LANES + gl_InvocationID;
        uint slot = first_fiber[0] + local;
        if (local >= slot_count || slot_weight(slot, detail) <= 0.0) {
            break;  // nor any later one
        }
        uint index = fiber_of_slot(slot, yarn);
        bool drawn = rank_weight(index / yarn.ply_count, detail.kept) > 0.0;
        if (FLYAWAYS && !drawn) {
            drawn = has_flyaway(segment, fibers[index], index, yarn);
        }
        if (drawn) {
            mask |= 1u << i;
        }
    }
    return mask;
}

// Four bits, each in a byte of its own.
uint spread_bits(uint bits) {
    return (bits & 15u) * 0x00204081u & 0x01010101u;
}

// The lanes' slots as one mask, in the order of the slots.
uvec2 all_slots() {
    uvec2 mask = uvec2(0u);
    for (uint lane = 0u; lane < LANES; ++lane) {
        mask |= uvec2(spread_bits(lane_masks[lane]), spread_bits(lane_masks[lane] >> 4u)) << lane;
    }
    return mask;
}

// Farthest that a fiber lies from its ply's centre: loops and hairs turn about it farther out than its other fibers.
float fiber_reach() {
    float radius = 1.0;
    if (FLYAWAYS) {
        float hair = yarn.hair_probability > 0.0 ? yarn.hair_start_mean + yarn.hair_gain_mean : 0.0;
        float loop = yarn.loop_probability > 0.0 ? yarn.loop_radius_mean : 0.0;
        radius = max(radius, max(hair, loop));
    }
    float beyond = max(radius - surface_radius(yarn), 0.0);
    return max(radius * yarn.ellipse_short + beyond * yarn.beyond_short,
               radius * yarn.ellipse_long + beyond * yarn.beyond_long);
}

// Pieces of a fiber along `b` by the turns of plies and fibers, at most `most`.
uint twisted_pieces(Segment segment, vec3 b[4], float reach, float tolerance_mm, uint most) {
    return subdivisions(b, segment.ply_turns_delta, segment.fiber_turns_delta, yarn.ply_offset, reach, tolerance_mm,
                        PIECES_PER_TURN, most);
}

Cut cut_of(Segment segment, vec3 b[4], Turning turning, float pixel_mm, uint most) {
    float reach = fiber_reach();
    float tolerance_mm = frame.tolerance_px * pixel_mm;
    Cut cut = Cut(twisted_pieces(segment, b, reach, tolerance_mm, most), 0.0);
    if (SWIFT_TURNS) {
        vec3 nowhere[4] = vec3[4](b[0], b[0], b[0], b[0]);
        uint calm = twisted_pieces(segment, nowhere, reach, tolerance_mm, most);
        cut = uneven_cut(turning, b, cut.pieces, calm, yarn.ply_offset + reach, tolerance_mm, most);
    }
    if (FLYAWAYS) {
        // Where cuts follow turns, steps elsewhere are longer.
        cut.pieces = period_pieces(cut.pieces, period_rate(segment, yarn) / (1.0 - cut.share), most);
    }
    return cut;
}

// Where the pieces of a fiber end, for those that are not equally long.
void hand_on_breaks(Turning turning, float turned_share) {
    patch_uneven = turned_share > 0.0 ? 1u : 0u;
    // A count that is not known before the shader runs: software devices would do it all for every piece.
    uint count = turned_share > 0.0 ? TABLED_BREAKS : 0u;
    for (uint k = 0u; k < count; ++k) {
        float share = float(k + 1u) / float(TABLED_BREAKS);
        patch_breaks[k / 4u][k % 4u] = k + 1u < count ? break_at(turning, turned_share, share) : 1.0;
    }
}

// What the evaluation stage would unpack and fetch for every vertex.
void hand_on(Segment segment, Span span) {
    patch_turns = vec3(segment.ply_turns, segment.fiber_turns, segment.migration_turns);
    patch_turns_delta = vec3(segment.ply_turns_delta, segment.fiber_turns_delta, segment.migration_turns_delta);
    patch_length = vec2(segment.length_start, segment.length_mm);
    patch_curve = uvec4(segment.first_point, segment.curve, uint(segment.migration_period),
                        segment.migration_period_count);
    patch_bezier = span.bezier;
    patch_normals[0] = span.normal_start;
    patch_normals[1] = span.normal_end;
}

void main() {
    Segment segment = segment_at(segment_index[0]);
    Span span = fetch_span(segment.first_point);
    vec3 b[4] = span.bezier;
    bool outside = CULLING && outside_frustum(b, yarn.reach + yarn.fiber_radius, frame.frustum_world);
    float pixel_mm = frame.pixel_tangent * nearest_depth(b, depth_axis(), yarn.reach, frame.near_mm);
    // Of the yarn itself: it must not change with the hairs' length.
    float yarn_pixel_mm = frame.pixel_tangent * nearest_depth(b, depth_axis(), 0.0, frame.near_mm);
    bool elsewhere = !drawn_here(segment_index[0], yarn_pixel_mm);
    bool culled = outside || elsewhere;

    uint fiber_count = min(FIBERS_PER_PATCH, yarn.fiber_count - first_fiber[0]);
    Detail detail = detail_at(pixel_mm);
    lane_masks[gl_InvocationID] = CORE_FIBERS && !culled ? drawn_slots(segment, fiber_count, detail) : 0u;
    barrier();
    if (gl_InvocationID > 0) {
        return;
    }
    patch_mask = uvec2(0u);
    if (CORE_FIBERS) {
        patch_mask = all_slots();
        fiber_count = uint(bitCount(patch_mask.x) + bitCount(patch_mask.y));
    }
    Turning turning;
    if (SWIFT_TURNS) {
        turning = turning_of(b);
    }
    Cut cut = Cut(1u, 0.0);
    if (!culled && fiber_count > 0u) {
        cut = cut_of(segment, b, turning, pixel_mm, yarn.max_subdivisions);
    }
    uint pieces = cut.pieces;
    patch_segment = segment_index[0];
    patch_first_fiber = first_fiber[0];
    // The evaluation stage sees levels before clamping, so it gets the counts themselves.
    patch_fibers = fiber_count;
    patch_pieces = pieces;
    hand_on(segment, span);
    if (SWIFT_TURNS) {
        hand_on_breaks(turning, cut.share);
    }
    gl_TessLevelOuter[0] = culled ? 0.0 : float(fiber_count);
    gl_TessLevelOuter[1] = culled ? 0.0 : float(pieces);
    if (STATISTICS) {
        if (first_fiber[0] == 0 && !elsewhere) {
            count_patch(outside);
            Cut needed = cut_of(segment, b, turning, pixel_mm, yarn.max_subdivisions + 1u);
            count_coarse(!outside && needed.pieces > yarn.max_subdivisions);
            if (!outside) {
                count_shadow_limits(segment.first_point);
            }
        }
        count_segments(culled ? 0 : fiber_count * pieces);
    }
}
