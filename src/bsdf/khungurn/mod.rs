//! Scattering of a fiber by Khungurn's two lobes, R and TT, in the form of Wu & Yuksel 2019, Eq. 6-10, with
//! their misprints mended: F adds the grazing term, and the azimuthal factor of TT integrates to 1.
//!
//! Angles in radians. Directions point away from the fiber; theta, in [-pi/2, pi/2], is the angle to its
//! cross-section; phi = phi_i - phi_o is 0 where light returns and pi where it goes on. Radiance is the integral
//! of S L_i cos(theta_i) over the directions of the light. Nothing here reads a table: [`tabulated`] does, as
//! the shader does.

pub mod sample;
pub mod tabulated;

use crate::math::angle::longitudinal_angle;
use crate::math::frame::{any_perpendicular, direction_or};
use crate::math::quadrature::integrate;
use crate::math::special::{i0e, normal_density};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// How one kind of fiber scatters light. Widths are standard deviations in radians, 0.5 to 60 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiberScattering {
    /// C_R, 0..1: share reflected at normal incidence.
    pub c_r: DVec3,
    /// C_TT, 0..1: share of the rest that goes through.
    pub c_tt: DVec3,
    /// beta_R: longitudinal width of the reflection.
    pub beta_r: f64,
    /// beta_TT: longitudinal width of what goes through.
    pub beta_tt: f64,
    /// gamma_TT: azimuthal width of what goes through.
    pub gamma_tt: f64,
}

/// What each lobe does, per steradian or integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lobes {
    /// Reflected.
    pub r: DVec3,
    /// Gone through.
    pub tt: DVec3,
}

impl Lobes {
    /// Both lobes together.
    pub fn sum(self) -> DVec3 {
        self.r + self.tt
    }

    /// Both lobes, scaled.
    pub fn scaled(self, factor: f64) -> Self {
        Self { r: self.r * factor, tt: self.tt * factor }
    }
}

/// Widths beyond which a Gaussian is taken as 0: it is below 3e-18 of its peak.
const FAR: f64 = 9.0;
/// Panels of the Gaussian's range and how little a halving may change: the integrals below are good to 1e-11.
const PANELS: u32 = 3;
const TOLERANCE: f64 = 1e-8;

/// The part of [-pi/2, pi/2] where a Gaussian of this `width` about `mean` matters.
fn gaussian_range(mean: f64, width: f64) -> [f64; 2] {
    [(mean - FAR * width).max(-FRAC_PI_2), (mean + FAR * width).min(FRAC_PI_2)]
}

/// g: the normalised Gaussian, per radian, of standard deviation `width` at `off` radians from its mean.
fn gaussian(off: f64, width: f64) -> f64 {
    normal_density(off / width) / width
}

/// cos(theta), not below 0 where rounding brings theta beyond pi/2.
fn cosine(theta: f64) -> f64 {
    theta.cos().max(0.0)
}

/// (1 - cos(theta))^5, the grazing term of Schlick's Fresnel factor.
pub fn schlick(cos_theta: f64) -> f64 {
    (1.0 - cos_theta).powi(5)
}

/// 1 - (1 - cos(theta))^5, without the difference, which cancels at grazing angles.
pub fn schlick_rest(cos_theta: f64) -> f64 {
    let c = cos_theta;
    c * (5.0 + c * (-10.0 + c * (10.0 + c * (-5.0 + c))))
}

/// G(theta, beta), the integral of g cos^2 over [-pi/2, pi/2], g the normalised Gaussian about `theta`.
/// Even in `theta`.
pub fn longitudinal_normaliser(theta: f64, width: f64) -> f64 {
    let f = |t: f64| [gaussian(t - theta, width) * cosine(t).powi(2)];
    integrate(gaussian_range(theta, width), PANELS, TOLERANCE, &f)[0]
}

/// M = g(theta_o; -theta_i, beta) / G(-theta_i, beta), per radian; `theta_sum` = theta_i + theta_o. `variance`
/// widens g alone: the mean over tangents for which theta_i + theta_o varies so much about its mean.
pub fn longitudinal(theta_sum: f64, theta_i: f64, width: f64, variance: f64) -> f64 {
    gaussian(theta_sum, (width * width + variance).sqrt()) / longitudinal_normaliser(theta_i, width)
}

/// N_TT = exp(-k cos phi) / (2 pi I0(k)), k = `gamma`^-2, in a form that does not overflow; integrates to 1 over
/// phi.
pub fn azimuthal_tt(cos_half_phi: f64, gamma: f64) -> f64 {
    let k = concentration(gamma);
    (-2.0 * k * cos_half_phi * cos_half_phi).exp() / (TAU * i0e(k))
}

