//! Random queries of probed functions, reproducible, all over what each is used for and often at its edges.

use crate::bsdf::params::NARROWEST_DEG;
use crate::math::rng::Rng;
use crate::probe::fields::WIDEST_LOBE_DEG;
use crate::yarn::density::extinction_per_mm;
use crate::yarn::params::YarnParams;
use crate::yarn::presets;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Narrowest and widest lobe, in degrees.
const WIDTHS_DEG: [f64; 2] = [NARROWEST_DEG, WIDEST_LOBE_DEG];

/// So many queries of a function; none where no yarn preset is at hand.
pub fn random(function: &str, count: usize) -> Vec<Value> {
    let mut random = Random::new(&[function.len() as u64, count as u64]);
    let yarns: Vec<YarnParams> = presets::yarn_names().filter_map(presets::yarn).collect();
    let yarns = yarns.iter().cycle();
    yarns.take(count).map(|yarn| random.query(function, yarn)).collect()
}

/// Random numbers as sweeps want them.
pub struct Random(Rng);

impl Random {
    /// The stream of that name.
    pub fn new(name: &[u64]) -> Self {
        Self(Rng::new(9, name))
    }

    /// Uniform.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    /// Uniform in the logarithm.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// A whole number.
    pub fn below(&mut self, count: u32) -> u32 {
        (self.0.uniform() * f64::from(count)) as u32
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.below(2) == 0 { 1.0 } else { -1.0 }
    }

    /// So many numbers within `size` of 0.
    pub fn numbers(&mut self, count: usize, size: f64) -> Vec<f64> {
        (0..count).map(|_| self.between(-size, size)).collect()
    }
    /// Half of them anywhere, half near a pole by any distance; some on it.
    fn theta(&mut self) -> f64 {
        let from_pole = match self.below(8) {
            0..4 => self.between(0.0, FRAC_PI_2),
            4 => 0.0,
            _ => self.magnitude(1e-6, FRAC_PI_2),
        };
        self.sign() * (FRAC_PI_2 - from_pole)
    }

    fn width(&mut self, widest_deg: f64) -> f64 {
        self.magnitude(WIDTHS_DEG[0], widest_deg).to_radians()
    }

    fn color(&mut self) -> Value {
        match self.below(8) {
            0 => json!(0),
            1 => json!(self.between(0.0, 1.0)),
            2 => json!([1, 1, 1]),
            _ => json!([self.between(0.0, 1.0), self.between(0.0, 1.0), self.between(0.0, 1.0)]),
        }
    }

    /// A query of a function; of a yarn's inside, of `preset`.
    pub fn query(&mut self, function: &str, preset: &YarnParams) -> Value {
        match function {
            "curve_point" => json!({"control_points": self.piece().0, "basis": self.basis(), "t": self.t()}),
            "fiber_point" => self.fiber_point(),
            "migration_radius" => {
                let low = self.between(0.0, 1.0);
                json!({"twist_angle": self.sign() * self.magnitude(1e-3, 1e9), "radius": self.between(0.0, 1.0),
                    "migration_phase": self.between(0.0, TAU), "migration_rate": self.between(0.0, 100.0),
                    "migration_min": low, "migration_max": self.between(low, 1.5)})
            }
            "lod_factor" => {
                let lod = self.magnitude(0.05, 20.0);
                let fiber = lod * self.magnitude(1e-3, 3.0);
                json!({"width_lod": lod, "width_fiber": fiber, "width_ply": fiber * self.between(1.0, 50.0)})
            }
            "fiber_density" => {
                let radius =
                    if self.below(2) == 0 { self.between(0.0, 1.0) } else { 1.0 - self.magnitude(1e-7, 1.0) };
                json!({"radius": radius, "beta": self.between(0.0, 20.0) * self.between(0.0, 1.0), "epsilon": self.between(0.0, 0.5)})
            }
            "self_shadow_depth" | "ambient_occlusion" => self.inside(preset),
            "simple_specular" => {
                let width = self.width(90.0);
                let theta_h = (width * self.between(-6.0, 6.0)).clamp(-FRAC_PI_2, FRAC_PI_2);
                json!({"strength": self.magnitude(1e-3, 1e3), "theta_h": theta_h, "phi": self.between(-TAU, TAU), "width": width})
            }
            "longitudinal_normaliser" => json!({"theta": self.theta(), "width": self.width(WIDTHS_DEG[1])}),
            "azimuthal_tt" => {
                let width = self.width(WIDTHS_DEG[1]);
                json!({"phi": self.phi(width), "width": width})
            }
            "tone_neutral" | "tone_filmic" => {
                let most = self.magnitude(1e-6, 1e6);
                json!({"radiance": [self.between(0.0, most), self.between(0.0, most), self.between(0.0, most)]})
            }
            "srgb_from_linear" => json!({"linear": self.magnitude(1e-7, 1.0)}),
            _ => self.scattering(),
        }
    }

