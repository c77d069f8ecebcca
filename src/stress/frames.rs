//! Frames carried along a million pieces, against what geometry says they come to.

use super::verdict::{Collector, Row};
use crate::math::curve::{Basis, arc_length};
use crate::yarn::fiber::piece_tangent;
use crate::yarn::transport::{close_normals, knot_normals};
use glam::DVec3;
use std::f64::consts::TAU;

const GROUP: &str = "frames";
/// Pieces to a turn of a helix.
const PIECES_PER_TURN: f64 = 64.0;
/// Most that a frame may turn, per piece, from what the curve's torsion says; radians. Stepping a curve of 64 pieces a
/// turn is good to a few 1e-9.
const DRIFT_PER_PIECE: f64 = 1e-8;

/// All rows.
pub fn rows(quick: bool) -> Vec<Row> {
    let count: u32 = if quick { 50_000 } else { 1_000_000 };
    vec![helix(count), straight(count), torus(count / 10)]
}

/// A Bezier piece between two parameters of a curve, by its derivative.
fn piece(a: f64, b: f64, at: impl Fn(f64) -> DVec3, slope: impl Fn(f64) -> DVec3) -> [DVec3; 4] {
    let h = (b - a) / 3.0;
    [at(a), at(a) + h * slope(a), at(b) - h * slope(b), at(b)]
}

fn sound(c: &mut Collector, pieces: &[[DVec3; 4]], normals: &[DVec3]) {
    for (k, (b, normal)) in pieces.iter().zip(normals).enumerate() {
        let tangent = piece_tangent(b, b[1] - b[0]);
        c.points(1);
        c.numbers(&normal.to_array(), true, || format!("knot {k}"));
        c.error((normal.length() - 1.0).abs().max(tangent.dot(*normal).abs()), 1e-9, || format!("knot {k}"));
    }
}

/// Its Frenet normal turns against the frame by the torsion times the length.
fn helix(count: u32) -> Row {
    let (radius, rise) = (1.0, 1.0 / TAU);
    let at = |a: f64| DVec3::new(radius * a.cos(), radius * a.sin(), rise * a);
    let slope = |a: f64| DVec3::new(-radius * a.sin(), radius * a.cos(), rise);
    let step = TAU / PIECES_PER_TURN;
    let pieces: Vec<_> =
        (0..count).map(|i| piece(step * f64::from(i), step * f64::from(i + 1), at, slope)).collect();
    let normals = knot_normals(&pieces);
    let mut c = Collector::default();
    sound(&mut c, &pieces, &normals);
    let from_frenet = |k: usize| {
        let a = step * k as f64;
        let inward = DVec3::new(-a.cos(), -a.sin(), 0.0);
        let tangent = slope(a).normalize();
        inward.cross(normals[k]).dot(tangent).atan2(inward.dot(normals[k]))
    };
    let per_piece = step * rise / radius.hypot(rise);
    let start = from_frenet(0);
    let mut drift: f64 = 0.0;
    for k in 1..normals.len() {
        let off = (from_frenet(k) - start + per_piece * k as f64).rem_euclid(TAU);
        drift = drift.max(off.min(TAU - off) / k as f64);
    }
    c.error(drift, DRIFT_PER_PIECE, || "radians per piece".to_owned());
    c.row(GROUP, "transport", &format!("{count} pieces of a helix"), "drift of at most 1e-8 rad a piece")
}

/// Nothing turns it.
fn straight(count: u32) -> Row {
    let toward = DVec3::new(0.6, -0.48, 0.64);
    let pieces: Vec<_> = (0..count)
        .map(|i| std::array::from_fn(|k| toward * (0.1 * (f64::from(i) + k as f64 / 3.0))))
        .collect();
    let normals = knot_normals(&pieces);
    let mut c = Collector::default();
    sound(&mut c, &pieces, &normals);
    for (k, normal) in normals.iter().enumerate() {
        c.error((*normal - normals[0]).length(), 1e-6, || format!("knot {k}"));
    }
    c.row(GROUP, "transport", &format!("{count} collinear pieces"), "no turn")
}

/// A closed curve comes back to its first normal.
fn torus(count: u32) -> Row {
    let at = |u: f64| {
        let (a, b) = (TAU * u, 7.0 * TAU * u);
        DVec3::new((3.0 + b.cos()) * a.cos(), (3.0 + b.cos()) * a.sin(), b.sin())
    };
    let slope = |u: f64| (at(u + 1e-6) - at(u - 1e-6)) / 2e-6;
    let pieces: Vec<_> = (0..count)
        .map(|i| piece(f64::from(i) / f64::from(count), f64::from(i + 1) / f64::from(count), at, slope))
        .collect();
    let lengths: Vec<f64> = pieces.iter().map(|b| arc_length(b, Basis::Bezier, 0.0, 1.0)).collect();
    let mut normals = knot_normals(&pieces);
    close_normals(&pieces, &lengths, &mut normals);
    let mut c = Collector::default();
    for (k, normal) in normals.iter().enumerate() {
        c.points(1);
        c.numbers(&normal.to_array(), true, || format!("knot {k}"));
    }
    let gap = normals.first().zip(normals.last()).map_or(f64::NAN, |(a, b)| (*a - *b).length());
    c.error(gap, 1e-6, || "the closing point".to_owned());
    c.row(GROUP, "transport", &format!("a closed curve of {count} pieces"), "meets itself")
}
