//! Rotation-minimising frames along a centre line, in f64.

use super::fiber::{piece_tangent, turned_normal};
use crate::math::curve::bezier_point;
use crate::math::frame::{any_perpendicular, direction_or, normal_perpendicular_to};
use glam::{DQuat, DVec3};

/// Steps per piece; the method's error falls with their fourth power.
const STEPS_PER_PIECE: u32 = 4;

/// A position on a curve with its unit tangent.
#[derive(Clone, Copy)]
struct Station {
    position: DVec3,
    tangent: DVec3,
}

/// Carries `normal` from one station to the next by double reflection (Wang et al. 2008). Where a
/// reflection has no plane (coincident positions, a chord across the tangent) the smallest rotation of
/// the tangent stands in.
fn carry(from: Station, to: Station, normal: DVec3) -> DVec3 {
    let reflect = |plane: DVec3, v: DVec3| v - plane * (2.0 * plane.dot(v) / plane.length_squared());
    let chord = direction_or(to.position - from.position, DVec3::ZERO);
    if chord == DVec3::ZERO {
        return carried_normal(from.tangent, to.tangent, normal);
    }
    let second = to.tangent - reflect(chord, from.tangent);
    if second.length_squared() < 1e-12 {
        return carried_normal(from.tangent, to.tangent, normal);
    }
    normal_perpendicular_to(to.tangent, reflect(second, reflect(chord, normal)))
}

/// The unit `normal` of a curve with the unit tangent `from` after the smallest rotation to the unit tangent `to`; where
/// they are opposite the normal is already perpendicular to both.
pub fn carried_normal(from: DVec3, to: DVec3, normal: DVec3) -> DVec3 {
    normal_perpendicular_to(to, direction_or(turned_normal(from, to, normal), normal))
}

/// Unit normals at the knots of a chain of Bezier pieces: one more than there are pieces. The first is
/// perpendicular to the first tangent and otherwise arbitrary; the others follow without twisting.
pub fn knot_normals(pieces: &[[DVec3; 4]]) -> Vec<DVec3> {
    let station = |b: &[DVec3; 4], t: f64| {
        let c = bezier_point(b, t);
        Station { position: c.position, tangent: piece_tangent(b, c.derivative) }
    };
    let Some(first) = pieces.first() else { return Vec::new() };
    let mut at = station(first, 0.0);
    let mut normal = any_perpendicular(at.tangent);
    let mut normals = vec![normal];
    for b in pieces {
        // Where two pieces meet only the tangent may jump.
        let corner = station(b, 0.0);
        normal = carried_normal(at.tangent, corner.tangent, normal);
        at = corner;
        for step in 1..=STEPS_PER_PIECE {
            let next = station(b, f64::from(step) / f64::from(STEPS_PER_PIECE));
            normal = carry(at, next, normal);
            at = next;
        }
        normals.push(normal);
    }
    normals
}

/// Turns the normals of a closed chain so that the last equals the first, spreading the closing
/// angle in proportion to `lengths` (arc length of each piece).
pub fn close_normals(pieces: &[[DVec3; 4]], lengths: &[f64], normals: &mut [DVec3]) {
    let (Some(first_piece), Some(&last), Some(&first)) = (pieces.first(), normals.last(), normals.first())
    else {
        return;
    };
    let tangent = piece_tangent(first_piece, first_piece[1] - first_piece[0]);
    let angle = last.cross(first).dot(tangent).atan2(last.dot(first));
    let total: f64 = lengths.iter().sum();
    let mut length = 0.0;
    for (k, normal) in normals.iter_mut().enumerate() {
        let (b, leg) = match pieces.get(k) {
            Some(b) => (b, b[1] - b[0]),
            None => (first_piece, first_piece[1] - first_piece[0]),
        };
        let share = if total > 0.0 { length / total } else { 0.0 };
        *normal = DQuat::from_axis_angle(piece_tangent(b, leg), angle * share) * *normal;
        length += lengths.get(k).copied().unwrap_or(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Bezier pieces through samples of a smooth closed or open curve, by its derivative.
    fn pieces(n: u32, position: impl Fn(f64) -> DVec3, derivative: impl Fn(f64) -> DVec3) -> Vec<[DVec3; 4]> {
        (0..n)
            .map(|i| {
                let (a, b) = (f64::from(i) / f64::from(n), f64::from(i + 1) / f64::from(n));
                let h = (b - a) / 3.0;
                [position(a), position(a) + h * derivative(a), position(b) - h * derivative(b), position(b)]
            })
            .collect()
    }

    fn helix(turns: f64, radius: f64, rise: f64) -> Vec<[DVec3; 4]> {
        let w = TAU * turns;
        pieces(
            (turns * 40.0) as u32,
            |u| DVec3::new(radius * (w * u).cos(), radius * (w * u).sin(), rise * turns * u),
            |u| DVec3::new(-radius * w * (w * u).sin(), radius * w * (w * u).cos(), rise * turns),
        )
    }

    #[test]
    fn a_helix_turns_the_frame_by_its_torsion() {
        // The Frenet normal of a helix rotates against the rotation-minimising one by torsion times
        // length: tau = c / (r^2 + c^2), c = rise / 2 pi, length per turn 2 pi sqrt(r^2 + c^2).
        let (radius, rise, turns) = (1.0, 2.0, 3.0);
        let chain = helix(turns, radius, rise);
        let normals = knot_normals(&chain);
        let c = rise / TAU;
        let expected = turns * TAU * c / radius.hypot(c);
        // After whole turns tangent and Frenet normal are back: the angle between first and last normal.
        let (first, last) = (normals[0], *normals.last().unwrap());
        let tangent = piece_tangent(&chain[0], chain[0][1] - chain[0][0]);
        let angle = first.cross(last).dot(tangent).atan2(first.dot(last));
        let difference = (angle + expected).rem_euclid(TAU);
        assert!(difference.min(TAU - difference) < 1e-4, "{angle} vs {expected}");
    }

    #[test]
    fn closing_makes_the_last_normal_the_first() {
        // A curve on a torus: closed, with a holonomy that is not a whole turn.
        let at = |u: f64| {
            let (a, b) = (TAU * u, TAU * 3.0 * u);
            DVec3::new((3.0 + b.cos()) * a.cos(), (3.0 + b.cos()) * a.sin(), b.sin())
        };
        let slope = |u: f64| (at(u + 1e-6) - at(u - 1e-6)) / 2e-6;
        let chain = pieces(200, at, slope);
        let lengths: Vec<f64> = chain.iter().map(|b| (b[3] - b[0]).length()).collect();
        let mut normals = knot_normals(&chain);
        assert!((normals[0] - normals[200]).length() > 0.05, "the test curve must not close by itself");
        close_normals(&chain, &lengths, &mut normals);
        assert!((normals[0] - normals[200]).length() < 1e-9);
        for (b, n) in chain.iter().zip(&normals) {
            assert!(piece_tangent(b, b[1] - b[0]).dot(*n).abs() < 1e-6 && (n.length() - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn straight_zero_length_and_doubling_back_pieces_stay_finite() {
        let straight = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X * 3.0];
        let point = [DVec3::X * 3.0; 4];
        let back = [DVec3::X * 3.0, DVec3::X * 4.0, DVec3::X * 4.0, DVec3::X * 3.0];
        let normals = knot_normals(&[straight, point, back, point]);
        assert_eq!(normals.len(), 5);
        assert!(normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-12));
        assert!((normals[1] - normals[0]).length() < 1e-12, "a straight piece must not turn the frame");
        assert!(knot_normals(&[]).is_empty());
    }
}
