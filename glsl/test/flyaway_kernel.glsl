// Arguments and answers that the kernels of periods, loops and hairs share.
#ifndef WORSTED_FLYAWAY_KERNEL
#define WORSTED_FLYAWAY_KERNEL

#include "kernel.glsl"
#include "../yarn/breaks.glsl"

Segment take_segment() {
    Segment segment;
    segment.curve = take_uint();
    segment.migration_period = int(take_uint());
    segment.migration_period_count = take_uint();
    segment.migration_turns = take_float();
    segment.migration_turns_delta = take_float();
    return segment;
}

Fiber take_fiber() {
    Fiber fiber;
    fiber.radius = take_float();
    fiber.migration_phase = take_float();
    return fiber;
}

Yarn take_yarn() {
    Yarn yarn;
    yarn.migration_min = take_float();
    yarn.migration_max = take_float();
    yarn.loop_probability = take_float();
    yarn.loop_radius_mean = take_float();
    yarn.loop_radius_sd = take_float();
    yarn.hair_probability = take_float();
    yarn.hair_start_mean = take_float();
    yarn.hair_start_sd = take_float();
    yarn.hair_gain_mean = take_float();
    yarn.hair_gain_sd = take_float();
    yarn.hair_share_mean = take_float();
    yarn.hair_share_sd = take_float();
    yarn.hair_angle_mean = take_float();
    yarn.hair_angle_sd = take_float();
    yarn.hair_turns_per_period = take_float();
    yarn.fiber_turns_per_period = take_float();
    yarn.hair_taper = take_float();
    yarn.periods_per_migration = take_uint();
    yarn.seed = take_uint();
    return yarn;
}

Period take_period() {
    Period period;
    period.index = int(take_uint());
    period.kind = take_uint();
    period.reach = take_float();
    period.share = take_float();
    period.twist = take_float();
    period.root_first = take_uint() != 0;
    return period;
}

uvec3 take_words() {
    uint x = take_uint();
    uint y = take_uint();
    uint z = take_uint();
    return uvec3(x, y, z);
}

void give(bool value) {
    give(value ? 1.0 : 0.0);
}

// Halves of a word, which floats hold exactly.
void give_bits(uint word) {
    give(float(word >> 16));
    give(float(word & 0xffffu));
}

void give(Period period) {
    give(float(period.kind));
    give(period.reach);
    give(period.share);
    give(period.twist);
    give(period.root_first);
}

void give(FiberShape shape) {
    give(shape.radius);
    give(shape.radius_rate);
    give(shape.angle);
    give(shape.angle_rate);
    give(shape.width);
}

#endif