/// k: how narrow a lobe of azimuthal width `gamma` is.
pub fn concentration(gamma: f64) -> f64 {
    1.0 / (gamma * gamma)
}

impl FiberScattering {
    /// F = C_R + (1 - C_R) (1 - cos theta_i)^5.
    pub fn fresnel(&self, cos_theta: f64) -> DVec3 {
        self.c_r + (DVec3::ONE - self.c_r) * schlick(cos_theta)
    }
}

/// S at `theta_sum` = theta_i + theta_o, theta_i and |cos(phi / 2)|; `variance` is that of [`longitudinal`].
pub fn bcsdf_of_sum(
    theta_sum: f64,
    theta_i: f64,
    cos_half_phi: f64,
    variance: f64,
    fiber: &FiberScattering,
) -> Lobes {
    let c = cosine(theta_i);
    let r = longitudinal(theta_sum, theta_i, fiber.beta_r, variance) / TAU;
    let tt = longitudinal(theta_sum, theta_i, fiber.beta_tt, variance)
        * azimuthal_tt(cos_half_phi, fiber.gamma_tt);
    // 1 - F, which cancels at grazing angles.
    let rest = (DVec3::ONE - fiber.c_r) * schlick_rest(c);
    Lobes { r: fiber.fresnel(c) * r, tt: rest * fiber.c_tt * tt }
}

/// S, per steradian, of light from (theta_i, phi) toward (theta_o, 0).
pub fn bcsdf(theta_i: f64, theta_o: f64, phi: f64, fiber: &FiberScattering) -> Lobes {
    bcsdf_of_sum(theta_i + theta_o, theta_i, (0.5 * phi).cos().abs(), 0.0, fiber)
}

/// S cos(theta_i).
pub fn bcsdf_cos(theta_i: f64, theta_o: f64, phi: f64, fiber: &FiberScattering) -> Lobes {
    bcsdf(theta_i, theta_o, phi, fiber).scaled(cosine(theta_i))
}

/// S cos(theta_i) of unit directions away from a fiber with unit `tangent`; `variance` is that of
/// [`longitudinal`].
pub fn bcsdf_cos_of_directions(
    tangent: DVec3,
    to_light: DVec3,
    to_eye: DVec3,
    variance: f64,
    fiber: &FiberScattering,
) -> Lobes {
    let theta_i = longitudinal_angle(tangent, to_light);
    let theta_sum = theta_i + longitudinal_angle(tangent, to_eye);
    let (across_i, across_o) = (tangent.cross(to_light), tangent.cross(to_eye));
    let cos_half_phi = cos_half_angle(tangent, across_i, across_o);
    bcsdf_of_sum(theta_sum, theta_i, cos_half_phi, variance, fiber).scaled(across_i.length())
}

/// |cos| of half the angle between two vectors perpendicular to the unit `tangent`; one fixed perpendicular stands
/// for what has no direction.
fn cos_half_angle(tangent: DVec3, a: DVec3, b: DVec3) -> f64 {
    let some = any_perpendicular(tangent);
    (0.5 * (direction_or(a, some) + direction_or(b, some)).length()).min(1.0)
}

/// What a lobe of this width does to uniform light, toward `theta_o`: integrals over theta_i of M cos^2,
/// of (1 - cos theta_i)^5 M cos^2, and of the rest of the first, whose difference from the second would cancel
/// near the pole.
pub fn ambient_integrals(theta_o: f64, width: f64) -> [f64; 3] {
    let f = |theta_i: f64| {
        let c = cosine(theta_i);
        let all = longitudinal(theta_i + theta_o, theta_i, width, 0.0) * c * c;
        [all, all * schlick(c), all * schlick_rest(c)]
    };
    integrate(gaussian_range(-theta_o, width), PANELS, TOLERANCE, &f)
}

/// The integral of S cos(theta_i) over all directions of light, toward `theta_o` (Wu & Yuksel 2019, Eq. 8).
/// Above 1 where the model gives back more than comes from uniform light.
pub fn ambient_scattering(theta_o: f64, fiber: &FiberScattering) -> Lobes {
    let [all, grazing, _] = ambient_integrals(theta_o, fiber.beta_r);
    let [_, _, through] = ambient_integrals(theta_o, fiber.beta_tt);
    let rest = DVec3::ONE - fiber.c_r;
    Lobes { r: fiber.c_r * all + rest * grazing, tt: rest * fiber.c_tt * through }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
