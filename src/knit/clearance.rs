//! How close the centre lines of a fabric come to each other, and how tightly they bend.

use crate::io::curves::CurveSet;
use crate::math::curve::curve_point;

use super::fine::{Chain, chains, near_pairs, pieces};
use glam::DVec3;

pub use super::fine::OnYarn;

/// Chords per cubic piece. For pieces of 1.5 radii that bend no tighter than one radius, a chord
/// leaves the curve by 0.1 percent of a radius at most.
const CHORDS: usize = 16;

/// The closest approach of two strands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Distance between the centre lines, in the curves' unit.
    pub distance: f64,
    /// Where it occurs on both strands.
    pub at: [OnYarn; 2],
}

/// The smallest distance between the centre lines of distinct strands: of different curves, or of
/// places on one curve that are at least `arc_skip` of arc length apart. `None` where there is no such
/// pair, or a coordinate is not finite.
pub fn min_clearance(curves: &CurveSet, arc_skip: f64) -> Option<Clearance> {
    let chains = chains(curves, CHORDS);
    let centres: Vec<DVec3> = chains.iter().map(|c| c.centre).collect();
    if centres.is_empty() || !centres.iter().all(|c| c.is_finite()) {
        return None;
    }
    let largest = chains.iter().fold(0.0, |m: f64, c| m.max(c.radius));
    let low = centres.iter().fold(DVec3::INFINITY, |m, &c| m.min(c));
    let high = centres.iter().fold(DVec3::NEG_INFINITY, |m, &c| m.max(c));
    let mut reach = (4.0 * largest).max(1e-9);
    loop {
        let mut best: Option<Clearance> = None;
        near_pairs(&centres, reach, |i, j| closest_chords(&chains[i], &chains[j], arc_skip, &mut best));
        // Pairs of pieces beyond the reach are at least this far from each other.
        let unseen = reach - 2.0 * largest;
        if best.is_some_and(|b| b.distance <= unseen) || reach > low.distance(high) + 1.0 {
            return best;
        }
        reach *= 1.5;
    }
}

/// Whether two places are neighbours along one yarn.
fn neighbours(a: &OnYarn, b: &OnYarn, closed_length: Option<f64>, arc_skip: f64) -> bool {
    let along = (a.arc - b.arc).abs();
    let along = closed_length.map_or(along, |length| along.min(length - along));
    a.curve == b.curve && along < arc_skip
}

/// Lowers `best` to the closest chords of two chains.
fn closest_chords(a: &Chain, b: &Chain, arc_skip: f64, best: &mut Option<Clearance>) {
    let limit = |best: &Option<Clearance>| best.map_or(f64::INFINITY, |b| b.distance);
    if a.centre.distance(b.centre) - a.radius - b.radius >= limit(best) {
        return;
    }
    for p in a.points.windows(2) {
        let reach = p[0].position.distance(p[1].position);
        for q in b.points.windows(2) {
            let far = reach + q[0].position.distance(q[1].position) + limit(best);
            if p[0].position.distance_squared(q[0].position) >= far * far
                || neighbours(&p[0], &q[0], a.closed_length, arc_skip)
            {
                continue;
            }
            let (s, t) = closest_on_segments([p[0].position, p[1].position], [q[0].position, q[1].position]);
            let at = [between(&p[0], &p[1], s), between(&q[0], &q[1], t)];
            let distance = at[0].position.distance(at[1].position);
            if distance < limit(best) {
                *best = Some(Clearance { distance, at });
            }
        }
    }
}

/// The place at fraction `t` of a chord.
pub(crate) fn between(a: &OnYarn, b: &OnYarn, t: f64) -> OnYarn {
    OnYarn {
        curve: a.curve,
        parameter: a.parameter + t * (b.parameter - a.parameter),
        arc: a.arc + t * (b.arc - a.arc),
        position: a.position.lerp(b.position, t),
    }
}

