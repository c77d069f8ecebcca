//! Wu & Yuksel 2019's simple shading; twin of `glsl/bsdf/simple.glsl`.

use crate::math::angle::{cos_half_azimuth, longitudinal_angle};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::PI;

/// E[max(0, n.l)] over the visible normals of one fiber or of many that a pixel holds. Normals lie in the
/// fiber's cross-section at azimuth phi, measured from `toward` (0) to `side` (pi/2); `normals` are the means of
/// sin phi, cos phi, sin 2 phi and cos 2 phi. Exact for a single normal: the clamped cosine's Fourier series to
/// the second harmonic is linear in the means, and the rest of it, which starts with the fourth, fades as it
/// does for normals spread like a wrapped Gaussian with the same mean resultant length.
pub fn filtered_cosine(normals: DVec4, side: DVec3, toward: DVec3, to_light: DVec3) -> f64 {
    let light = DVec2::new(to_light.dot(side), to_light.dot(toward));
    let l = light.try_normalize().unwrap_or(DVec2::Y);
    let l2 = DVec2::new(2.0 * l.x * l.y, l.y * l.y - l.x * l.x);
    let (first, second) = (DVec2::new(normals.x, normals.y), DVec2::new(normals.z, normals.w));
    let series = 1.0 / PI + 0.5 * first.dot(l) + 2.0 / (3.0 * PI) * second.dot(l2);
    let resultant = first.length();
    let c = first.try_normalize().unwrap_or(DVec2::Y).dot(l);
    let rest = c.max(0.0) - (1.0 / PI + 0.5 * c + 2.0 / (3.0 * PI) * (2.0 * c * c - 1.0));
    light.length() * (series + resultant.min(1.0).powi(16) * rest).max(0.0)
}

/// Diffuse reflection, k_d E[max(0, n.l)] / pi, of the normals that [`filtered_cosine`] speaks of.
pub fn simple_diffuse(strength: DVec3, normals: DVec4, side: DVec3, toward: DVec3, to_light: DVec3) -> DVec3 {
    strength * (filtered_cosine(normals, side, toward, to_light) / PI)
}

/// Variance of theta_h, radians squared, where tangents vary about their mean: `spread` is their variance along
/// `side`, along `toward`, and their covariance. To first order; the half vector is not normalised.
pub fn half_angle_variance(spread: DVec3, side: DVec3, toward: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    let h = 0.5 * (to_light + to_eye);
    let (x, y) = (h.dot(side), h.dot(toward));
    (x * x * spread.x + y * y * spread.y + 2.0 * x * y * spread.z).max(0.0)
}

/// Wu & Yuksel 2019, Eq. 5, without its colour: |cos(phi/2)| exp(-theta_h^2 / (2 beta^2)), averaged over a
/// normally distributed theta_h of the given mean and variance. `cos_half_phi` >= 0; radians.
pub fn simple_specular(cos_half_phi: f64, theta_h: f64, width: f64, variance: f64) -> f64 {
    let widened = width * width + variance;
    cos_half_phi * width / widened.sqrt() * (-0.5 * theta_h * theta_h / widened).exp()
}