    fn basis(&mut self) -> &'static str {
        if self.below(2) == 0 { "catmull_rom" } else { "bezier" }
    }

    fn t(&mut self) -> f64 {
        match self.below(8) {
            0 => 0.0,
            1 => 1.0,
            _ => self.between(0.0, 1.0),
        }
    }

    /// Control points of any size, at up to a thousand times that from the origin, and the size.
    fn piece(&mut self) -> (Vec<Vec<f64>>, f64) {
        let size = self.magnitude(1e-6, 1e3);
        let reach = size * self.magnitude(1e-2, 1e3);
        let at = self.numbers(3, reach);
        let points =
            (0..4).map(|_| self.numbers(3, size).iter().zip(&at).map(|(p, a)| p + a).collect()).collect();
        (points, size)
    }

    fn fiber_point(&mut self) -> Value {
        let (points, size) = self.piece();
        let (size, plies) = (size.max(1e-3), 1 + self.below(8));
        let pitch = |random: &mut Self| match random.below(8) {
            0 => Value::Null,
            _ => json!(random.sign() * (size * random.magnitude(0.2, 100.0)).max(1.01e-3)),
        };
        let start = size * self.magnitude(1.0, 1e5);
        let low = self.between(0.0, 1.0);
        let yarn = json!({"ply_count": plies, "yarn_radius": size * self.between(0.0, 1.0), "ply_pitch": pitch(self),
            "fiber_pitch": pitch(self), "ellipse_short": size * self.magnitude(0.01, 1.0),
            "ellipse_long": size * self.magnitude(0.01, 1.0), "migration_min": low,
            "migration_max": self.between(low, 1.5), "migration_rate": self.between(0.0, 3.0)});
        let fiber = json!({"ply": self.below(plies), "radius": self.between(0.0, 1.0), "angle": self.between(0.0, TAU),
            "migration_phase": self.between(0.0, TAU)});
        json!({"control_points": points, "basis": self.basis(), "t": self.t(), "length_start": start,
            "length_end": start + size * self.between(0.0, 2.0), "normal_reference": self.numbers(3, 1.0),
            "yarn": yarn, "fiber": fiber})
    }

    /// A place within a yarn's outer circle and a direction, of a preset in a unit of its own.
    fn inside(&mut self, preset: &YarnParams) -> Value {
        let unit = preset.outer_radius_mm();
        let (radius, angle) = (unit * self.between(0.0, 1.0).sqrt(), self.between(0.0, TAU));
        let yarn = json!({"ply_count": preset.ply_count, "ply_offset": preset.ply_offset_mm(),
            "ellipse_short": preset.ellipse_short_mm, "ellipse_long": preset.ellipse_long_mm,
            "beta": preset.density_beta, "epsilon": preset.density_epsilon});
        json!({"yarn": yarn, "position": [radius * angle.cos(), radius * angle.sin()],
            "light_angle": self.between(-PI, TAU), "extinction": extinction_per_mm(preset)})
    }

    /// Mostly within a few widths of forward.
    fn phi(&mut self, width: f64) -> f64 {
        match self.below(3) {
            0 => self.between(-TAU, TAU),
            _ => PI + width * self.between(-5.0, 5.0),
        }
    }

    fn scattering(&mut self) -> Value {
        let [r, tt, gamma] = [WIDTHS_DEG[1]; 3].map(|widest| self.width(widest));
        let theta_i = self.theta();
        let theta_o = match self.below(4) {
            0 => self.theta(),
            _ => (r.max(tt) * self.between(-5.0, 5.0) - theta_i).clamp(-FRAC_PI_2, FRAC_PI_2),
        };
        let fiber =
            json!({"c_r": self.color(), "beta_r": r, "c_tt": self.color(), "beta_tt": tt, "gamma_tt": gamma});
        json!({"theta_i": theta_i, "theta_o": theta_o, "phi": self.phi(gamma), "fiber": fiber})
    }
}
