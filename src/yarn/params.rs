//! What describes a yarn's inside: Wu & Yuksel 2019, Sec. 3.1, and Zhao et al. 2016.

use serde::{Deserialize, Serialize};

/// Parameters of a plied yarn. Lengths in mm; clockwise turns are negative about the yarn's direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct YarnParams {
    /// Plies twisted around each other, 1 to 8.
    pub ply_count: u32,
    /// Fibers in each ply, 1 to 2000.
    pub fibers_per_ply: u32,
    /// Twice the distance of a ply's centre from the yarn's: *not* the yarn's outer radius.
    pub yarn_radius_mm: f64,
    /// Yarn length over which the plies turn once; untwisted when absent.
    pub ply_pitch_mm: Option<f64>,
    /// Whether the plies turn clockwise.
    pub ply_clockwise: bool,
    /// Yarn length over which a fiber turns once inside its ply's rotating frame; untwisted when absent.
    pub fiber_pitch_mm: Option<f64>,
    /// Whether the fibers turn clockwise.
    pub fiber_clockwise: bool,
    /// Half-axis of a ply's elliptical cross-section toward the yarn's centre, e_N.
    pub ellipse_short_mm: f64,
    /// Half-axis around the yarn's centre, e_B.
    pub ellipse_long_mm: f64,
    /// Exponent of the fiber density, beta >= 0 (Zhao et al. 2016).
    pub density_beta: f64,
    /// Floor of the fiber density, epsilon in [0, 0.5].
    pub density_epsilon: f64,
    /// Smallest share of its radius a migrating fiber keeps, R_min in [0, 1].
    pub migration_min: f64,
    /// Largest share, R_max in [R_min, 1.5].
    pub migration_max: f64,
    /// Migration cycles per turn of the fiber, s >= 0.
    pub migration_rate: f64,
    /// Diameter of one fiber in micrometres.
    pub fiber_diameter_um: f64,
}

/// A parameter outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("yarn.{key} = {value}: allowed is {allowed}")]
pub struct ParamError {
    /// The parameter's key in a scene or preset file.
    pub key: &'static str,
    /// What was given.
    pub value: f64,
    /// The allowed range, in words.
    pub allowed: &'static str,
}

impl YarnParams {
    /// Distance of a ply's centre from the yarn's: half of `yarn_radius_mm`.
    pub fn ply_offset_mm(&self) -> f64 {
        0.5 * self.yarn_radius_mm
    }

    /// Radius of one fiber in mm.
    pub fn fiber_radius_mm(&self) -> f64 {
        0.5e-3 * self.fiber_diameter_um
    }

    /// Fibers of all plies together.
    pub fn fiber_count(&self) -> u32 {
        self.ply_count * self.fibers_per_ply
    }

    /// Radius of the circle around all plies: the largest hypot(offset + e_N cos t, e_B sin t), with
    /// the fibers' migration beyond the ellipse. 1.03 to 1.31 times `yarn_radius_mm` for real yarns.
    pub fn outer_radius_mm(&self) -> f64 {
        let offset = self.ply_offset_mm();
        let (short, long) = (self.ellipse_short_mm, self.ellipse_long_mm);
        let squared = |cos_t: f64| (offset + short * cos_t).powi(2) + long * long * (1.0 - cos_t * cos_t);
        // d/dcos = 0 gives the only interior extremum; it is a maximum where the ellipse is wide.
        let flat = long * long - short * short;
        let inner = if flat > 0.0 { (offset * short / flat).clamp(-1.0, 1.0) } else { 1.0 };
        squared(inner).max(squared(1.0)).sqrt() * self.migration_max.max(1.0)
    }

    /// Signed turns of the plies per mm of yarn; 0 when untwisted.
    pub fn ply_turns_per_mm(&self) -> f64 {
        turns_per_mm(self.ply_pitch_mm, self.ply_clockwise)
    }

    /// Signed turns of a fiber in its ply's frame per mm of yarn; 0 when untwisted.
    pub fn fiber_turns_per_mm(&self) -> f64 {
        turns_per_mm(self.fiber_pitch_mm, self.fiber_clockwise)
    }

