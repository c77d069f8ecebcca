//! Curves as fine polylines that still know where on the yarn they are.

use glam::DVec3;

use crate::io::curves::{Basis, Curve, CurveSet};
use crate::math::curve::{CurvePoint, curve_point};

/// A place on a yarn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnYarn {
    /// Index of the curve in its set.
    pub curve: usize,
    /// Where along it, counted in control points (2.5 is half-way from point 2 to point 3).
    pub parameter: f64,
    /// Arc length from the curve's start, in the curve's unit.
    pub arc: f64,
    /// The place itself.
    pub position: DVec3,
}

/// The cubic pieces of a curve, in order, each with the control-point number that it starts at. An
/// open Catmull-Rom curve passes through its end points: the missing neighbour is mirrored about them.
pub(crate) fn pieces(curve: &Curve, basis: Basis) -> Vec<(f64, [DVec3; 4])> {
    let p = &curve.points;
    let n = p.len();
    if n < 2 {
        return Vec::new();
    }
    let at = |i: i64| match i {
        _ if curve.closed => p[i.rem_euclid(n as i64) as usize],
        i if i < 0 => 2.0 * p[0] - p[1],
        i if i >= n as i64 => 2.0 * p[n - 1] - p[n - 2],
        i => p[i as usize],
    };
    let last = if curve.closed { n } else { n - 1 };
    let (first, last, step, lead) = match basis {
        Basis::CatmullRom | Basis::Polyline => (0, last, 1, 1),
        Basis::BSpline if curve.closed => (0, n, 1, 1),
        Basis::BSpline => (1, n.saturating_sub(2), 1, 1),
        Basis::Bezier => (0, last, 3, 0),
    };
    (first..last)
        .step_by(step)
        .map(|i| (i as f64, std::array::from_fn(|k| at(i as i64 + k as i64 - lead))))
        .collect()
}

/// One cubic piece as a chain of chords.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    /// Where its points lie on the yarn; one more than there are chords.
    pub(crate) points: Vec<OnYarn>,
    /// Middle of the box around them.
    pub(crate) centre: DVec3,
    /// No point is farther than this from `centre`.
    pub(crate) radius: f64,
    /// Length of the whole curve where it is closed.
    pub(crate) closed_length: Option<f64>,
}

/// Every piece of every curve, each cut into `chords` chords.
pub(crate) fn chains(set: &CurveSet, chords: usize) -> Vec<Chain> {
    let mut all = Vec::new();
    for (index, curve) in set.curves.iter().enumerate() {
        let begin = all.len();
        let mut arc = 0.0;
        for (start, quad) in pieces(curve, set.basis) {
            let mut points: Vec<OnYarn> = Vec::with_capacity(chords + 1);
            for k in 0..=chords {
                let t = k as f64 / chords as f64;
                let CurvePoint { position, .. } = curve_point(&quad, set.basis, t);
                arc += points.last().map_or(0.0, |before| before.position.distance(position));
                points.push(OnYarn { curve: index, parameter: start + t, arc, position });
            }
            let low = points.iter().fold(DVec3::INFINITY, |m, p| m.min(p.position));
            let high = points.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(p.position));
            let centre = 0.5 * (low + high);
            let radius = points.iter().fold(0.0, |m: f64, p| m.max(p.position.distance(centre)));
            all.push(Chain { points, centre, radius, closed_length: None });
        }
        if curve.closed {
            all[begin..].iter_mut().for_each(|chain| chain.closed_length = Some(arc));
        }
    }
    all
}

/// Pairs (i < j) of the given points that are at most `reach` apart, by a uniform grid; also i = j.
pub(crate) fn near_pairs(points: &[DVec3], reach: f64, mut visit: impl FnMut(usize, usize)) {
    let mut grid: std::collections::HashMap<[i64; 3], Vec<usize>> = std::collections::HashMap::new();
    let cell = |p: DVec3| (p / reach).floor().to_array().map(|c| c as i64);
    for (i, &p) in points.iter().enumerate() {
        let home = cell(p);
        for offset in 0..27_i64 {
            let key = [home[0] + offset % 3 - 1, home[1] + offset / 3 % 3 - 1, home[2] + offset / 9 - 1];
            for &j in grid.get(&key).into_iter().flatten() {
                if points[j].distance_squared(p) <= reach * reach {
                    visit(j, i);
                }
            }
        }
        visit(i, i);
        grid.entry(home).or_default().push(i);
    }
}
