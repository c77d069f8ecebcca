// Where fibers lie in a ply's cross-section; twin: src/yarn/density.rs. Drawing reads what tables hold of it.
#ifndef WORSTED_DENSITY
#define WORSTED_DENSITY

// 1 - exp(-x) for x in [0, 1]: its series up to 1/4, where the difference would cancel.
float one_minus_exp(float x) {
    float series = x * (1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0)))));
    return x < 0.25 ? series : 1.0 - exp(-x);
}

// p(R), an area density (not normalised) at `radius` = R of the ply's ellipse; 0 outside (Zhao et al. 2016).
float fiber_density(float radius, float beta, float epsilon) {
    if (!(radius >= 0.0 && radius <= 1.0)) {
        return 0.0;
    }
    // (e - e^R) / (e - 1).
    float falloff = one_minus_exp(1.0 - radius) * (1.0 / 0.63212055882855767);
    // `pow` is undefined at a base of 0.
    float power = beta > 0.0 ? (falloff > 0.0 ? pow(falloff, beta) : 0.0) : 1.0;
    return (1.0 - 2.0 * epsilon) * power + epsilon;
}

#endif
