//! How finely a piece of yarn is cut, and whether it is in view; twin of `glsl/yarn/level.glsl`.

use crate::math::frame::direction_or;
use glam::{DVec3, DVec4};
use std::f64::consts::TAU;

/// Angle in [0, pi] between two vectors; 0 where one has no direction.
pub fn turning_angle(a: DVec3, b: DVec3) -> f64 {
    let u = direction_or(a, DVec3::ZERO);
    let v = direction_or(b, DVec3::ZERO);
    u.cross(v).length().atan2(u.dot(v))
}

/// Pieces a fiber is cut into over one Bezier piece `b` of yarn: enough for the turns it makes around
/// its ply and with the yarn, and for the bending of the centre line. 1 to `largest`.
pub fn subdivisions(b: &[DVec3; 4], ply_turns: f64, fiber_turns: f64, per_turn: f64, largest: u32) -> u32 {
    let bend = turning_angle(b[1] - b[0], b[2] - b[1]) + turning_angle(b[2] - b[1], b[3] - b[2]);
    let turns = ply_turns.abs() + fiber_turns.abs() + bend / TAU;
    (turns * per_turn).ceil().clamp(1.0, f64::from(largest)) as u32
}

/// Whether everything within `margin` of the Bezier curve `b` lies outside one of the inward planes.
pub fn outside_frustum(b: &[DVec3; 4], margin: f64, planes: &[DVec4; 5]) -> bool {
    planes.iter().any(|plane| b.iter().all(|p| plane.truncate().dot(*p) + plane.w < -margin))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subdivisions_grow_with_twist_and_bend_and_are_bounded() {
        let straight = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X * 3.0];
        assert_eq!(subdivisions(&straight, 0.0, 0.0, 24.0, 64), 1);
        assert_eq!(subdivisions(&straight, -0.25, 0.0, 24.0, 64), 6);
        assert_eq!(subdivisions(&straight, 100.0, 0.0, 24.0, 64), 64);
        let bent = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
        assert_eq!(subdivisions(&bent, 0.0, 0.0, 24.0, 64), 12);
        assert_eq!(subdivisions(&[DVec3::ZERO; 4], 0.0, 0.0, 24.0, 64), 1);
    }

    #[test]
    fn culls_only_what_is_wholly_outside() {
        let planes = [DVec4::new(1.0, 0.0, 0.0, 0.0); 5];
        let at = |x: f64| [DVec3::new(x, 0.0, 0.0), DVec3::new(x, 1.0, 0.0), DVec3::new(x, 2.0, 0.0), DVec3::new(x, 3.0, 0.0)];
        assert!(outside_frustum(&at(-1.1), 1.0, &planes));
        assert!(!outside_frustum(&at(-0.9), 1.0, &planes));
        let mut crossing = at(-5.0);
        crossing[3].x = 1.0;
        assert!(!outside_frustum(&crossing, 1.0, &planes));
    }
}
