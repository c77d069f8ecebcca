//! Where fibers lie in a ply's cross-section (Zhao et al. 2016; used by Wu & Yuksel 2019, Sec. 4.1).

use super::params::YarnParams;
use crate::math::quadrature::gauss_legendre;
use std::f64::consts::{E, TAU};

/// p(R), an *area* density (not normalised) at `radius` = R in [0, 1] of the ply's ellipse; 0 outside.
pub fn fiber_density(radius: f64, beta: f64, epsilon: f64) -> f64 {
    if !(0.0..=1.0).contains(&radius) {
        return 0.0;
    }
    let falloff = ((E - radius.exp()) / (E - 1.0)).max(0.0);
    (1.0 - 2.0 * epsilon) * falloff.powf(beta) + epsilon
}

/// Integral of p over one ply's cross-section, in mm^2.
pub fn density_mass_mm2(yarn: &YarnParams) -> f64 {
    let ring = |r: f64| TAU * r * fiber_density(r, yarn.density_beta, yarn.density_epsilon);
    // The power law bends hardest at the rim: several pieces, the last ones short.
    let cuts = [0.0, 0.5, 0.8, 0.95, 0.99, 1.0];
    let unit: f64 = cuts.windows(2).map(|c| gauss_legendre(c[0], c[1], ring)).sum();
    unit * yarn.ellipse_short_mm * yarn.ellipse_long_mm
}

/// Extinction per mm of p: a fiber crossing the cross-section blocks a width of its diameter, so N
/// fibers of diameter d spread over the mass of p block N d / mass per unit of p and length.
pub fn extinction_per_mm(yarn: &YarnParams) -> f64 {
    f64::from(yarn.fibers_per_ply) * 2.0 * yarn.fiber_radius_mm() / density_mass_mm2(yarn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::presets;

    #[test]
    fn density_has_its_stated_values() {
        assert_eq!(fiber_density(0.0, 0.4, 0.1), 0.9);
        assert!((fiber_density(1.0, 0.4, 0.1) - 0.1).abs() < 1e-12);
        assert_eq!(fiber_density(0.7, 0.0, 0.0), 1.0);
        assert_eq!(fiber_density(1.001, 0.4, 0.1), 0.0);
        assert_eq!(fiber_density(f64::NAN, 0.4, 0.1), 0.0);
    }

    #[test]
    fn mass_agrees_with_a_fine_sum() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let n = 1_000_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let r = (f64::from(i) + 0.5) / f64::from(n);
                TAU * r * fiber_density(r, yarn.density_beta, yarn.density_epsilon) / f64::from(n)
            })
            .sum();
        let mass = density_mass_mm2(&yarn);
        let expected = sum * yarn.ellipse_short_mm * yarn.ellipse_long_mm;
        assert!((mass / expected - 1.0).abs() < 1e-3, "{mass} vs {expected}");
    }
}
