//! A yarn as a light sees it: a ribbon as wide as the tube around all of its plies; twin of
//! `glsl/yarn/tube.glsl`.

use crate::math::frame::normal_perpendicular_to;
use crate::math::strip::strip_side;
use glam::DVec3;

/// Straight pieces that a piece of yarn is drawn with; `TUBE_STEPS` in `glsl/shared/constants.glsl`.
pub const TUBE_STEPS: u32 = 3;
/// Rows of two corners: at the ends of these pieces, and one beyond either end of the piece of yarn.
pub const TUBE_ROWS: u32 = TUBE_STEPS + 3;
/// Half-width of the ends' caps as a share of the radius: of an octagon around the tube's round end.
pub const TUBE_CAP: f64 = std::f64::consts::SQRT_2 - 1.0;

/// t of a row on its piece of yarn.
pub fn tube_row(row: u32) -> f64 {
    ((f64::from(row) - 1.0) / f64::from(TUBE_STEPS)).clamp(0.0, 1.0)
}

/// A corner of the ribbon: `edge` is -1 or 1, `center` and `tangent` (unit) the yarn's at the row's t, and
/// `toward` a unit vector toward the light. The ribbon runs through the yarn's centre, so that what it hides
/// lies a radius behind the tube's surface: a tube never hides its own surface from a light that it faces.
pub fn tube_corner(center: DVec3, tangent: DVec3, toward: DVec3, radius: f64, row: u32, edge: f64) -> DVec3 {
    // Where the yarn points at the light its side is rounding, that may point anywhere.
    let side = normal_perpendicular_to(toward, strip_side(tangent, toward));
    let along = toward.cross(side);
    let (half_width, beyond) = match row {
        0 => (TUBE_CAP, -1.0),
        last if last == TUBE_ROWS - 1 => (TUBE_CAP, 1.0),
        _ => (1.0, 0.0),
    };
    center + radius * (edge * half_width * side + beyond * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ribbon_covers_the_tube_and_little_more() {
        let (tangent, toward) = (DVec3::X, DVec3::new(0.6, 0.0, 0.8));
        let corner = |row, edge| tube_corner(DVec3::ZERO, tangent, toward, 2.0, row, edge);
        for row in 0..TUBE_ROWS {
            for edge in [-1.0, 1.0] {
                let corner = corner(row, edge);
                assert!(corner.dot(toward).abs() < 1e-12, "the ribbon faces the light: {corner}");
                assert!(corner.length() >= 2.0 - 1e-12 && corner.length() < 2.0 * 1.083, "{corner}");
            }
        }
        assert!(corner(0, 1.0).x < 0.0 && corner(TUBE_ROWS - 1, 1.0).x > 0.0);
        assert_eq!((tube_row(0), tube_row(1), tube_row(TUBE_ROWS - 1)), (0.0, 0.0, 1.0));
    }

    #[test]
    fn a_yarn_that_points_at_the_light_is_as_wide_as_ever() {
        let corner = tube_corner(DVec3::ZERO, DVec3::Z, DVec3::Z, 1.0, 1, 1.0);
        assert!((corner.length() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_ribbon_faces_the_light_where_its_side_is_rounding() {
        let toward = DVec3::new(0.48, -0.6, 0.64);
        for angle in (8..=17).map(|digits| 10_f64.powi(-digits)) {
            for tangent in [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| (toward + angle * axis).normalize()) {
                let corner = tube_corner(DVec3::ZERO, tangent, toward, 1.0, 0, 1.0);
                assert!(
                    corner.dot(toward).abs() < 1e-12 && corner.length() > 1.0 - 1e-12,
                    "{angle}: {corner}"
                );
            }
        }
    }
}
