//! Wu & Yuksel 2019's simple shading; twin of `glsl/bsdf/simple.glsl`.

use crate::math::angle::{cos_half_azimuth, longitudinal_angle};
use glam::DVec3;
use std::f64::consts::PI;

/// Diffuse reflection of a round fiber with unit normal `normal`: k_d max(0, n.l) / pi.
pub fn simple_diffuse(strength: DVec3, normal: DVec3, to_light: DVec3) -> DVec3 {
    strength * (normal.dot(to_light).max(0.0) / PI)
}

/// Wu & Yuksel 2019, Eq. 5, without its colour: |cos(phi/2)| exp(-theta_h^2 / (2 beta^2)).
/// `cos_half_phi` >= 0; `theta_h` and `width` in radians.
pub fn simple_specular(cos_half_phi: f64, theta_h: f64, width: f64) -> f64 {
    let x = theta_h / width;
    cos_half_phi * (-0.5 * x * x).exp()
}

/// The specular lobe for unit directions away from a fiber with unit `tangent`, times the cosine of
/// the light's angle to the fiber's cross-section.
pub fn simple_specular_cos(tangent: DVec3, to_light: DVec3, to_eye: DVec3, width: f64) -> f64 {
    let theta_h = 0.5 * (longitudinal_angle(tangent, to_light) + longitudinal_angle(tangent, to_eye));
    let cos_theta = tangent.cross(to_light).length();
    simple_specular(cos_half_azimuth(tangent, to_light, to_eye), theta_h, width) * cos_theta
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specular_peaks_in_the_mirror_cone_and_fades_by_the_gaussian() {
        let at =
            |theta: f64, phi: f64| DVec3::new(theta.cos() * phi.cos(), theta.cos() * phi.sin(), theta.sin());
        let width = 0.1;
        let peak = simple_specular_cos(DVec3::Z, at(0.3, 0.0), at(-0.3, 0.0), width);
        assert!((peak - 0.3f64.cos()).abs() < 1e-12);
        let off = simple_specular_cos(DVec3::Z, at(0.3, 0.0), at(-0.1, 0.0), width);
        assert!((off / peak - (-0.5f64).exp()).abs() < 1e-12);
        assert!(simple_specular_cos(DVec3::Z, at(0.3, 0.0), at(-0.3, PI), width) < 1e-12);
    }

    #[test]
    fn diffuse_integrates_to_its_strength() {
        let n = 400;
        let mut sum = 0.0;
        for i in 0..n {
            let z = (f64::from(i) + 0.5) / f64::from(n);
            let l = DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
            sum += simple_diffuse(DVec3::ONE, DVec3::Z, l).x * 2.0 * PI / f64::from(n);
        }
        assert!((sum - 1.0).abs() < 1e-6);
        assert_eq!(simple_diffuse(DVec3::ONE, DVec3::Z, -DVec3::Z), DVec3::ZERO);
    }
}
