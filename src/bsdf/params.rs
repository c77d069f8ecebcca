//! What makes a fiber look as it does: the parameters of both shading models.

use super::khungurn::FiberScattering;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Narrowest lobe that a scene may state, in degrees.
pub const NARROWEST_DEG: f64 = 0.5;
/// Widest lobe of the physical model, in degrees: what its tables are tested for.
pub const WIDEST_DEG: f64 = 60.0;
/// A cloth is no infinitely deep medium: share of that one's albedo that its diffuse reflection has. Chosen.
const DEPTH_SHARE: f64 = 0.85;

/// Halvings of the search for a dye: to the last digit.
const DYE_STEPS: u32 = 52;

/// A fiber's look. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FiberParams {
    /// C_R: share of light reflected by the fiber's surface at right angles, in [0, 1] (Khungurn et al. 2017).
    pub c_r: [f64; 3],
    /// C_TT: share of what enters the fiber that leaves it again, in [0, 1].
    pub c_tt: [f64; 3],
    /// beta_R: longitudinal width of the reflected lobe, 0.5 to 60 degrees.
    pub beta_r_deg: f64,
    /// beta_TT: longitudinal width of the transmitted lobe, 0.5 to 60 degrees.
    pub beta_tt_deg: f64,
    /// gamma_TT: azimuthal width of the transmitted lobe, 0.5 to 60 degrees.
    pub gamma_tt_deg: f64,
    /// k_d: diffuse albedo in [0, 1], of both models; [`FiberParams::diffuse`] says what it is when absent.
    pub diffuse: Option<[f64; 3]>,
    /// k_s of the simple model, at least 0; follows from the reflected lobe when absent.
    pub specular: Option<[f64; 3]>,
    /// beta of the simple model, 0.5 to 90 degrees; follows from the reflected lobe when absent.
    pub specular_width_deg: Option<f64>,
}

impl FiberParams {
    /// The physical model's lobes.
    pub fn scattering(&self) -> FiberScattering {
        FiberScattering {
            c_r: DVec3::from_array(self.c_r),
            c_tt: DVec3::from_array(self.c_tt),
            beta_r: self.beta_r_deg.to_radians(),
            beta_tt: self.beta_tt_deg.to_radians(),
            gamma_tt: self.gamma_tt_deg.to_radians(),
        }
    }

    /// k_d: stands for light that fibers hand on to one another, which neither model follows. When it is not
    /// stated it is 0.85 times what an infinitely deep medium of such fibers reflects: the albedo s of one
    /// scattering and its mean cosine g give (1 - s')(1 - 0.139 s') / (1 + 1.17 s'), s'^2 = (1 - s) / (1 - g s)
    /// (van de Hulst 1980, the similarity relation). So the dye of the fibers is the dye of the cloth.
    pub fn diffuse(&self) -> [f64; 3] {
        self.diffuse.unwrap_or_else(|| {
            std::array::from_fn(|c| {
                DEPTH_SHARE * deep_albedo(self.c_r[c], self.c_tt[c], self.forward_share())
            })
        })
    }

    /// The same fiber dyed so that [`FiberParams::diffuse`] is `color`, as nearly as C_TT from 0 to 1 can make it.
    pub fn dyed(&self, color: [f64; 3]) -> Self {
        let forward = self.forward_share();
        let c_tt = std::array::from_fn(|c| {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..DYE_STEPS {
                let middle = 0.5 * (low + high);
                let rises = DEPTH_SHARE * deep_albedo(self.c_r[c], middle, forward) < color[c];
                if rises { low = middle } else { high = middle }
            }
            0.5 * (low + high)
        });
        Self { c_tt, diffuse: None, ..self.clone() }
    }

    /// Mean cosine between the ways into and out of a fiber of transmitted light, over directions of equal
    /// likelihood: the azimuth's mean cosine from the variance of its lobe, with cos^2(theta) 2/3 on average.
    fn forward_share(&self) -> f64 {
        let (beta, gamma) = (self.beta_tt_deg.to_radians(), self.gamma_tt_deg.to_radians());
        let azimuth = (-0.5 * gamma * gamma).exp();
        (2.0 * azimuth + 1.0) / 3.0 * (-0.5 * beta * beta).exp()
    }

