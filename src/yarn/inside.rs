//! Whether the table of light in a yarn's inside shows its plies.

use super::migrated_density::migrated_density;
use super::params::YarnParams;
use std::f64::consts::PI;

/// Texels across the table of self-shadows, toward the light and across it, where a scene states none.
pub const SELF_SHADOW_ACROSS: u32 = 128;
/// Its slices: angles between the light and ply 0.
pub const SELF_SHADOW_SLICES: u32 = 32;

/// Fewest texels over half of a ply's shorter axis. Every preset has 27 and more.
const LEAST_IN_PLY: f64 = 20.0;
/// Fewest texels from a ply's axis to where it is half as dense as there. Every preset has 20 and more.
const LEAST_TO_HALF: f64 = 10.0;
/// Steps in which that radius is looked for.
const STEPS: u32 = 20;
/// Just inside of a ply's rim, as a share of its half-axes, and how dense it may be there, as a share of its axis'
/// density: denser plies end in a step. Presets have at most a fifth.
const RIM: f64 = 0.97;
const STEP: f64 = 0.25;

/// Whether a self-shadow table of the default size keeps what it promises for the yarn: its plies are thick enough,
/// even enough, and do not end in a step. Random yarns for which this says so are within half of the promise.
pub fn fits_table(yarn: &YarnParams) -> bool {
    let texels = texels_in_ply(yarn);
    let middle = migrated_density(yarn, 0.0);
    texels >= LEAST_IN_PLY
        && migrated_density(yarn, RIM) <= STEP * middle
        && texels * half_radius(yarn, middle) >= LEAST_TO_HALF
}

/// Texels over half of a ply's shorter axis: across the yarn, or from slice to slice where those are farther apart.
fn texels_in_ply(yarn: &YarnParams) -> f64 {
    let across = 2.0 * yarn.outer_radius_mm() / f64::from(SELF_SHADOW_ACROSS - 1);
    let around = yarn.ply_offset_mm() * PI / f64::from(yarn.ply_count * (SELF_SHADOW_SLICES - 1));
    yarn.thinnest().1 / across.max(around)
}

/// Share of a ply's half-axes at which it is half as dense as on its axis, to a step; 1 where it is nowhere.
fn half_radius(yarn: &YarnParams, middle: f64) -> f64 {
    let radius = |step: u32| f64::from(step) / f64::from(STEPS);
    (0..=STEPS).map(radius).find(|&r| migrated_density(yarn, r) < 0.5 * middle).unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::presets;

    fn wool(edit: impl FnOnce(&mut YarnParams)) -> YarnParams {
        let mut yarn = presets::yarn("worsted_3ply").unwrap();
        edit(&mut yarn);
        yarn
    }

    #[test]
    fn every_preset_fits() {
        for name in presets::yarn_names() {
            assert!(fits_table(&presets::yarn(name).unwrap()), "{name}");
        }
    }

    #[test]
    fn thin_peaked_and_abrupt_plies_do_not() {
        assert!(!fits_table(&wool(|y| y.ellipse_short_mm = 0.1)), "flat");
        assert!(!fits_table(&wool(|y| y.ellipse_long_mm = 0.1)), "flat the other way");
        assert!(!fits_table(&wool(|y| y.yarn_radius_mm = 8.0)), "far apart");
        assert!(!fits_table(&wool(|y| y.ply_count = 1)), "slices too far apart");
        assert!(fits_table(&wool(|y| (y.ply_count, y.yarn_radius_mm) = (1, 0.0))), "on the axis");
        assert!(!fits_table(&wool(|y| y.migration_min = 0.05)), "all fibers pass the axis");
        assert!(!fits_table(&wool(|y| (y.migration_min, y.density_beta) = (1.0, 0.0))), "a step");
        assert!(!fits_table(&wool(|y| (y.migration_min, y.density_epsilon) = (1.0, 0.5))), "a step");
    }
}
