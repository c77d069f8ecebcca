//! What describes a yarn's inside: Wu & Yuksel 2019, Sec. 3.1, and Zhao et al. 2016. What each parameter
//! may be stands once, in [`super::ranges::PARAMETERS`].

use super::ranges::{PARAMETERS, ParamError};
use glam::{DVec2, Vec2Swizzles};
use serde::{Deserialize, Serialize};
use toml::Table;

/// Most fibers in all plies of a yarn.
pub const MAX_FIBERS: u32 = 16_000;

/// Most times that a yarn's outer radius may be the shorter half-axis of its plies: f32 has no place for thinner ones in
/// the yarn's cross-section.
pub const MOST_THIN: f64 = 1000.0;

/// Most times as long as wide that a ply's ellipse is outside of the ply: the flattest of the fitted yarns is 1.49.
pub const MOST_FLAT: f64 = 1.5;

/// A normal distribution; `[mean, deviation]` in files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation, at least 0. As published for the fits: the generator of Zhao et al. draws with
    /// 0.75 of it for hairs and 0.5 of it for loops.
    pub deviation: f64,
}

impl From<[f64; 2]> for Spread {
    fn from([mean, deviation]: [f64; 2]) -> Self {
        Self { mean, deviation }
    }
}

impl From<Spread> for [f64; 2] {
    fn from(spread: Spread) -> Self {
        [spread.mean, spread.deviation]
    }
}

/// Parameters of a plied yarn. Lengths in mm; clockwise turns are negative about the yarn's direction.
///
/// Fly-aways (loops and hairs) are stated in the *round* ply: distances r from the ply's centre in mm, before
/// the cross-section is pressed to its ellipse, so that R = r / [`Self::round_ply_radius_mm`], and angles in
/// the frame that turns with the ply but not with its fibers. Zhao et al.'s generator makes them in that
/// space, then presses and turns them with the ply. Plies flatter than any that was measured are pressed so only up
/// to their surface: [`YarnParams::beyond_mm`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct YarnParams {
    /// Plies twisted around each other, n_ply. A single ply has nothing to turn around: where neither its
    /// preset nor the scene says otherwise, it lies on the yarn's centre line (`yarn_radius_mm` = 0).
    pub ply_count: u32,
    /// Fibers in each ply.
    pub fibers_per_ply: u32,
    /// Twice the distance of a ply's centre from the yarn's: *not* the yarn's outer radius.
    pub yarn_radius_mm: f64,
    /// alpha_ply: yarn length over which the plies turn once; untwisted when absent.
    pub ply_pitch_mm: Option<f64>,
    /// Whether the plies turn clockwise.
    pub ply_clockwise: bool,
    /// alpha: yarn length over which a fiber turns once inside its ply's rotating frame; untwisted when
    /// absent.
    pub fiber_pitch_mm: Option<f64>,
    /// Whether the fibers turn clockwise.
    pub fiber_clockwise: bool,
    /// e_N: half-axis of a ply's elliptical cross-section toward the yarn's centre.
    pub ellipse_short_mm: f64,
    /// e_B: half-axis around the yarn's centre.
    pub ellipse_long_mm: f64,
    /// beta: exponent of the fiber density (Zhao et al. 2016).
    pub density_beta: f64,
    /// epsilon: floor of the fiber density.
    pub density_epsilon: f64,
    /// R_min: smallest share of its radius a migrating fiber keeps.
    pub migration_min: f64,
    /// R_max: largest share, at least `migration_min`.
    pub migration_max: f64,
    /// s: migration cycles per turn of the fiber.
    pub migration_rate: f64,
    /// Diameter of one fiber in micrometres.
    pub fiber_diameter_um: f64,
    /// Loops per mm of yarn and ply: fibers pulled out over one period of their radius.
    pub loop_density_per_mm: f64,
    /// r_1: farthest distance of a loop from the ply's centre, whatever fiber it is made of. Where that is
    /// nearer than the fiber would lie anyway, it is drawn anew.
    pub loop_radius_mm: Spread,
    /// Hairs per mm of yarn and ply: fibers with an open end. A hair is a straight line in (r, z, angle).
    pub hair_density_per_mm: f64,
    /// z_e: how far a hair runs along the yarn from where it leaves the ply to its tip. The fits' means are
    /// near 0, of either sign, as hairs run both ways: the direction is drawn apart, and the length anew
    /// where it is not positive. Mean + deviation must be positive, so that drawing ends.
    pub hair_length_mm: Spread,
    /// r_0: distance from the ply's centre where a hair leaves the ply. The generator extends the line
    /// inward from there to the centre, where the ply hides it.
    pub hair_radius_start_mm: Spread,
    /// r_e: how much farther out its tip is than its start; an increment, not the tip's distance. Drawn anew
    /// where negative.
    pub hair_radius_gain_mm: Spread,
    /// p_e: how far a hair turns around its ply from start to tip, counter-clockwise positive; either sign.
    /// The start's own angle is uniform.
    pub hair_angle_rad: Spread,
    /// alpha_hair (Wu & Yuksel 2019, Sec. 3.1): length over which a hair turns once around its ply, in the
    /// fibers' sense; when present it takes the place of `hair_angle_rad`.
    pub hair_pitch_mm: Option<f64>,
    /// Share of a hair's length, up to its tip, over which its thickness falls to a point.
    pub hair_taper: f64,
}

