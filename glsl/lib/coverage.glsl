// Coverage by samples in place of blending; twin: src/math/coverage.rs.
#ifndef WORSTED_COVERAGE
#define WORSTED_COVERAGE

#include "hash.glsl"

// Mask of the samples of a pixel that something covering `alpha` of it takes: as many as alpha asks for,
// the last by chance, from a random one on, so that two things of the same alpha hide each other no more
// than by chance. `samples` is 1 to 32.
uint coverage_mask(float alpha, uint samples, uint word) {
    float wanted = clamp(alpha, 0.0, 1.0) * float(samples);
    uint taken = min(uint(wanted + uniform_from_word(word)), samples);
    uint all = 0xffffffffu >> (32u - samples);
    uint run = taken == 0u ? 0u : 0xffffffffu >> (32u - taken);
    uint shift = word % samples;
    return shift == 0u ? run : ((run << shift) | (run >> (samples - shift))) & all;
}

// The edge of a magnified texture: `texels` per pixel below 1 make its coverage as steep as its texels are
// large, about one half.
float sharpened_coverage(float alpha, float texels) {
    return texels >= 1.0 ? alpha : clamp(0.5 + (alpha - 0.5) / max(texels, 1e-3), 0.0, 1.0);
}

#endif
