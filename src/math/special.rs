//! Special functions; `normal_density` and `normal_cdf` are twins of `glsl/lib/special.glsl`.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

/// phi(z), the density of the standard normal distribution.
pub fn normal_density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / TAU.sqrt()
}

/// Phi(z), the share of the standard normal distribution below `z`.
pub fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-FRAC_1_SQRT_2 * z)
}

/// From here on the terms of the asymptotic series that are summed fall below 1e-16.
const ASYMPTOTIC: f64 = 30.0;
const ASYMPTOTIC_TERMS: u32 = 16;

/// exp(-k) I0(k), the modified Bessel function of the first kind, exponentially scaled so that it stays in (0, 1]
/// for every `k` >= 0.
pub fn i0e(k: f64) -> f64 {
    if k > ASYMPTOTIC { i0e_series(k) } else { i0e_integral(k) }
}

/// Abramowitz and Stegun 1964, Eq. 9.7.1.
fn i0e_series(k: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for n in 1..=ASYMPTOTIC_TERMS {
        let odd = 2.0 * f64::from(n) - 1.0;
        term *= odd * odd / (8.0 * k * f64::from(n));
        sum += term;
    }
    sum / (TAU * k).sqrt()
}

/// The mean of exp(k (cos t - 1)) over a turn. The trapezoid rule's error on this periodic function is
/// 2 I_n(k) / exp(k), about exp(-n^2 / 2k).
fn i0e_integral(k: f64) -> f64 {
    let half_steps = 12.0 + (4.5 * k.sqrt()).ceil();
    let at = |i: u32| (-2.0 * k * (0.5 * PI * f64::from(i) / half_steps).sin().powi(2)).exp();
    let between = (1..half_steps as u32).map(at).sum::<f64>();
    (0.5 + between + 0.5 * at(half_steps as u32)) / half_steps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::integrate;

    #[test]
    fn the_scaled_bessel_function_is_its_integral_and_its_tabulated_values() {
        // Abramowitz and Stegun 1964, Table 9.8.
        for (k, value) in
            [(0.0, 1.0), (1.0, 0.465_759_607_6), (5.0, 0.183_540_812_6), (10.0, 0.127_833_337_2)]
        {
            assert!((i0e(k) - value).abs() < 1e-9, "{k}: {}", i0e(k));
        }
        for k in [1e-3, 0.9, 22.8, 29.9, 30.1, 131.3, 13_131.0] {
            let mean = integrate([0.0, PI], 64, 1e-9, &|t: f64| [(-2.0 * k * (0.5 * t).sin().powi(2)).exp()])
                [0]
                / PI;
            assert!((i0e(k) / mean - 1.0).abs() < 1e-12, "{k}: {} vs {mean}", i0e(k));
        }
        for k in [ASYMPTOTIC, 60.0, 900.0] {
            assert!((i0e_series(k) / i0e_integral(k) - 1.0).abs() < 1e-13, "{k}");
        }
    }

    #[test]
    fn the_normal_distribution_is_its_density_s_integral() {
        for z in [-8.0, -1.0, 0.0, 0.3, 2.0, 6.0] {
            let below = integrate([-40.0, z], 64, 1e-9, &|x| [normal_density(x)])[0];
            assert!((normal_cdf(z) / below - 1.0).abs() < 1e-10, "{z}: {} vs {below}", normal_cdf(z));
        }
        assert!((normal_cdf(1.959_963_984_540_054) - 0.975).abs() < 1e-15);
    }
}
