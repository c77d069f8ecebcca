// Where in a pixel the samples lie that a triangle covers.
#ifndef WORSTED_COVERED
#define WORSTED_COVERED

#include "../shared/features.glsl"

// Of 4 samples, from the pixel's centre: the standard ones, which a device must have (src/vulkan/select.rs).
const vec2 SAMPLE_OFFSETS[4] = vec2[4](vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(-0.375, 0.125),
                                       vec2(0.125, 0.375));

// Mean and deviation over the covered samples of what is `at_center` in the pixel's centre and linear in the
// picture. It must not be `centroid`: that is any covered place, on some drivers always the first sample of a
// pixel, and so to one side.
vec2 covered_values(float at_center, int mask) {
    if (SAMPLES == 1u) {
        return vec2(at_center, 0.0);
    }
    vec2 slope = vec2(dFdx(at_center), dFdy(at_center));
    vec2 sums = vec2(0.0);
    float count = 0.0;
    for (int k = 0; k < 4; ++k) {
        if ((mask >> k & 1) == 1) {
            float offset = dot(slope, SAMPLE_OFFSETS[k]);
            sums += vec2(offset, offset * offset);
            count += 1.0;
        }
    }
    sums /= max(count, 1.0);
    return vec2(at_center + sums.x, sqrt(max(0.0, sums.y - sums.x * sums.x)));
}

#endif
