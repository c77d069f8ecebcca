// What a fiber is in each period of its radius: migration, loop, or in part a hair.
// Twin: src/yarn/period.rs.
#ifndef WORSTED_PERIOD
#define WORSTED_PERIOD

#include "../shared/constants.glsl"
#include "../shared/layouts.glsl"
#include "segment.glsl"
#include "../lib/hash.glsl"
#include "migration.glsl"

const uint KIND_MIGRATION = 0;
const uint KIND_LOOP = 1;
const uint KIND_HAIR = 2;
// In views by kind: a core fiber, which stands for many.
const uint KIND_CORE = 3;

// A hair takes at least a visible part of its period, and leaves some of it to the fiber it broke from.
const float HAIR_SHARE_MIN = 0.02;
const float HAIR_SHARE_MAX = 0.9;
// Most by which a hair's line is lengthened inward: a tip that barely leaves the ply has no slope.
const float HAIR_INWARD_MAX = 4.0;

// One period of one fiber. Loops and hairs are drawn for each period: from a minimum of R to the next,
// or an equal part of that where a slow migration would hold more than one (`periods_per_migration`).
struct Period {
    int index;         // along the curve; wrapped on closed curves
    uint kind;
    float reach;       // largest R of a loop, R at the tip of a hair
    float share;       // of the period that the hair takes, (0, 1)
    float twist;       // of the hair beyond its root's angle, radians over its length
    bool root_first;   // whether the hair's root lies where the period starts
};

// Periods before the point at t, counted from a minimum of R; relative to `period_base`.
float period_turns(Segment segment, Fiber fiber, float t, Yarn yarn) {
    float turns = segment.migration_turns + t * segment.migration_turns_delta + fiber.migration_phase / TWO_PI - 0.5;
    return turns * float(yarn.periods_per_migration);
}

// Periods per unit of t; negative where they count down along the yarn.
float period_rate(Segment segment, Yarn yarn) {
    return segment.migration_turns_delta * float(yarn.periods_per_migration);
}

// Index of the period in which `period_turns` is 0.
int period_base(Segment segment, Yarn yarn) {
    return segment.migration_period * int(yarn.periods_per_migration);
}

// Random identity of a period: the same for both sides of a closed curve's closing point.
int period_identity(Segment segment, int index, Yarn yarn) {
    int count = int(segment.migration_period_count * yarn.periods_per_migration);
    if (count <= 0) {
        return index;
    }
    int wrapped = index % count;
    return wrapped < 0 ? wrapped + count : wrapped;
}

// A normal number, drawn again where it is not positive.
float draw_positive(uvec3 words, float mean, float deviation) {
    float value = 0.0;
    for (uint attempt = 1u; attempt <= 8u && value <= 0.0; ++attempt) {
        uvec4 w = hash_words(uvec4(words, attempt));
        value = mean + deviation * normal_from_words(w.x, w.y);
    }
    return max(value, 0.0);
}

// Draws the hair of a period of a fiber with R_i = `fiber_radius` from three random words. The
// statistics state a hair from where it leaves the ply; its line goes on inward at the same slopes to
// its root at the fiber's R_min, so that it is longer and turns farther by the same ratio.
void draw_hair(inout Period period, uvec3 words, float fiber_radius, Yarn yarn) {
    uvec4 a = hash_words(uvec4(words, 0u));
    uvec4 b = hash_words(uvec4(words, 9u));
    float start = yarn.hair_start_mean + yarn.hair_start_sd * normal_from_words(a.x, a.y);
    float gain = draw_positive(a.yzw, yarn.hair_gain_mean, yarn.hair_gain_sd);
    period.reach = start + gain;
    float root = fiber_radius * yarn.migration_min;
    float whole_line = clamp((period.reach - root) / max(gain, 1e-6), 1.0, HAIR_INWARD_MAX);
    period.share = clamp(whole_line * draw_positive(b.yzw, yarn.hair_share_mean, yarn.hair_share_sd),
                         HAIR_SHARE_MIN, HAIR_SHARE_MAX);
    // From root to tip along the fiber's own twist, or against it.
    float turned = (period.root_first ? TWO_PI : -TWO_PI) * period.share;
    float whole = yarn.hair_turns_per_period > 0.0
        ? turned * yarn.hair_turns_per_period
        : whole_line * (yarn.hair_angle_mean + yarn.hair_angle_sd * normal_from_words(b.x, a.z));
    period.twist = whole - turned * yarn.fiber_turns_per_period;
}

