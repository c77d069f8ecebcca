// How much of a yarn is drawn where it is small in the picture; twin: src/yarn/detail.rs.
#ifndef WORSTED_DETAIL
#define WORSTED_DETAIL

#include "../shared/constants.glsl"
#include "../shared/layouts.glsl"
#include "../lib/hash.glsl"
#include "period.glsl"

// Share of the number of ranks kept over which a rank fades in.
const float RANK_FADE = 0.25;
// Share of the part of fibers kept over which one fades in.
const float THINNING_FADE = 0.2;
// Share of the ply's radius from which on loops and hairs are seen beside the core, which stands for fibers that
// only migrate: without those that stay within the ply it would be shaded as too deep.
const float FLYING_SHARE = 0.6;
// Most width to which fibers are drawn in place of others, as a share of the ply's: those that stand out of it would
// hide it or stick out from behind it where the ones they stand for do not.
const float WIDEST_SHARE = 0.25;
// Periods in a piece of yarn beyond which it is taken to hold a flyaway without looking.
const int MOST_PERIODS_SEARCHED = 8;

// What a piece of yarn is drawn with.
struct Detail {
    float kept;   // ranks of fibers drawn one by one in each ply, from the outermost
    float share;  // of all fibers that is kept where they are thinner than allowed; above 1 none is
    float level;  // place in the core's levels, 0 (whole detail) to CORE_LEVELS - 1 (core alone)
};

// Wu & Yuksel 2019, Eq. 4, with the widths in pixels: 1 where a fiber is at least `threshold` wide, 0
// where a ply is at most that, falling in between.
float lod_factor(float fiber_px, float ply_px, float threshold) {
    if (fiber_px >= threshold) {
        return 1.0;
    }
    if (ply_px <= threshold) {
        return 0.0;
    }
    return (fiber_px / threshold) * ((ply_px - threshold) / (ply_px - fiber_px));
}

// Share of all fibers that is kept where each is `fiber_px` pixels wide, plies are `ply_px` and `thin` pixels are
// the least allowed; above 1 none is dropped.
float share_kept(float fiber_px, float ply_px, float thin) {
    return fiber_px / max(min(thin, WIDEST_SHARE * ply_px), 1e-30);
}

// What is drawn of a yarn whose pixels are `pixel_mm` wide at its place. `threshold` and `thin` in pixels.
Detail detail_of(float pixel_mm, float threshold, float thin, Yarn yarn) {
    float fiber_px = 2.0 * yarn.fiber_radius / pixel_mm;
    float ply_px = 2.0 * yarn.ply_radius / pixel_mm;
    float factor = lod_factor(fiber_px, ply_px, threshold);
    Detail detail;
    detail.kept = factor * factor * yarn.core_ranks;
    detail.share = share_kept(fiber_px, ply_px, thin);
    detail.level = (1.0 - factor) * float(CORE_LEVELS - 1u);
    return detail;
}

// Share of its width with which a rank is drawn while `kept` are: ranks fade in one after another.
float rank_weight(uint rank, float kept) {
    return clamp(1.0 + (kept / float(rank + 1u) - 1.0) / RANK_FADE, 0.0, 1.0);
}

// The fibers in the order in which they are kept: `slot` counts those that stay longest first. Successive
// slots lie far apart (the stride is near the golden section), so that any share of the fibers is spread over
// all plies and ranks.
uint fiber_of_slot(uint slot, Yarn yarn) {
    return slot * yarn.slot_stride % yarn.fiber_count;
}

// Share of its width with which the fiber at `place` in (0, 1) of that order is drawn while `share` of all are
// kept.
float thinning_weight(float place, float share) {
    return clamp(0.5 + (share - place) / (THINNING_FADE * max(share, 1e-6)), 0.0, 1.0);
}

// Factor of a fiber's true width: what is kept is wide enough to cover as much as all did.
float width_factor(float thinning, float share) {
    return thinning * max(1.0, 1.0 / max(share, 1e-6));
}

// R beyond which a loop or hair of the fiber stands out of the ply and of the fiber's own migration: within,
// the core stands for it.
float flying_radius(Fiber fiber, Yarn yarn) {
    return max(FLYING_SHARE, fiber.radius) * yarn.migration_max;
}

// Part of a period, as places in it, outside of which the fiber does not stand out of the ply; empty (from > to)
// where it nowhere does. Not tight: the radius of the migration that goes on is taken to be its largest.
vec2 flying_range(Fiber fiber, Period period, Yarn yarn) {
    float low = fiber.radius * yarn.migration_max;
    float missing = flying_radius(fiber, yarn) - low;
    float gain = max(period.reach - low, 0.0);
    if (period.kind == KIND_MIGRATION || missing >= gain) {
        return vec2(1.0, 0.0);
    }
    if (period.kind == KIND_LOOP) {
        // gain sin^2(pi x) reaches what is missing no nearer to the ends than this: asin(z) >= z.
        float from = sqrt(missing / gain) / PI;
        return vec2(from, 1.0 - from);
    }
    float from = period.share * missing / gain;
    return period.root_first ? vec2(from, period.share) : vec2(1.0 - period.share, 1.0 - from);
}

// Whether a loop or hair of the fiber may stand out of the ply somewhere over the piece.
bool has_flyaway(Segment segment, Fiber fiber, uint fiber_index, Yarn yarn) {
    float start = period_turns(segment, fiber, 0.0, yarn);
    float end = period_turns(segment, fiber, 1.0, yarn);
    float low = min(start, end);
    float high = max(start, end);
    int first = int(floor(low));
    int last = int(floor(high));
    if (last - first > MOST_PERIODS_SEARCHED) {
        return true;
    }
    for (int k = first; k <= last; ++k) {
        Period period = draw_period(segment, fiber, fiber_index, period_base(segment, yarn) + k, yarn);
        vec2 range = flying_range(fiber, period, yarn) + float(k);
        if (range.x <= range.y && range.x <= high && range.y >= low) {
            return true;
        }
    }
    return false;
}

// Place of the (n + 1)-th set bit of 64, the lowest first.
uint nth_set_bit(uvec2 mask, uint n) {
    uint word = mask.x;
    uint place = 0u;
    uint low = uint(bitCount(mask.x));
    if (n >= low) {
        n -= low;
        word = mask.y;
        place = 32u;
    }
    for (int width = 16; width > 0; width >>= 1) {
        uint count = uint(bitCount(bitfieldExtract(word, 0, width)));
        if (n >= count) {
            n -= count;
            word >>= uint(width);
            place += uint(width);
        }
    }
    return place;
}

#endif