/// The specular lobe for unit directions away from a fiber with unit `tangent`, times the cosine of
/// the light's angle to the fiber's cross-section.
pub fn simple_specular_cos(tangent: DVec3, to_light: DVec3, to_eye: DVec3, width: f64, variance: f64) -> f64 {
    let theta_h = 0.5 * (longitudinal_angle(tangent, to_light) + longitudinal_angle(tangent, to_eye));
    let cos_theta = tangent.cross(to_light).length();
    simple_specular(cos_half_azimuth(tangent, to_light, to_eye), theta_h, width, variance) * cos_theta
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::strip::strip_normals;

    #[test]
    fn specular_peaks_in_the_mirror_cone_and_fades_by_the_gaussian() {
        let at =
            |theta: f64, phi: f64| DVec3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), theta.sin());
        let width = 0.1;
        let peak = simple_specular_cos(DVec3::Z, at(0.3, 0.0), at(-0.3, 0.0), width, 0.0);
        assert!((peak - 0.3f64.cos()).abs() < 1e-12);
        let off = simple_specular_cos(DVec3::Z, at(0.3, 0.0), at(-0.1, 0.0), width, 0.0);
        assert!((off / peak - (-0.5f64).exp()).abs() < 1e-12);
        assert!(simple_specular_cos(DVec3::Z, at(0.3, 0.0), at(-0.3, PI), width, 0.0) < 1e-12);
    }

    #[test]
    fn a_spread_of_tangents_widens_the_lobe_as_averaging_does() {
        let (width, deviation, mean): (f64, f64, f64) = (0.12, 0.2, 0.15);
        let n = 4000;
        let mut sum = 0.0;
        let mut weights = 0.0;
        for i in 0..n {
            let x = -6.0 + 12.0 * (f64::from(i) + 0.5) / f64::from(n);
            let weight = (-0.5 * x * x).exp();
            sum += weight * simple_specular(0.8, mean + deviation * x, width, 0.0);
            weights += weight;
        }
        let filtered = simple_specular(0.8, mean, width, deviation * deviation);
        assert!((filtered - sum / weights).abs() < 1e-6, "{filtered} against {}", sum / weights);
        let spread = DVec3::new(0.04, 0.09, 0.01);
        let variance = half_angle_variance(spread, DVec3::X, DVec3::Y, DVec3::X, DVec3::Y);
        assert!((variance - (0.25 * 0.04 + 0.25 * 0.09 + 0.5 * 0.01)).abs() < 1e-15);
    }

    /// Means over the part of a round fiber's strip between two places across it.
    fn strip_means(low: f64, high: f64) -> DVec4 {
        let n = 2000;
        let mut sum = DVec4::ZERO;
        for i in 0..n {
            let x = low + (high - low) * (f64::from(i) + 0.5) / f64::from(n);
            sum += strip_normals(x);
        }
        sum / f64::from(n)
    }

    #[test]
    fn a_single_normal_is_exact_and_a_strip_is_within_three_percent_of_its_average() {
        for i in 0..64 {
            let angle = 2.0 * PI * f64::from(i) / 64.0;
            let light = 0.8 * DVec3::new(angle.sin(), angle.cos(), 0.0) + 0.6 * DVec3::Z;
            for x in [-1.0, -0.5, 0.0, 0.3, 0.9] {
                let normals = strip_normals(x);
                let exact = (x * light.x + normals.y * light.y).max(0.0);
                let found = filtered_cosine(normals, DVec3::X, DVec3::Y, light);
                assert!((found - exact).abs() < 1e-12, "at {x}, light {angle}: {found}, not {exact}");
            }
            for (low, high) in [(-1.0, 1.0), (-1.0, -0.2), (0.1, 0.7)] {
                let n = 2000;
                let average = (0..n)
                    .map(|k| {
                        let x = low + (high - low) * (f64::from(k) + 0.5) / f64::from(n);
                        (x * light.x + (1.0 - x * x).sqrt() * light.y).max(0.0)
                    })
                    .sum::<f64>()
                    / f64::from(n);
                let found = filtered_cosine(strip_means(low, high), DVec3::X, DVec3::Y, light);
                assert!((found - average).abs() < 0.03, "{low}..{high}, {angle}: {found}, not {average}");
            }
        }
    }

    #[test]
    fn diffuse_integrates_to_its_strength() {
        let n = 400;
        let facing = DVec4::new(0.0, 1.0, 0.0, 1.0);
        let mut sum = 0.0;
        for i in 0..n {
            let z = (f64::from(i) + 0.5) / f64::from(n);
            let l = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            sum += simple_diffuse(DVec3::ONE, facing, DVec3::X, DVec3::Z, l).x * 2.0 * PI / f64::from(n);
        }
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        assert_eq!(simple_diffuse(DVec3::ONE, facing, DVec3::X, DVec3::Z, -DVec3::Z), DVec3::ZERO);
    }
}