impl YarnParams {
    /// Distance of a ply's centre from the yarn's: half of `yarn_radius_mm`.
    pub fn ply_offset_mm(&self) -> f64 {
        0.5 * self.yarn_radius_mm
    }

    /// Radius of the circle with the area of the ply's ellipse: what fly-aways' distances are shares of.
    pub fn round_ply_radius_mm(&self) -> f64 {
        (self.ellipse_short_mm * self.ellipse_long_mm).sqrt()
    }

    /// R of the ply's surface: fibers that only migrate lie within.
    pub fn surface_radius(&self) -> f64 {
        self.migration_max.max(1.0)
    }

    /// Half-axes in mm, short then long, by which a unit of R moves a fiber outside of its ply's surface: the ellipse's
    /// own, up to [`MOST_FLAT`]. What stands out of a flatter ply does so by as much as of one that flat of the same
    /// area, on all sides: a hair's length is its own.
    pub fn beyond_mm(&self) -> DVec2 {
        let axes = DVec2::new(self.ellipse_short_mm, self.ellipse_long_mm);
        let (low, high) = (axes.min_element(), axes.max_element());
        if high <= MOST_FLAT * low {
            return axes;
        }
        let flat = DVec2::new(1.0 / MOST_FLAT.sqrt(), MOST_FLAT.sqrt()) * self.round_ply_radius_mm();
        if axes.x < axes.y { flat } else { flat.yx() }
    }

