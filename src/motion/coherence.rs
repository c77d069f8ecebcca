//! How much fibers turn about their yarn beyond what the yarn's own bends and the cloth's turns account for.

use super::pose::Pose;
use crate::yarn::strand::Strands;
use crate::yarn::transport::carried_normal;
use glam::DVec3;
use std::f64::consts::PI;

/// The angle about `tangents[1]`, from -pi to pi, from the first normal, carried there by the shortest turn between the
/// tangents, to the second. All are unit vectors.
pub fn turn_between(tangents: [DVec3; 2], normals: [DVec3; 2]) -> f64 {
    let [from, to] = tangents;
    let carried = carried_normal(from, to, normals[0]);
    to.dot(carried.cross(normals[1])).atan2(carried.dot(normals[1]))
}

/// [`turn_between`] the two knots of every piece of the strands in that pose: the twist of its frame.
pub fn twists(strands: &Strands, normals: &[DVec3], tangents: &[DVec3]) -> Vec<f64> {
    let of_piece = |first: usize| {
        let knots = strands.knot_offsets().map(|offset| first + offset);
        turn_between(knots.map(|knot| tangents[knot]), knots.map(|knot| normals[knot]))
    };
    strands.pieces.iter().map(|piece| of_piece(piece.first_point)).collect()
}

/// What of an angle is left after whole turns, from -pi to pi.
pub fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(2.0 * PI) - PI
}

/// How far the normals at every knot turn about the yarn from one pose to the next, in radians, each with its place
/// among the strands' points; the cloth's own turn about the yarn is in it.
pub fn phase_steps<'a>(
    knots: &'a [bool],
    from: &'a Pose,
    to: &'a Pose,
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let step = |place: usize| {
        turn_between([from.tangents[place], to.tangents[place]], [from.normals[place], to.normals[place]])
    };
    (0..knots.len()).filter(|place| knots[*place]).map(move |place| (place, step(place).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::curve::{Basis, Curve};
    use crate::yarn::presets;
    use crate::yarn::strand::strands;
    use glam::DQuat;

    #[test]
    fn a_turn_about_the_tangent_is_found_and_one_with_it_is_not() {
        let (tangent, normal) = (DVec3::X, DVec3::Y);
        for angle in [-3.0, -0.1, 0.0, 1e-6, 2.0] {
            let spun = DQuat::from_axis_angle(tangent, angle) * normal;
            assert!((turn_between([tangent, tangent], [normal, spun]) - angle).abs() < 1e-12);
            let bend = DQuat::from_axis_angle(DVec3::new(0.0, 0.6, 0.8), 1.2);
            let found = turn_between([tangent, bend * tangent], [normal, bend * spun]);
            assert!((found - angle).abs() < 1e-12, "{angle} {found}");
        }
        assert!(
            (wrapped(2.0 * PI + 0.1) - 0.1).abs() < 1e-12 && (wrapped(-7.0) + 7.0 - 2.0 * PI).abs() < 1e-12
        );
    }

    #[test]
    fn frames_at_rest_hardly_twist_and_added_twist_is_seen_where_it_is() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let at = |i: i32| DVec3::new(f64::from(i), (0.7 * f64::from(i)).sin(), (0.4 * f64::from(i)).cos());
        let curve = Curve { points: (0..20).map(at).collect(), closed: false };
        let strands = strands(&[curve], Basis::CatmullRom, &yarn, 0);
        let tangents = strands.knot_tangents();
        let rest = twists(&strands, &strands.normals, &tangents);
        let mut spun = strands.normals.clone();
        spun[8] = DQuat::from_axis_angle(tangents[8], 0.5) * spun[8];
        let added: Vec<f64> =
            twists(&strands, &spun, &tangents).iter().zip(&rest).map(|(a, b)| wrapped(a - b)).collect();
        let [start, end] = strands.knot_offsets();
        for (piece, added) in strands.pieces.iter().zip(&added) {
            let expected = match 8 {
                knot if knot == piece.first_point + start => -0.5,
                knot if knot == piece.first_point + end => 0.5,
                _ => 0.0,
            };
            assert!((added - expected).abs() < 1e-9, "{added} {expected}");
        }
    }
}