// Draws what the fiber is in the period `index` of the segment's curve. Wu & Yuksel 2019, Sec. 3.1;
// statistics of Zhao et al. 2016.
Period draw_period(Segment segment, Fiber fiber, uint fiber_index, int index, Yarn yarn) {
    uint identity = uint(period_identity(segment, index, yarn));
    uvec4 a = hash_words(uvec4(segment.curve, identity, fiber_index, yarn.seed));
    float chance = uniform_from_word(a.x);
    Period period;
    period.index = index;
    period.kind = chance < yarn.hair_probability ? KIND_HAIR
        : chance < yarn.hair_probability + yarn.loop_probability ? KIND_LOOP : KIND_MIGRATION;
    period.reach = 0.0;
    period.share = 0.0;
    period.twist = 0.0;
    period.root_first = (a.y & 1u) == 0u;
    if (period.kind == KIND_LOOP) {
        period.reach = yarn.loop_radius_mean + yarn.loop_radius_sd * normal_from_words(a.z, a.w);
    } else if (period.kind == KIND_HAIR) {
        draw_hair(period, a.yzw, fiber.radius, yarn);
    }
    return period;
}

// The strand as it lies at one point: R, the angle beyond the fiber's own, and their derivatives by t.
struct FiberShape {
    float radius;
    float radius_rate;
    float angle;
    float angle_rate;
    float width;       // share of the fiber's full width: hairs taper to a point
};

// A fiber that only migrates. `phase` is that of R, in radians, without the fiber's own m_i.
FiberShape migration_shape(Fiber fiber, float phase, float phase_rate, Yarn yarn) {
    vec2 r = migration_radius(fiber.radius, fiber.migration_phase + phase, yarn.migration_min, yarn.migration_max);
    return FiberShape(r.x, r.y * phase_rate, 0.0, 0.0, 1.0);
}

// Phase of R at place `x` of a period, in radians.
float period_phase(Period period, float x, Yarn yarn) {
    int parts = int(yarn.periods_per_migration);
    int part = period.index % parts;
    return TWO_PI * (float(part < 0 ? part + parts : part) + x) / float(parts) + PI;
}

// R and its derivative by t of the migration that goes on in a period.
vec2 period_migration(Fiber fiber, Period period, float x, float x_rate, Yarn yarn) {
    vec2 r = migration_radius(fiber.radius, period_phase(period, x, yarn), yarn.migration_min, yarn.migration_max);
    return vec2(r.x, r.y * TWO_PI * x_rate / float(yarn.periods_per_migration));
}

// A loop: migration and a wave on top that brings it out to its own reach; with one period to a
// migration that is Wu & Yuksel's larger R_max. `x` in [0, 1] is the place in the period.
FiberShape loop_shape(Fiber fiber, Period period, float x, float x_rate, Yarn yarn) {
    vec2 r = period_migration(fiber, period, x, x_rate, yarn);
    float swing = 0.5 * max(period.reach - fiber.radius * yarn.migration_max, 0.0);
    r += swing * vec2(1.0 - cos(TWO_PI * x), sin(TWO_PI * x) * TWO_PI * x_rate);
    return FiberShape(r.x, r.y, 0.0, 0.0, 1.0);
}

// A hair from its root to its tip: linear in R and angle. `y` in [0, 1] is the place along it.
FiberShape hair_shape(Fiber fiber, Period period, float y, float y_rate, Yarn yarn) {
    float low = period_migration(fiber, period, period.root_first ? 0.0 : 1.0, 0.0, yarn).x;
    float high = max(period.reach, fiber.radius * yarn.migration_max);
    float width = yarn.hair_taper > 0.0 ? clamp((1.0 - y) / yarn.hair_taper, 0.0, 1.0) : 1.0;
    return FiberShape(mix(low, high, y), (high - low) * y_rate, period.twist * y, period.twist * y_rate, width);
}

// Where the hair of a period ends, as a place in it.
float hair_cut(Period period) {
    return period.root_first ? period.share : 1.0 - period.share;
}

// Whether the place `x` of a hair's period lies on the hair rather than on the rest of the fiber.
bool on_hair(Period period, float x) {
    return period.root_first ? x <= period.share : x >= 1.0 - period.share;
}

// The fiber at place `x` of its period; `x_rate` = dx / dt.
FiberShape period_shape(Fiber fiber, Period period, float x, float x_rate, Yarn yarn) {
    if (period.kind == KIND_LOOP) {
        return loop_shape(fiber, period, x, x_rate, yarn);
    }
    if (period.kind == KIND_HAIR && on_hair(period, x)) {
        float direction = period.root_first ? 1.0 : -1.0;
        float y = period.root_first ? x : 1.0 - x;
        return hair_shape(fiber, period, clamp(y / period.share, 0.0, 1.0), direction * x_rate / period.share, yarn);
    }
    vec2 r = period_migration(fiber, period, x, x_rate, yarn);
    return FiberShape(r.x, r.y, 0.0, 0.0, 1.0);
}

#endif