    /// k_s. When it is not stated the simple lobe sends as much light around the fiber, at normal incidence, as
    /// the reflected lobe does: C_R / (4 sqrt(2 pi) beta_R), as |cos(phi/2)| integrates to 4.
    pub fn specular(&self) -> [f64; 3] {
        let peak = 1.0 / (4.0 * TAU.sqrt() * self.beta_r_deg.to_radians());
        self.specular.unwrap_or(self.c_r.map(|c_r| c_r * peak))
    }

    /// beta in radians. When it is not stated it is half of beta_R: one is of theta_h, half the sum of the
    /// angles whose Gaussian the other is of.
    pub fn specular_width(&self) -> f64 {
        self.specular_width_deg.unwrap_or((0.5 * self.beta_r_deg).max(NARROWEST_DEG)).to_radians()
    }
}

/// Albedo of an infinitely deep medium of fibers that reflect `c_r` and let through `c_tt` of the rest with mean
/// cosine `forward`. Reflected light goes equally to all azimuths: its mean cosine is that of sin^2(theta), 1/3.
fn deep_albedo(c_r: f64, c_tt: f64, forward: f64) -> f64 {
    let through = (1.0 - c_r) * c_tt;
    let once = (c_r + through).min(1.0);
    if once <= 0.0 {
        return 0.0;
    }
    let g = (c_r / 3.0 + through * forward) / once;
    let similar = ((1.0 - once) / (1.0 - g * once)).max(0.0).sqrt();
    (1.0 - similar) * (1.0 - 0.139 * similar) / (1.0 + 1.17 * similar)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::presets;
    use crate::bsdf::simple::simple_specular;
    use crate::math::quadrature::gauss_legendre;
    use std::f64::consts::PI;

    fn wool() -> FiberParams {
        presets::fiber(presets::DEFAULT_FIBER).unwrap()
    }

    #[test]
    fn the_deep_medium_is_black_or_white_with_its_fibers_and_rises_between() {
        assert_eq!(deep_albedo(0.0, 0.0, 0.8), 0.0);
        assert!((deep_albedo(0.3, 1.0, 0.8) - 1.0).abs() < 1e-12);
        // Isotropic scattering of albedo 0.5: 0.1464 by Chandrasekhar's H functions (van de Hulst's fit errs by 0.002).
        assert!((deep_albedo(0.0, 0.5, 0.0) - 0.147).abs() < 0.003);
        let albedos: Vec<f64> = (0..=50).map(|i| deep_albedo(0.05, f64::from(i) / 50.0, 0.85)).collect();
        assert!(albedos.windows(2).all(|pair| pair[0] < pair[1]), "{albedos:?}");
    }

    #[test]
    fn what_is_stated_is_taken_and_what_is_not_follows() {
        let mut fiber = wool();
        let [r, g, b] = fiber.diffuse();
        assert!(r > g && g > b && b > 0.2, "cream: {r} {g} {b}");
        fiber.diffuse = Some([0.1, 0.2, 0.3]);
        fiber.specular = Some([0.5; 3]);
        fiber.specular_width_deg = Some(9.0);
        assert_eq!((fiber.diffuse(), fiber.specular()), ([0.1, 0.2, 0.3], [0.5; 3]));
        assert!((fiber.specular_width() - 9f64.to_radians()).abs() < 1e-15);
    }

    #[test]
    fn a_dyed_fiber_makes_cloth_of_that_color_where_any_dye_can() {
        let dyed = wool().dyed([0.42, 0.1, 0.05]);
        for (found, wanted) in dyed.diffuse().into_iter().zip([0.42, 0.1, 0.05]) {
            assert!((found - wanted).abs() < 1e-9, "{found}, not {wanted}");
        }
        let [black, white, _] = wool().dyed([0.0, 1.0, 0.5]).c_tt;
        assert!(black < 1e-9 && white > 1.0 - 1e-9, "{black} {white}");
    }

    #[test]
    fn the_simple_lobe_sends_as_much_light_as_the_reflected_one() {
        let fiber = wool();
        // Over theta_o and phi for theta_i = 0; the reflected lobe's share is C_R at right angles.
        let around = |theta: f64| {
            gauss_legendre(-PI, PI, |phi| {
                simple_specular((0.5 * phi).cos(), 0.5 * theta, fiber.specular_width(), 0.0)
            })
        };
        let steps = 200;
        let size = PI / f64::from(steps);
        let all =
            (0..steps).map(|i| (f64::from(i) + 0.5) * size - 0.5 * PI).map(|t| size * around(t)).sum::<f64>();
        assert!((fiber.specular()[0] * all - 0.05).abs() < 1e-4, "{}", fiber.specular()[0] * all);
    }
}
