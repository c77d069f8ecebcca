// What the kernels of glsl/yarn/packed.glsl share.
#ifndef WORSTED_PACKED_KERNEL
#define WORSTED_PACKED_KERNEL

#include "kernel.glsl"
#include "../yarn/packed.glsl"

uvec2 take_uvec2() {
    uint low = take_uint();
    return uvec2(low, take_uint());
}

Piece take_packed() {
    uint low = take_uint();
    return Piece(low, take_uint());
}

// A float holds half a word exactly.
void give_word(uint word) {
    give(float(word & 0xffffu));
    give(float(word >> 16));
}

void give_words(uvec2 words) {
    give_word(words.x);
    give_word(words.y);
}

Curve take_curve() {
    Curve curve;
    curve.first_point = take_uint();
    curve.curve = take_uint();
    curve.migration_period_count = take_uint();
    curve.ply_phase = take_uint();
    curve.fiber_phase = take_uint();
    curve.migration_phase = take_uint();
    curve.ply_rate = take_uvec2();
    curve.fiber_rate = take_uvec2();
    curve.migration_rate = take_uvec2();
    curve.stripe_rate = take_uvec2();
    curve.length_mm = take_float();
    return curve;
}

#endif
