// What the control and evaluation stages of all fiber passes ask of a piece of yarn.
#ifndef WORSTED_PASS_LEVEL
#define WORSTED_PASS_LEVEL

#include "../yarn/detail.glsl"
#include "../yarn/level.glsl"

// A point's depth along the view axis is depth_axis().xyz . p + depth_axis().w.
vec4 depth_axis() {
    return vec4(frame.clip_from_world[0].w, frame.clip_from_world[1].w, frame.clip_from_world[2].w,
                frame.clip_from_world[3].w);
}

// What a yarn is drawn with where its pixels are `pixel_mm` wide. Without level of detail: all that the
// core does not stand for anyway.
Detail detail_at(float pixel_mm) {
    if (!LEVEL_OF_DETAIL) {
        return Detail(yarn.core_ranks, 2.0, 0.0);
    }
    return detail_of(pixel_mm, frame.lod_threshold_px, frame.thin_fiber_px, yarn);
}

// Least pieces a turn of a fiber or ply, however small it is in the picture: straight pieces cut its way around
// short, and what is drawn narrower than it is covers less.
const float PIECES_PER_TURN = 6.0;

// Share of its width with which the fiber in a slot is drawn, whatever its rank.
float slot_weight(uint slot, Detail detail) {
    return thinning_weight((float(slot) + 0.5) / float(yarn.fiber_count), detail.share);
}

// Share of the width below which plies are shaded at their vertices over which pieces change to it, each at a width
// of its own: what that changes must not show all at once.
const float VERTEX_SHADED_FADE = 0.4;

// Whether this pipeline draws a piece of yarn whose pixels are `pixel_mm` wide: another has those that are shaded
// elsewhere.
bool drawn_here(uint segment_index, float pixel_mm) {
    if (!VERTEX_SHADING) {
        return true;
    }
    float chance = uniform_from_word(hash_words(uvec4(yarn.first_piece + segment_index, 0u, 0u, 0u)).x);
    float width_px = frame.vertex_shaded_px * (1.0 + VERTEX_SHADED_FADE * (chance - 0.5));
    return (2.0 * yarn.ply_radius < width_px * pixel_mm) == AT_VERTICES;
}

float pixel_mm_at(vec3 position) {
    return frame.pixel_tangent * max(dot(depth_axis().xyz, position) + depth_axis().w, frame.near_mm);
}

void count_patch(bool culled) {
    if (culled) {
        atomicAdd(statistics.patches_culled, 1);
    } else {
        atomicAdd(statistics.patches_drawn, 1);
    }
}

void count_coarse(bool coarse) {
    if (coarse) {
        atomicAdd(statistics.patches_coarse, 1);
    }
}

void count_segments(uint fiber_segments) {
    uint before = atomicAdd(statistics.fiber_segments_low, fiber_segments);
    if (before + fiber_segments < before) {
        atomicAdd(statistics.fiber_segments_high, 1);
    }
}

#endif