    /// The shorter half-axis of a ply: its key, and the axis in mm.
    pub fn thinnest(&self) -> (&'static str, f64) {
        let (short, long) = (self.ellipse_short_mm, self.ellipse_long_mm);
        if long < short { ("ellipse_long_mm", long) } else { ("ellipse_short_mm", short) }
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
    /// the fibers' migration beyond the ellipse; fly-aways reach farther. 1.03 to 1.31 times
    /// `yarn_radius_mm` for real yarns.
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

    /// Checks every parameter against its range, then those that depend on each other.
    ///
    /// # Errors
    /// The first parameter that cannot be, with what is allowed.
    pub fn validate(&self) -> Result<(), ParamError> {
        let table = Table::try_from(self).expect("plain numbers and flags are TOML");
        for parameter in PARAMETERS {
            // A pitch that is absent is an untwisted one.
            if let Some(value) = table.get(parameter.key) {
                parameter.check(value)?;
            }
        }
        let wrong = |key, found: String, rule: String| Err(ParamError { key, found, rule });
        if self.fiber_count() > MAX_FIBERS {
            let rule = format!("allowed is at most {MAX_FIBERS} fibers in all {} plies", self.ply_count);
            return wrong("fibers_per_ply", self.fibers_per_ply.to_string(), rule);
        }
        if self.migration_max < self.migration_min {
            let rule = format!("allowed is at least migration_min = {}", self.migration_min);
            return wrong("migration_max", self.migration_max.to_string(), rule);
        }
        let ((key, thinnest), outer) = (self.thinnest(), self.outer_radius_mm());
        if thinnest * MOST_THIN < outer {
            let rule = format!("allowed is at least 1/{MOST_THIN} of the yarn's outer radius, {outer} mm");
            return wrong(key, thinnest.to_string(), rule);
        }
        let Spread { mean, deviation } = self.hair_length_mm;
        if self.hair_density_per_mm > 0.0 && mean + deviation <= 0.0 {
            let rule = "allowed is a mean + deviation above 0 mm, or hair_density_per_mm = 0".to_owned();
            return wrong("hair_length_mm", format!("[{mean}, {deviation}]"), rule);
        }
        Ok(())
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
    fn only_plies_flatter_than_any_measured_are_rounder_outside() {
        for name in presets::yarn_names() {
            let yarn = presets::yarn(name).unwrap();
            let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
            assert_eq!(yarn.beyond_mm(), axes, "{name}");
            for flat in [0.01, 0.1, 0.6, 1.0 / 0.6, 10.0, 100.0] {
                let (short, long) = (0.3 / f64::sqrt(flat), 0.3 * f64::sqrt(flat));
                let flat_yarn = YarnParams { ellipse_short_mm: short, ellipse_long_mm: long, ..yarn.clone() };
                let beyond = flat_yarn.beyond_mm();
                assert!((beyond.x * beyond.y - 0.09).abs() < 1e-12, "the same area: {beyond}");
                let ratio = beyond.y / beyond.x;
                assert!((ratio - flat.clamp(1.0 / MOST_FLAT, MOST_FLAT)).abs() < 1e-12, "{flat}: {ratio}");
            }
        }
    }

    #[test]
    fn validation_names_the_key_and_rejects_nan() {
        let good = presets::yarn("worsted_3ply").unwrap();
        assert_eq!(good.validate(), Ok(()));
        let says = |yarn: YarnParams| yarn.validate().unwrap_err().to_string();
        let bad = YarnParams { density_beta: -1.0, ..good.clone() };
        assert_eq!(says(bad), "yarn.density_beta = -1: allowed is 0 to 20");
        let bad = YarnParams { yarn_radius_mm: f64::NAN, ..good.clone() };
        assert_eq!(says(bad), "yarn.yarn_radius_mm = NaN: allowed is 0 to 1000000 mm");
        let bad = YarnParams { ply_count: 0, ..good.clone() };
        assert_eq!(says(bad), "yarn.ply_count = 0: allowed is 1 to 8");
        let bad = YarnParams { ellipse_long_mm: -0.1, ..good.clone() };
        assert_eq!(says(bad), "yarn.ellipse_long_mm = -0.1: allowed is 0.000001 to 1000000 mm");
        let bad = YarnParams { fiber_pitch_mm: Some(f64::INFINITY), ..good.clone() };
        assert_eq!(bad.validate().unwrap_err().key, "fiber_pitch_mm");
        let loops = Spread { mean: 0.1, deviation: f64::NAN };
        let bad = YarnParams { loop_radius_mm: loops, ..good.clone() };
        assert_eq!(bad.validate().unwrap_err().key, "loop_radius_mm");
        assert_eq!(YarnParams { ply_pitch_mm: None, hair_pitch_mm: Some(3.0), ..good }.validate(), Ok(()));
    }

    #[test]
    fn parameters_that_depend_on_each_other_are_checked() {
        let good = presets::yarn("worsted_3ply").unwrap();
        let bad = YarnParams { ply_count: 8, fibers_per_ply: 2000, ..good.clone() };
        assert_eq!(bad.validate(), Ok(()), "exactly the most");
        let bad = YarnParams { migration_min: 0.9, migration_max: 0.8, ..good.clone() };
        let says = bad.validate().unwrap_err().to_string();
        assert_eq!(says, "yarn.migration_max = 0.8: allowed is at least migration_min = 0.9");
        let bad = YarnParams { ellipse_long_mm: 7e-4, ..good.clone() };
        let says = bad.validate().unwrap_err().to_string();
        let expected =
            "yarn.ellipse_long_mm = 0.0007: allowed is at least 1/1000 of the yarn's outer radius, 0.79 mm";
        assert_eq!(says, expected);
        let far = YarnParams { yarn_radius_mm: 1e3, ..good.clone() };
        assert_eq!(far.validate().unwrap_err().key, "ellipse_short_mm");
        assert_eq!(YarnParams { ellipse_long_mm: 8e-4, ..good.clone() }.validate(), Ok(()));
        let bad = YarnParams { hair_length_mm: Spread { mean: -1.0, deviation: 1.0 }, ..good };
        assert_eq!(bad.validate().unwrap_err().key, "hair_length_mm");
        assert_eq!(YarnParams { hair_density_per_mm: 0.0, ..bad }.validate(), Ok(()));
    }
}
