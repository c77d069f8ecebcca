//! A yarn that is known only as far as a query says.

use crate::yarn::params::{Spread, YarnParams};
use glam::DVec2;

/// A yarn of so many plies with ellipses of these half-axes, short then long: untwisted, without migration
/// or anything that stands out, its plies on its centre line. Its "mm" are the query's unit.
pub fn bare_yarn(ply_count: u32, ellipse: DVec2) -> YarnParams {
    YarnParams {
        ply_count,
        fibers_per_ply: 1,
        yarn_radius_mm: 0.0,
        ply_pitch_mm: None,
        ply_clockwise: false,
        fiber_pitch_mm: None,
        fiber_clockwise: false,
        ellipse_short_mm: ellipse.x,
        ellipse_long_mm: ellipse.y,
        density_beta: 0.0,
        density_epsilon: 0.0,
        migration_min: 1.0,
        migration_max: 1.0,
        migration_rate: 0.0,
        fiber_diameter_um: 1.0,
        loop_density_per_mm: 0.0,
        loop_radius_mm: Spread::default(),
        hair_density_per_mm: 0.0,
        hair_length_mm: Spread::default(),
        hair_radius_start_mm: Spread::default(),
        hair_radius_gain_mm: Spread::default(),
        hair_angle_rad: Spread::default(),
        hair_pitch_mm: None,
        hair_taper: 0.0,
    }
}
