//! The camera-facing strip that stands for a round fiber; twin of `glsl/lib/strip.glsl`.

use super::frame::{any_perpendicular, direction_or};
use glam::{DVec3, DVec4};

/// Unit vector across the strip: perpendicular to the fiber and to the unit `to_eye`. Seen end on,
/// the fiber has no side and any perpendicular of the line of sight is given.
pub fn strip_side(tangent: DVec3, to_eye: DVec3) -> DVec3 {
    direction_or(tangent.cross(to_eye), any_perpendicular(to_eye))
}

/// Outward normal of the round fiber at `across` in [-1, 1] of its strip, by its azimuth phi from the viewer (0)
/// to the strip's side (pi/2): sin phi, cos phi, sin 2 phi, cos 2 phi.
pub fn strip_normals(across: f64) -> DVec4 {
    let z = (1.0 - across * across).max(0.0).sqrt();
    DVec4::new(across, z, 2.0 * across * z, z * z - across * across)
}

/// Mean of [`strip_normals`] over the strip.
pub const STRIP_MEAN_NORMALS: DVec4 = DVec4::new(0.0, std::f64::consts::FRAC_PI_4, 0.0, 1.0 / 3.0);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_faces_the_eye_in_the_middle_and_the_side_at_the_edges() {
        let tangent = DVec3::new(0.6, 0.8, 0.0);
        let to_eye = DVec3::Z;
        let side = strip_side(tangent, to_eye);
        assert!(side.dot(tangent).abs() < 1e-15 && side.dot(to_eye).abs() < 1e-15);
        let normal = |across: f64| {
            let n = strip_normals(across);
            n.x * side + n.y * side.cross(tangent)
        };
        assert!((normal(0.0) - to_eye).length() < 1e-15);
        assert!((normal(1.0) - side).length() < 1e-15);
        assert!((normal(-0.4).length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_second_pair_is_that_of_twice_the_angle() {
        for across in [-1.0, -0.6, 0.0, 0.3, 1.0] {
            let n = strip_normals(across);
            let twice = 2.0 * n.x.atan2(n.y);
            assert!((n.z - twice.sin()).abs() < 1e-15 && (n.w - twice.cos()).abs() < 1e-15);
        }
    }

    #[test]
    fn seen_end_on_it_is_still_finite() {
        let side = strip_side(DVec3::Z, DVec3::Z);
        assert!((side.length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_mean_is_that_over_the_strip() {
        let steps = 10_000;
        let across = |step| (f64::from(step) + 0.5) / f64::from(steps) * 2.0 - 1.0;
        let mean = (0..steps).map(|step| strip_normals(across(step))).sum::<DVec4>() / f64::from(steps);
        assert!((mean - STRIP_MEAN_NORMALS).abs().max_element() < 1e-6, "{mean}");
    }
}
