//! Draws directions of light by importance, with their density: theta_i from R's or TT's Gaussian, cut off at the
//! poles, and phi uniform for R and from the von Mises distribution for TT.

use super::{FAR, FiberScattering, azimuthal_tt, concentration, cosine, gaussian, gaussian_range, schlick};
use crate::math::quadrature::quantile;
use crate::math::special::{i0e, normal_cdf};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Which lobe a direction was drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// Reflected.
    R,
    /// Gone through.
    Tt,
}

/// A direction of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// theta_i, radians, in [-pi/2, pi/2].
    pub theta_i: f64,
    /// phi_i - phi_o, radians, in [0, 2 pi].
    pub phi: f64,
    /// Density per steradian, as [`pdf`] gives it.
    pub pdf: f64,
    /// The lobe that it was drawn from; the density is of both.
    pub lobe: Lobe,
}

/// Least share of the samples that a lobe gets if it scatters anything at all: its weights are bounded by that.
const LEAST_SHARE: f64 = 0.1;

/// Probability that a sample is R's: about its share of the light toward `theta_o`.
fn reflected_share(theta_o: f64, fiber: &FiberScattering) -> f64 {
    let (c_r, rest) = (fiber.c_r, 1.0 - fiber.c_r);
    let through = rest * fiber.c_tt;
    // Reflection is there however small C_R is: F rises at grazing angles.
    if through.max_element() <= 0.0 {
        return 1.0;
    }
    let grazing = schlick(cosine(theta_o));
    let reflected = (c_r + rest * grazing).element_sum();
    let share = reflected / (reflected + (1.0 - grazing) * through.element_sum());
    share.clamp(LEAST_SHARE, 1.0 - LEAST_SHARE)
}

/// Density per radian of theta_i for one lobe.
fn theta_pdf(theta_i: f64, theta_o: f64, width: f64) -> f64 {
    let mass = normal_cdf((FRAC_PI_2 + theta_o) / width) - normal_cdf((theta_o - FRAC_PI_2) / width);
    gaussian(theta_i + theta_o, width) / mass
}

fn sample_theta(theta_o: f64, width: f64, u: f64) -> f64 {
    let range = gaussian_range(-theta_o, width);
    let [low, high] = range.map(|theta| normal_cdf((theta + theta_o) / width));
    quantile(range, high - low, u, &|theta| gaussian(theta + theta_o, width))
}

/// phi of TT: pi plus or minus an angle whose distribution is cut off where the lobe is nothing.
fn sample_phi_tt(gamma: f64, u: f64) -> f64 {
    let k = concentration(gamma);
    // exp(-2 k sin^2(x / 2)) is below exp(-FAR^2 / 2) beyond.
    let far = 2.0 * (0.5 * FAR / k.sqrt()).min(1.0).asin();
    let (sign, u) = if u < 0.5 { (-1.0, 1.0 - 2.0 * u) } else { (1.0, 2.0 * u - 1.0) };
    let density = |x: f64| (-2.0 * k * (0.5 * x).sin().powi(2)).exp();
    PI + sign * quantile([0.0, far], PI * i0e(k), u, &density)
}

/// Density per steradian with which [`sample`] draws (theta_i, phi) for `theta_o`, all radians. Infinite at the
/// poles, where a cone of directions has no size.
pub fn pdf(theta_i: f64, theta_o: f64, phi: f64, fiber: &FiberScattering) -> f64 {
    let share = reflected_share(theta_o, fiber);
    let r = theta_pdf(theta_i, theta_o, fiber.beta_r) / TAU;
    let tt = theta_pdf(theta_i, theta_o, fiber.beta_tt) * azimuthal_tt((0.5 * phi).cos(), fiber.gamma_tt);
    (share * r + (1.0 - share) * tt) / cosine(theta_i)
}

/// A direction of light for `theta_o` from three uniform numbers in [0, 1): one chooses the lobe, one theta_i and
/// one phi.
pub fn sample(theta_o: f64, fiber: &FiberScattering, u: [f64; 3]) -> Sample {
    let is_r = u[0] < reflected_share(theta_o, fiber);
    let (lobe, theta_i, phi) = if is_r {
        (Lobe::R, sample_theta(theta_o, fiber.beta_r, u[1]), TAU * u[2])
    } else {
        (Lobe::Tt, sample_theta(theta_o, fiber.beta_tt, u[1]), sample_phi_tt(fiber.gamma_tt, u[2]))
    };
    Sample { theta_i, phi, pdf: pdf(theta_i, theta_o, phi, fiber), lobe }
}

#[cfg(test)]
#[path = "sample_tests.rs"]
mod tests;
