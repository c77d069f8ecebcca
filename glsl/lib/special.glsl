// Special functions; twin: src/math/special.rs.
#ifndef WORSTED_SPECIAL
#define WORSTED_SPECIAL

// phi(z), the density of the standard normal distribution.
float normal_density(float z) {
    return 0.39894228 * exp(-0.5 * z * z);
}

// Phi(z), the share of the standard normal distribution below z, to 3e-7 (Abramowitz and Stegun 1964, Eq. 7.1.26).
float normal_cdf(float z) {
    float x = 0.70710678 * abs(z);
    float t = 1.0 / (1.0 + 0.3275911 * x);
    float series = ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t;
    float beyond = 0.5 * series * exp(-0.5 * z * z);
    return z < 0.0 ? beyond : 1.0 - beyond;
}

#endif
