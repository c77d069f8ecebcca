//! How finely a piece of yarn is cut, and whether it is in view; twin of `glsl/yarn/level.glsl`.

use crate::math::angle::angle_of;
use crate::math::frame::direction_or;
use glam::{DVec3, DVec4};
use std::f64::consts::TAU;

/// Angle in [0, pi] between two vectors; 0 where one has no direction.
pub fn turning_angle(a: DVec3, b: DVec3) -> f64 {
    let u = direction_or(a, DVec3::ZERO);
    let v = direction_or(b, DVec3::ZERO);
    angle_of(u.cross(v).length(), u.dot(v))
}

/// What decides how finely a fiber is cut: lengths in mm, rotations over the piece in turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutting {
    /// Turns of the plies about the yarn.
    pub ply_turns: f64,
    /// Turns of the fibers inside the ply's frame.
    pub fiber_turns: f64,
    /// Ply centre's distance from the yarn's centre.
    pub ply_offset_mm: f64,
    /// e_B.
    pub ellipse_long_mm: f64,
    /// Largest departure of a chord from the curve.
    pub tolerance_mm: f64,
    /// Least pieces a turn.
    pub per_turn: f64,
    /// Most pieces.
    pub largest: u32,
}

/// Pieces a fiber is cut into over the Bezier piece `b` of yarn, so that no chord departs from the
/// curve by more than the tolerance. Over an angle a at radius r, n chords depart by r a^2 / (8 n^2);
/// the plies' rotation about the yarn, the fibers' about the ply and the bend of the centre line add
/// up. At least `per_turn` pieces a turn, whose directions shading can interpolate; 1 to `largest`.
pub fn subdivisions(b: &[DVec3; 4], cutting: &Cutting) -> u32 {
    let legs = [b[1] - b[0], b[2] - b[1], b[3] - b[2]];
    let bend = turning_angle(legs[0], legs[1]) + turning_angle(legs[1], legs[2]);
    let length_mm: f64 = legs.iter().map(|leg| leg.length()).sum();
    let ply = TAU * cutting.ply_turns;
    let fiber = TAU * (cutting.ply_turns + cutting.fiber_turns);
    let departure =
        (cutting.ply_offset_mm * ply * ply + cutting.ellipse_long_mm * fiber * fiber + length_mm * bend)
            / 8.0;
    let smooth_pieces = (ply.abs() + fiber.abs() + bend) * (cutting.per_turn / TAU);
    let pieces = (departure / cutting.tolerance_mm.max(1e-12)).sqrt().max(smooth_pieces);
    pieces.ceil().clamp(1.0, f64::from(cutting.largest)) as u32
}

/// At least `pieces`, and enough that no two vertices are more than a quarter of a period apart: a step
/// must not pass over a whole period. `pieces` is at most `largest`.
pub fn period_pieces(pieces: u32, periods: f64, largest: u32) -> u32 {
    (4.0 * periods.abs()).ceil().clamp(f64::from(pieces.min(largest)), f64::from(largest)) as u32
}

/// Depth of the nearest control point of `b` along the view axis, less `margin`, at least `nearest`; a
/// point's depth is depth.xyz . p + depth.w.
pub fn nearest_depth(b: &[DVec3; 4], depth: DVec4, margin: f64, nearest: f64) -> f64 {
    let least = b.iter().map(|p| depth.truncate().dot(*p)).fold(f64::INFINITY, f64::min);
    (least + depth.w - margin).max(nearest)
}

/// Whether everything within `margin` of the Bezier curve `b` lies outside one of the inward planes.
pub fn outside_frustum(b: &[DVec3; 4], margin: f64, planes: &[DVec4; 5]) -> bool {
    planes.iter().any(|plane| b.iter().all(|p| plane.truncate().dot(*p) + plane.w < -margin))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUTTING: Cutting = Cutting {
        ply_turns: 0.0,
        fiber_turns: 0.0,
        ply_offset_mm: 0.4,
        ellipse_long_mm: 0.3,
        tolerance_mm: 0.01,
        per_turn: 6.0,
        largest: 64,
    };

    #[test]
    fn subdivisions_grow_with_twist_and_bend_and_are_bounded() {
        let straight = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X * 3.0];
        assert_eq!(subdivisions(&straight, &CUTTING), 1);
        let twisted = Cutting { ply_turns: -0.25, fiber_turns: 0.25, ..CUTTING };
        // sqrt(0.4 (pi/2)^2 / 8 / 0.01) = 3.51
        assert_eq!(subdivisions(&straight, &twisted), 4);
        assert_eq!(subdivisions(&straight, &Cutting { tolerance_mm: 0.0025, ..twisted }), 8);
        assert_eq!(subdivisions(&straight, &Cutting { ply_turns: 100.0, ..CUTTING }), 64);
        assert_eq!(
            subdivisions(
                &straight,
                &Cutting { ply_turns: 0.5, fiber_turns: 0.5, tolerance_mm: 1e3, ..CUTTING }
            ),
            9
        );
        let bent = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
        assert_eq!(subdivisions(&bent, &CUTTING), 11);
        assert_eq!(subdivisions(&[DVec3::ZERO; 4], &CUTTING), 1);
    }

    #[test]
    fn chords_of_a_helix_stay_within_the_tolerance() {
        let cutting = Cutting { ply_turns: 0.3, fiber_turns: -0.3, ..CUTTING };
        let straight = [0.0, 1.0, 2.0, 3.0].map(|x| DVec3::X * x);
        let n = subdivisions(&straight, &cutting);
        let at = |t: f64| {
            let (s, c) = (TAU * cutting.ply_turns * t).sin_cos();
            DVec3::new(3.0 * t, cutting.ply_offset_mm * c, cutting.ply_offset_mm * s)
        };
        let chord = |k: u32| (at(f64::from(k) / f64::from(n)), at(f64::from(k + 1) / f64::from(n)));
        for k in 0..n {
            let (a, b) = chord(k);
            let middle = at((f64::from(k) + 0.5) / f64::from(n));
            assert!(middle.distance(0.5 * (a + b)) <= cutting.tolerance_mm);
        }
    }

    #[test]
    fn a_step_is_at_most_a_quarter_period() {
        assert_eq!(period_pieces(3, -1.1, 32), 5);
        assert_eq!(period_pieces(7, 0.1, 32), 7);
        assert_eq!(period_pieces(7, 100.0, 32), 32);
    }

    #[test]
    fn distance_is_to_the_nearest_control_point() {
        let b = [1.0, 2.0, 3.0, 4.0].map(|x| DVec3::X * x);
        assert_eq!(nearest_depth(&b, DVec4::new(1.0, 0.0, 0.0, 0.0), 0.25, 0.1), 0.75);
        assert_eq!(nearest_depth(&b, DVec4::new(1.0, 0.0, 0.0, -1.0), 0.25, 0.1), 0.1);
    }

    #[test]
    fn culls_only_what_is_wholly_outside() {
        let planes = [DVec4::new(1.0, 0.0, 0.0, 0.0); 5];
        let at = |x: f64| {
            [
                DVec3::new(x, 0.0, 0.0),
                DVec3::new(x, 1.0, 0.0),
                DVec3::new(x, 2.0, 0.0),
                DVec3::new(x, 3.0, 0.0),
            ]
        };
        assert!(outside_frustum(&at(-1.1), 1.0, &planes));
        assert!(!outside_frustum(&at(-0.9), 1.0, &planes));
        let mut crossing = at(-5.0);
        crossing[3].x = 1.0;
        assert!(!outside_frustum(&crossing, 1.0, &planes));
    }
}