/// Fractions along two segments at which they are closest (Ericson, Real-Time Collision Detection, 5.1.9).
fn closest_on_segments(p: [DVec3; 2], q: [DVec3; 2]) -> (f64, f64) {
    let (u, v, w) = (p[1] - p[0], q[1] - q[0], p[0] - q[0]);
    let (a, e, f) = (u.length_squared(), v.length_squared(), v.dot(w));
    let (b, c) = (u.dot(v), u.dot(w));
    let ratio = |n: f64, d: f64| if d > 0.0 { (n / d).clamp(0.0, 1.0) } else { 0.0 };
    let s = ratio(b * f - c * e, a * e - b * b);
    let t = if e > 0.0 { (b * s + f) / e } else { 0.0 };
    match t {
        t if t < 0.0 => (ratio(-c, a), 0.0),
        t if t > 1.0 => (ratio(b - c, a), 1.0),
        t => (s, t),
    }
}

/// The smallest radius of curvature anywhere, in the curves' unit; `None` where nothing bends.
pub fn min_curvature_radius(curves: &CurveSet) -> Option<f64> {
    let radius = |quad: &[DVec3; 4], t: f64| {
        let c = curve_point(quad, curves.basis, t);
        let turn = c.derivative.cross(c.second_derivative).length();
        (turn > 0.0).then(|| c.derivative.length().powi(3) / turn)
    };
    let all = curves.curves.iter().flat_map(|curve| pieces(curve, curves.basis));
    all.flat_map(|(_, quad)| (0..=CHORDS).filter_map(move |k| radius(&quad, k as f64 / CHORDS as f64)))
        .min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::curves::{Basis, Curve};

    fn circle(radius: f64, centre: DVec3, across: DVec3, points: usize) -> Curve {
        let at = |i: usize| {
            let a = i as f64 / points as f64 * std::f64::consts::TAU;
            centre + radius * (DVec3::X * a.cos() + across * a.sin())
        };
        Curve { points: (0..points).map(at).collect(), closed: true }
    }

    fn set(curves: Vec<Curve>) -> CurveSet {
        CurveSet { basis: Basis::CatmullRom, up_axis: None, curves }
    }

    #[test]
    fn linked_rings_are_as_far_apart_as_geometry_says() {
        // The second ring passes 1.25 inside the first one's rim of 3, and 1.75 from its far side.
        let first = circle(3.0, DVec3::ZERO, DVec3::Y, 200);
        let second = circle(2.0, DVec3::X * 3.75, DVec3::Z, 200);
        let found = min_clearance(&set(vec![first, second]), 3.0).unwrap();
        assert!((found.distance - 1.25).abs() < 1e-3, "{found:?}");
        assert_eq!((found.at[0].curve, found.at[1].curve), (0, 1));
        assert!((found.at[0].position - DVec3::X * 3.0).length() < 0.05, "{found:?}");
    }

    #[test]
    fn a_curve_is_measured_against_itself_beyond_the_skipped_arc() {
        let ring = set(vec![circle(3.0, DVec3::ZERO, DVec3::Y, 200)]);
        // A chord over a quarter of the circle, also across the closing point.
        let found = min_clearance(&ring, 3.0 * std::f64::consts::FRAC_PI_2).unwrap();
        assert!((found.distance - 3.0 * 2.0_f64.sqrt()).abs() < 0.02, "{found:?}");
        assert!(min_clearance(&ring, 10.0).is_none());
    }

    #[test]
    fn distant_curves_are_found_and_broken_ones_refused() {
        let line = |y: f64| Curve { points: vec![DVec3::Y * y, DVec3::new(1.0, y, 0.0)], closed: false };
        let far = min_clearance(&set(vec![line(0.0), line(500.0)]), 1.0).unwrap();
        assert!((far.distance - 500.0).abs() < 1e-9);
        assert!(min_clearance(&set(vec![line(0.0), line(f64::NAN)]), 1.0).is_none());
        assert!(min_clearance(&set(vec![]), 1.0).is_none());
    }

    #[test]
    fn curvature_of_a_circle_is_its_radius() {
        let radius = min_curvature_radius(&set(vec![circle(3.0, DVec3::ZERO, DVec3::Y, 200)])).unwrap();
        assert!((radius - 3.0).abs() < 0.01, "{radius}");
        let straight = Curve { points: vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], closed: false };
        assert!(min_curvature_radius(&set(vec![straight])).is_none());
    }
}