    /// Checks every parameter against its range.
    ///
    /// # Errors
    /// The first parameter outside its range, with the range.
    pub fn validate(&self) -> Result<(), ParamError> {
        let positive = "a positive number of mm, at most 1e6";
        let length = |v: f64| v > 0.0 && v <= 1e6;
        let pitch = |p: Option<f64>| p.is_none_or(|v| (1e-3..=1e9).contains(&v));
        let pitches = "1e-3 to 1e9 mm, or absent for untwisted";
        let checks: [(&'static str, f64, bool, &'static str); 14] = [
            ("ply_count", f64::from(self.ply_count), (1..=8).contains(&self.ply_count), "1 to 8"),
            (
                "fibers_per_ply",
                f64::from(self.fibers_per_ply),
                (1..=2000).contains(&self.fibers_per_ply),
                "1 to 2000",
            ),
            (
                "yarn_radius_mm",
                self.yarn_radius_mm,
                (0.0..=1e6).contains(&self.yarn_radius_mm),
                "0 to 1e6 mm",
            ),
            ("ply_pitch_mm", self.ply_pitch_mm.unwrap_or(0.0), pitch(self.ply_pitch_mm), pitches),
            ("fiber_pitch_mm", self.fiber_pitch_mm.unwrap_or(0.0), pitch(self.fiber_pitch_mm), pitches),
            ("ellipse_short_mm", self.ellipse_short_mm, length(self.ellipse_short_mm), positive),
            ("ellipse_long_mm", self.ellipse_long_mm, length(self.ellipse_long_mm), positive),
            ("density_beta", self.density_beta, (0.0..=20.0).contains(&self.density_beta), "0 to 20"),
            (
                "density_epsilon",
                self.density_epsilon,
                (0.0..=0.5).contains(&self.density_epsilon),
                "0 to 0.5",
            ),
            ("migration_min", self.migration_min, (0.0..=1.0).contains(&self.migration_min), "0 to 1"),
            (
                "migration_max",
                self.migration_max,
                (self.migration_min..=1.5).contains(&self.migration_max),
                "migration_min to 1.5",
            ),
            ("migration_rate", self.migration_rate, (0.0..=100.0).contains(&self.migration_rate), "0 to 100"),
            (
                "fiber_diameter_um",
                self.fiber_diameter_um,
                self.fiber_diameter_um > 0.0 && self.fiber_diameter_um <= 1e6,
                "a positive number of micrometres, at most 1e6",
            ),
            (
                "fibers_per_ply",
                f64::from(self.fiber_count()),
                self.fiber_count() <= 16_000,
                "at most 16000 fibers in all plies",
            ),
        ];
        match checks.into_iter().find(|(_, _, good, _)| !good) {
            None => Ok(()),
            Some((key, value, _, allowed)) => Err(ParamError { key, value, allowed }),
        }
    }
}

fn turns_per_mm(pitch_mm: Option<f64>, clockwise: bool) -> f64 {
    let turns = pitch_mm.map_or(0.0, |pitch| 1.0 / pitch);
    if clockwise { -turns } else { turns }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::presets;

    #[test]
    fn outer_radius_is_the_farthest_point_of_the_ellipse() {
        let mut yarn = presets::yarn("worsted_3ply").unwrap();
        yarn.migration_max = 1.0;
        for (short, long) in [(0.2, 0.25), (0.3, 0.3), (0.1, 1.0), (0.4, 0.2)] {
            yarn.ellipse_short_mm = short;
            yarn.ellipse_long_mm = long;
            let farthest = (0..100_000)
                .map(|i| {
                    let (s, c) = (f64::from(i) * std::f64::consts::TAU / 100_000.0).sin_cos();
                    (yarn.ply_offset_mm() + short * c).hypot(long * s)
                })
                .fold(0.0, f64::max);
            let outer = yarn.outer_radius_mm();
            assert!((outer - farthest).abs() < 1e-8, "{short} {long}: {outer} vs {farthest}");
        }
    }

    #[test]
    fn validation_names_the_key_and_rejects_nan() {
        let good = presets::yarn("worsted_3ply").unwrap();
        assert_eq!(good.validate(), Ok(()));
        let bad = YarnParams { density_beta: -1.0, ..good.clone() };
        assert_eq!(bad.validate().unwrap_err().to_string(), "yarn.density_beta = -1: allowed is 0 to 20");
        let bad = YarnParams { yarn_radius_mm: f64::NAN, ..good.clone() };
        assert_eq!(bad.validate().unwrap_err().key, "yarn_radius_mm");
        let bad = YarnParams { ply_count: 0, ..good };
        assert_eq!(bad.validate().unwrap_err().key, "ply_count");
    }
}
