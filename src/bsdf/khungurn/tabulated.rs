//! The same scattering read from tables, as the shader does: twin of `glsl/bsdf/khungurn.glsl`. The tables are
//! baked by `precompute::scattering_table`.

use super::{Lobes, cos_half_angle, gaussian, schlick, schlick_rest};
use crate::math::angle::angle_of;
use crate::math::special::{normal_cdf, normal_density};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Both tables have their entries closer together within about so many widths of where their functions bend.
const TABLE_SPACING: f64 = 2.0;

/// Entries of each lobe's table if nothing else is said: every value read is within 1e-3 of itself, and of its range,
/// at widths of 0.5 to 60 degrees. `measure tables` measures it.
pub const DEFAULT_ENTRIES: u32 = 128;

/// One lobe and its table.
#[derive(Clone, Copy, Debug)]
pub struct TabulatedLobe<'a> {
    /// Longitudinal width, radians.
    pub width: f64,
    /// Factors of the normaliser, at [`normaliser_position`], and of the three integrals over uniform light, at
    /// [`ambient_position`]; at least 2.
    pub table: &'a [[f32; 4]],
}

/// How one kind of fiber scatters light, and what is constant about it.
#[derive(Clone, Copy, Debug)]
pub struct Scattering<'a> {
    /// C_R.
    pub c_r: DVec3,
    /// C_TT.
    pub c_tt: DVec3,
    /// The reflection.
    pub r: TabulatedLobe<'a>,
    /// What goes through.
    pub tt: TabulatedLobe<'a>,
    /// gamma_TT^-2.
    pub k_tt: f64,
    /// 1 / (2 pi exp(-k) I0(k)), k = `k_tt`.
    pub n_tt: f64,
}

/// G(theta, width), but for a factor near 1 that the table holds: the integral of (cos theta - u)^2 times a
/// Gaussian in u, over u below cos theta.
pub fn gaussian_normaliser(cos_theta: f64, width: f64) -> f64 {
    let z = cos_theta / width;
    (cos_theta * cos_theta + width * width) * normal_cdf(z) + cos_theta * width * normal_density(z)
}

/// Where the normaliser's table holds this angle: 0 at the pole, where cos theta = 0, to 1.
pub fn normaliser_position(cos_theta: f64, width: f64) -> f64 {
    let spacing = TABLE_SPACING * width;
    cos_theta * (1.0 + spacing) / (cos_theta + spacing)
}

/// The cosine that [`normaliser_position`] puts at `position`.
pub fn normaliser_cosine(position: f64, width: f64) -> f64 {
    let spacing = TABLE_SPACING * width;
    (position * spacing / (1.0 + spacing - position)).min(1.0)
}

/// Where the ambient tables hold the direction at `x_o` = pi/2 - |theta_o| from the pole: 0 there, to 1. Entries
/// crowd at both ends, where the lobe reaches over the pole and where it reaches beyond the normal plane.
pub fn ambient_position(x_o: f64, width: f64) -> f64 {
    let spacing = TABLE_SPACING * width;
    let rest = (FRAC_PI_2 - x_o).max(0.0);
    let at_end = FRAC_PI_2 / (FRAC_PI_2 + spacing);
    ((x_o / (x_o + spacing) - 0.5 * rest / (rest + spacing)) / at_end + 0.5) / 1.5
}

/// The integral of (1 - cos theta_i)^5 M cos^2, but for a factor that the table holds: the tenth moment over 32 of
/// a Gaussian whose mean is the chord of theta_o. Its variance grows beyond the lobe's where the lobe is wide: the
/// integral is then nearly the same everywhere.
pub fn grazing_moment(cos_o: f64, width: f64) -> f64 {
    let y = 2.0 * (1.0 - cos_o).max(0.0);
    let v = width * width * (1.0 + 4.0 * width * width);
    let powers = [630.0 * v.powi(2), 3150.0 * v.powi(3), 4725.0 * v.powi(4), 945.0 * v.powi(5)];
    powers.iter().fold(y + 45.0 * v, |moment, term| moment * y + term) / 32.0
}

