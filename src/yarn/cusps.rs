//! Centre lines that stop and turn back at a point, opened to the tightest hairpin whose turn f32 can follow: around a
//! point the yarn's cross-section would change sides at once, and its fibers would be cut straight across.

use crate::math::curve::{Basis, Curve, bezier_point};
use crate::math::frame::{any_perpendicular, direction_or};
use glam::DVec3;
use std::borrow::Cow;

/// Share of a piece over which an opened cusp makes a quarter of its turn.
const OPENED_WIDTH: f64 = 2e-4;
/// Share over which nothing is opened yet.
const SHARP_WIDTH: f64 = 1e-4;
/// Steps toward the place where a piece is slowest, and cusps this near to a piece's end are left: they are its knot's.
const SPOT_STEPS: u32 = 12;
const NEAR_KNOT: f64 = 0.05;

/// The curve with its cusps opened: points move by less than a thousandth of their piece, and only beside cusps.
pub fn opened(curve: &Curve, basis: Basis) -> Cow<'_, Curve> {
    let mut opened = Cow::Borrowed(curve);
    if basis == Basis::Bezier {
        for first in (0..curve.points.len().saturating_sub(3)).step_by(3) {
            let b = std::array::from_fn(|k| curve.points[first + k]);
            if let Some((which, to)) = opened_piece(&b) {
                opened.to_mut().points[first + which] = to;
            }
        }
        return opened;
    }
    let count = curve.points.len();
    let interior = if curve.closed { 0..count } else { 1..count.saturating_sub(1) };
    for k in interior.filter(|_| count > 2) {
        let [before, at, next] = [k + count - 1, k, k + 1].map(|k| opened.points[k % count]);
        if let Some(to) = opened_knot(before, at, next) {
            opened.to_mut().points[(k + 1) % count] = to;
        }
    }
    opened
}

/// Where `next` goes for the line to pass `at` sideways, if it stands still there: the derivative at a knot is half of
/// what its neighbours are apart, in Catmull-Rom curves and B-splines alike.
fn opened_knot(before: DVec3, at: DVec3, next: DVec3) -> Option<DVec3> {
    let bend = before - 2.0 * at + next;
    let sharp = 0.5 * (next - before).length() < SHARP_WIDTH * bend.length();
    let along = direction_or(bend, DVec3::ZERO);
    (sharp && along != DVec3::ZERO).then(|| {
        let sideways = 2.0 * OPENED_WIDTH * bend.length() * any_perpendicular(along);
        before + sideways
    })
}

/// Which middle point of a Bezier piece goes where, if the piece stands still inside.
fn opened_piece(b: &[DVec3; 4]) -> Option<(usize, DVec3)> {
    let mut t = 0.5;
    for _ in 0..SPOT_STEPS {
        let c = bezier_point(b, t);
        let bend = c.second_derivative.length_squared();
        if bend <= 0.0 {
            return None;
        }
        t = (t - c.derivative.dot(c.second_derivative) / bend).clamp(0.0, 1.0);
    }
    let c = bezier_point(b, t);
    let along = direction_or(c.second_derivative, DVec3::ZERO);
    let bend = c.second_derivative.length();
    let sharp = c.derivative.length() < SHARP_WIDTH * bend;
    if !sharp || along == DVec3::ZERO || !(NEAR_KNOT..=1.0 - NEAR_KNOT).contains(&t) {
        return None;
    }
    // It turns on the side on which it goes on.
    let chord = (b[3] - b[0]).reject_from_normalized(along);
    let sideways = direction_or(chord, any_perpendicular(along));
    // d derivative / d b[2] = 3 t (2 - 3 t), and the same from the other end.
    let (which, s) = if t < 0.5 { (2, t) } else { (1, t - 1.0) };
    let by = OPENED_WIDTH * bend / (3.0 * s * (2.0 - 3.0 * s.abs()));
    Some((which, b[which] + by * sideways))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::curve::bezier_from_basis;
    use crate::yarn::turning::turning_of;

    fn curve(points: &[[f64; 2]], closed: bool) -> Curve {
        Curve { points: points.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect(), closed }
    }

    fn most_moved(a: &Curve, b: &Curve) -> f64 {
        a.points.iter().zip(&b.points).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    #[test]
    fn a_cusp_inside_a_piece_becomes_a_hairpin() {
        let cusp = curve(&[[-6.0, -2.0], [6.0, 5.0], [-6.0, 5.0], [6.0, -2.0]], false);
        let opened = opened(&cusp, Basis::Bezier);
        let moved = most_moved(&cusp, &opened);
        assert!(moved > 0.0 && moved < 0.02, "{moved} mm");
        let b = [0, 1, 2, 3].map(|k| opened.points[k]);
        let turning = turning_of(&b);
        let width = turning.widths.min_element();
        assert!((width / OPENED_WIDTH - 1.0).abs() < 0.1, "{turning:?}");
        let middle = bezier_point(&b, turning.places.x).derivative.normalize();
        assert!(middle.x > 0.99, "turns on the side on which it goes on: {middle}");
    }

    #[test]
    fn a_line_that_goes_back_on_itself_turns_at_its_knots() {
        for basis in [Basis::CatmullRom, Basis::BSpline] {
            let back = curve(&[[0.0, 0.0], [5.0, 0.0], [0.0, 0.0], [5.0, 0.0], [0.0, 0.0]], false);
            let opened = opened(&back, basis);
            assert!(most_moved(&back, &opened) < 0.01);
            for window in opened.points.windows(4) {
                let b = bezier_from_basis(&[window[0], window[1], window[2], window[3]], basis);
                for leg in [b[1] - b[0], b[3] - b[2]] {
                    assert!(leg.length() > 1e-4, "{basis:?}: stands still in {b:?}");
                }
            }
        }
    }

    #[test]
    fn other_curves_are_left_as_they_are() {
        let hairpin = [[0.0, 0.0], [9.0, 0.0], [0.0, 1.6], [9.0, 1.6], [9.0, 1.6], [9.0, 1.6]];
        for basis in [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline] {
            for closed in [false, true] {
                for points in [&hairpin[..4], &hairpin, &[[1.0, 1.0]; 6][..], &hairpin[..2]] {
                    let curve = curve(points, closed);
                    assert!(matches!(opened(&curve, basis), Cow::Borrowed(_)), "{basis:?} {points:?}");
                }
            }
        }
    }
}
