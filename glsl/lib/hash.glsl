// Random numbers from stable indices; twin: src/math/hash.rs, equal bit for bit.
#ifndef WORSTED_HASH
#define WORSTED_HASH

#include "../shared/constants.glsl"

// Four well mixed words from four indices (pcg4d: Jarzynski & Olano 2020).
uvec4 hash_words(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Uniform in (0, 1), exact in f32: 24 bits and a half.
float uniform_from_word(uint word) {
    return (float(word >> 9) + 0.5) * (1.0 / 8388608.0);
}

// A standard normal number cut off at three deviations (Box & Muller 1958).
float normal_from_words(uint a, uint b) {
    // A logarithm near 0 may come out positive: Vulkan allows it an error of 2^-21.
    float radius = sqrt(max(-2.0 * log(uniform_from_word(a)), 0.0));
    return clamp(radius * cos(TWO_PI * uniform_from_word(b)), -3.0, 3.0);
}

#endif