/// The integral of (1 - (1 - cos theta_i)^5) M cos^2, but for a factor that the table holds: its integrand at a
/// cosine that the width keeps from 0.
pub fn through_moment(cos_o: f64, width: f64) -> f64 {
    let w = 0.6 * width * width;
    let w = w / (1.0 + w);
    schlick_rest((cos_o * cos_o + w * (1.0 - cos_o * cos_o).max(0.0)).sqrt())
}

/// A table at a position, 0 to 1: linear between entries.
pub fn scattering_table_at(table: &[[f32; 4]], position: f64) -> [f64; 4] {
    let at = position.clamp(0.0, 1.0) * (table.len() - 1) as f64;
    let low = (at as usize).min(table.len() - 2);
    let share = at - low as f64;
    std::array::from_fn(|n| f64::from(table[low][n]) * (1.0 - share) + f64::from(table[low + 1][n]) * share)
}

/// M, per radian: [`super::longitudinal`] with G from the table.
pub fn longitudinal(theta_sum: f64, cos_i: f64, variance: f64, lobe: TabulatedLobe<'_>) -> f64 {
    let ratio = scattering_table_at(lobe.table, normaliser_position(cos_i, lobe.width))[0];
    let g = gaussian(theta_sum, (lobe.width * lobe.width + variance).sqrt());
    g / (gaussian_normaliser(cos_i, lobe.width) * ratio)
}

/// N_TT = exp(-k cos phi) / (2 pi I0(k)) in a form that does not overflow.
pub fn azimuthal_tt(cos_half_phi: f64, k: f64, n_tt: f64) -> f64 {
    n_tt * (-2.0 * k * cos_half_phi * cos_half_phi).exp()
}

/// S, per steradian, of theta_sum = theta_i + theta_o, cos theta_i and |cos(phi / 2)|.
pub fn bcsdf(theta_sum: f64, cos_i: f64, cos_half_phi: f64, variance: f64, s: &Scattering<'_>) -> Lobes {
    let rest = DVec3::ONE - s.c_r;
    let n_tt = azimuthal_tt(cos_half_phi, s.k_tt, s.n_tt);
    let through = schlick_rest(cos_i) * longitudinal(theta_sum, cos_i, variance, s.tt) * n_tt;
    Lobes {
        r: (s.c_r + rest * schlick(cos_i)) * (longitudinal(theta_sum, cos_i, variance, s.r) / TAU),
        tt: rest * s.c_tt * through,
    }
}

/// S cos(theta_i) of unit directions away from a fiber with unit `tangent`.
pub fn bcsdf_cos(tangent: DVec3, to_light: DVec3, to_eye: DVec3, variance: f64, s: &Scattering<'_>) -> Lobes {
    let (across_i, across_o) = (tangent.cross(to_light), tangent.cross(to_eye));
    let (cos_i, cos_o) = (across_i.length().min(1.0), across_o.length());
    let (sin_i, sin_o) = (tangent.dot(to_light), tangent.dot(to_eye));
    let theta_sum = angle_of(sin_i * cos_o + cos_i * sin_o, cos_i * cos_o - sin_i * sin_o);
    let cos_half_phi = cos_half_angle(tangent, across_i, across_o);
    bcsdf(theta_sum, cos_i, cos_half_phi, variance, s).scaled(cos_i)
}

/// [`super::ambient_integrals`] from the table; `x_o` = pi/2 - |theta_o| and its sine.
pub fn ambient_integrals(x_o: f64, cos_o: f64, lobe: TabulatedLobe<'_>) -> [f64; 3] {
    let [_, all, grazing, through] = scattering_table_at(lobe.table, ambient_position(x_o, lobe.width));
    [all, grazing * grazing_moment(cos_o, lobe.width), through * through_moment(cos_o, lobe.width)]
}

/// The integral of S cos(theta_i) over all directions of light (Wu & Yuksel 2019, Eq. 8).
pub fn ambient_scattering(tangent: DVec3, to_eye: DVec3, s: &Scattering<'_>) -> Lobes {
    let cos_o = tangent.cross(to_eye).length().min(1.0);
    let x_o = angle_of(cos_o, tangent.dot(to_eye).abs());
    let [all, grazing, _] = ambient_integrals(x_o, cos_o, s.r);
    let [_, _, through] = ambient_integrals(x_o, cos_o, s.tt);
    let rest = DVec3::ONE - s.c_r;
    Lobes { r: s.c_r * all + rest * grazing, tt: rest * s.c_tt * through }
}
