//! How often fibers leave the ply and how far, as the shaders want it: per period of the fibers' radius.

use super::params::{Spread, YarnParams};
use glam::DVec2;

/// Largest deviations that a normal number is allowed (`normal_from_words`).
const CUT: f64 = 3.0;

/// Flyaways a period holds on average before migrations are cut into more periods.
const MOST_PER_PERIOD: f64 = 0.5;
/// Most periods that a migration is cut into.
const MOST_PERIODS: u32 = 64;

/// Probabilities and shapes of loops and hairs. R is a share of the ply's ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flyaways {
    /// Probability that a period is a loop.
    pub loop_probability: f64,
    /// Largest R of a loop.
    pub loop_radius: Spread,
    /// Probability that a period holds a hair.
    pub hair_probability: f64,
    /// R where a hair leaves the ply.
    pub hair_start: Spread,
    /// How much farther out its tip is.
    pub hair_gain: Spread,
    /// Its length as a share of the period.
    pub hair_share: Spread,
    /// Radians around the ply from root to tip.
    pub hair_angle: Spread,
    /// Above 0: turns around the ply per period, in place of the angle.
    pub hair_turns_per_period: f64,
    /// Turns of the fiber itself per period: 1 / s.
    pub fiber_turns_per_period: f64,
    /// Share of the hair's length over which it tapers to a point.
    pub hair_taper: f64,
    /// R_min: the share of its radius at which a fiber's hairs have their roots.
    pub migration_min: f64,
    /// Equal parts of a migration for each of which loops and hairs are drawn; 1 unless a migration is so
    /// slow that it would hold several.
    pub periods_per_migration: u32,
    /// Distance in mm from the yarn's centre that nothing exceeds, hairs included.
    pub reach_mm: f64,
}

impl Flyaways {
    /// Works them out. A yarn whose radius does not migrate (untwisted fibers, or s = 0) has no
    /// periods, and so neither loops nor hairs.
    ///
    /// Densities are per mm of yarn and ply; a ply of N fibers has N / period periods per mm, so that each
    /// is a flyaway with probability density x period / N. Where that comes to more than
    /// one half the migration is cut into shorter periods, up to 64 of them;
    /// denser flyaways than those hold are left out.
    pub fn new(yarn: &YarnParams) -> Self {
        let turns_per_mm = yarn.migration_rate * yarn.fiber_turns_per_mm().abs();
        let migration_mm = if turns_per_mm > 0.0 { 1.0 / turns_per_mm } else { 0.0 };
        let density_per_mm = yarn.hair_density_per_mm + yarn.loop_density_per_mm;
        let per_migration = density_per_mm * migration_mm / f64::from(yarn.fibers_per_ply);
        let periods = (per_migration / MOST_PER_PERIOD).ceil().clamp(1.0, f64::from(MOST_PERIODS));
        let period_mm = migration_mm / periods;
        let chance = |density_per_mm: f64| density_per_mm * period_mm / f64::from(yarn.fibers_per_ply);
        let hair_probability = chance(yarn.hair_density_per_mm).min(1.0);
        let loop_probability = chance(yarn.loop_density_per_mm).min(1.0 - hair_probability);
        let radius_mm = yarn.round_ply_radius_mm();
        let scaled =
            |spread: Spread, by: f64| Spread { mean: spread.mean * by, deviation: spread.deviation * by };
        let per_period = |pitch_mm: Option<f64>| pitch_mm.map_or(0.0, |pitch| period_mm / pitch);
        let share_per_mm = if period_mm > 0.0 { 1.0 / period_mm } else { 0.0 };
        let mut all = Self {
            loop_probability,
            loop_radius: scaled(yarn.loop_radius_mm, 1.0 / radius_mm),
            hair_probability,
            hair_start: scaled(yarn.hair_radius_start_mm, 1.0 / radius_mm),
            hair_gain: scaled(yarn.hair_radius_gain_mm, 1.0 / radius_mm),
            hair_share: scaled(yarn.hair_length_mm, share_per_mm),
            hair_angle: yarn.hair_angle_rad,
            hair_turns_per_period: per_period(yarn.hair_pitch_mm),
            fiber_turns_per_period: per_period(yarn.fiber_pitch_mm),
            hair_taper: yarn.hair_taper,
            migration_min: yarn.migration_min,
            periods_per_migration: periods as u32,
            reach_mm: yarn.outer_radius_mm(),
        };
        all.reach_mm = all.reach_mm.max(yarn.ply_offset_mm() + most_offset_mm(yarn, all.most_radius()));
        all
    }

    /// Whether there are any.
    pub fn exist(&self) -> bool {
        self.loop_probability > 0.0 || self.hair_probability > 0.0
    }

    /// Largest R of anything that exists.
    fn most_radius(&self) -> f64 {
        let most = |spread: Spread| (spread.mean + CUT * spread.deviation).max(0.0);
        let loops = if self.loop_probability > 0.0 { most(self.loop_radius) } else { 0.0 };
        let hairs =
            if self.hair_probability > 0.0 { most(self.hair_start) + most(self.hair_gain) } else { 0.0 };
        loops.max(hairs)
    }
}

/// Farthest that a fiber at R = `radius` lies from its ply's centre.
fn most_offset_mm(yarn: &YarnParams, radius: f64) -> f64 {
    let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
    let beyond = (radius - yarn.surface_radius()).max(0.0);
    (radius * axes + beyond * (yarn.beyond_mm() - axes)).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::presets;

    #[test]
    fn probabilities_follow_the_densities() {
        let yarn = presets::yarn("cotton1").unwrap();
        let flyaways = Flyaways::new(&yarn);
        let period_mm = yarn.fiber_pitch_mm.unwrap() / yarn.migration_rate;
        let hairs_per_mm = flyaways.hair_probability * f64::from(yarn.fibers_per_ply) / period_mm;
        assert!((hairs_per_mm - yarn.hair_density_per_mm).abs() < 1e-12);
        let loops_per_mm = flyaways.loop_probability * f64::from(yarn.fibers_per_ply) / period_mm;
        assert!((loops_per_mm - yarn.loop_density_per_mm).abs() < 1e-12);
        assert!(flyaways.reach_mm > yarn.outer_radius_mm());
    }

    #[test]
    fn without_periods_or_densities_there_are_none() {
        let mut yarn = presets::yarn("cotton1").unwrap();
        yarn.fiber_pitch_mm = None;
        let flyaways = Flyaways::new(&yarn);
        assert!(!flyaways.exist() && flyaways.reach_mm == yarn.outer_radius_mm());
        let mut yarn = presets::yarn("cotton1").unwrap();
        yarn.hair_density_per_mm = 0.0;
        yarn.loop_density_per_mm = 0.0;
        assert!(!Flyaways::new(&yarn).exist());
        yarn.hair_density_per_mm = 1e9;
        assert_eq!(Flyaways::new(&yarn).hair_probability, 1.0);
    }
}
