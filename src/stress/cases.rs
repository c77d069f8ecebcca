//! Whole yarns at their worst: what centre lines and cross-sections may be, in mm.

use super::inputs::shapes;
use crate::io::curves::{CurveSet, UpAxis};
use crate::math::curve::{Basis, Curve};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// One yarn, or several.
pub struct Case {
    /// What is extreme about it.
    pub name: String,
    /// How extreme, in words.
    pub domain: String,
    /// What its scene's `[yarn]` table says, line by line.
    pub yarn: String,
    /// Its centre lines.
    pub curves: CurveSet,
    /// Whether all of its fibers go on without a jump from piece to piece: no cusp, no point where it doubles back.
    pub smooth: bool,
}

/// One curve.
pub fn set(basis: Basis, points: Vec<DVec3>, closed: bool) -> CurveSet {
    CurveSet { basis, up_axis: Some(UpAxis::Y), curves: vec![Curve { points, closed }] }
}

/// A curve of a few bends, of size 1.
fn wave(count: u32) -> Vec<DVec3> {
    let at = |i: u32| {
        let u = f64::from(i) / f64::from(count - 1);
        DVec3::new(u - 0.5, 0.2 * (TAU * u).sin(), 0.1 * (2.0 * TAU * u).cos())
    };
    (0..count).map(at).collect()
}

fn scaled(points: Vec<DVec3>, size: f64, away: DVec3) -> Vec<DVec3> {
    points.into_iter().map(|p| size * p + away).collect()
}

fn case(name: &str, domain: &str, yarn: &str, curves: CurveSet, smooth: bool) -> Case {
    Case { name: name.into(), domain: domain.into(), yarn: yarn.into(), curves, smooth }
}

/// Every case.
pub fn cases() -> Vec<Case> {
    [broken_lines(), sizes(), twists(), cross_sections(), loops()].into_iter().flatten().collect()
}

/// Centre lines that repeat points, double back, come to a point or do not bend at all.
fn broken_lines() -> Vec<Case> {
    let v = DVec3::new;
    let line = |xs: &[f64]| -> Vec<DVec3> { xs.iter().map(|x| v(*x, 0.0, 0.0)).collect() };
    let rom = |points| set(Basis::CatmullRom, points, false);
    let mut all = vec![
        case("a single place", "all points the same", "", rom(vec![v(1.0, 2.0, 3.0); 6]), false),
        // Uniform Catmull-Rom runs past a point that is repeated, and back.
        case(
            "repeated points",
            "each point up to four times",
            "",
            rom(line(&[0.0, 0.0, 3.0, 3.0, 3.0, 3.0, 6.0, 9.0, 9.0])),
            false,
        ),
        // Pieces a hundred thousandth of their distance from the scene's origin are beyond f32.
        case(
            "collinear points",
            "1e-3 to 6 mm apart",
            "",
            rom(line(&[0.0, 1e-3, 1.0, 1.001, 7.0, 7.001, 12.0])),
            true,
        ),
        case(
            "hairpins of 180 degrees",
            "points back on the line they came on",
            "",
            rom(line(&[0.0, 5.0, 0.0, 5.0, 0.0, 5.0])),
            false,
        ),
        case(
            "zigzag",
            "a turn of 179.9 degrees at every point",
            "",
            rom((0..40).map(|i| v(f64::from(i % 2) * 5.0, 0.004 * f64::from(i), 0.0)).collect()),
            true,
        ),
        case(
            "tight bends",
            "curvature radius 0.1 mm in a yarn of 1 mm",
            "",
            rom((0..60)
                .map(|i| {
                    let a = 0.5 * f64::from(i);
                    v(0.1 * a.cos(), 0.1 * a.sin(), 0.05 * f64::from(i))
                })
                .collect()),
            true,
        ),
        case(
            "a wild step",
            "pieces of 1e-3 and 1e4 mm side by side",
            "",
            rom(line(&[0.0, 1e-3, 2e-3, 1e4, 1e4 + 1e-3])),
            true,
        ),
    ];
    for (index, shape) in shapes().into_iter().enumerate() {
        let points = scaled(shape.to_vec(), 8.0, DVec3::ZERO);
        let name = format!("single Bezier piece {index}");
        all.push(case(
            &name,
            "cusps, repeated and returning points",
            "",
            set(Basis::Bezier, points, false),
            false,
        ));
    }
    all
}

/// A usual line of all sizes, at all distances.
fn sizes() -> Vec<Case> {
    let mut all = Vec::new();
    for size in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        // No more turns over a piece than a scene may ask for.
        let count = if size > 1e3 { 400 } else { 24 };
        let points = scaled(wave(count), size, DVec3::ZERO);
        all.push(case(
            &format!("coordinates of {size:e}"),
            "1e-6 to 1e6 mm",
            "",
            set(Basis::CatmullRom, points, false),
            true,
        ));
    }
    for away in [1e3, 1e6, 1e9] {
        let points = scaled(wave(24), 20.0, away * DVec3::new(0.8, -0.6, 0.3));
        all.push(case(
            &format!("{away:e} mm away"),
            "a yarn of 20 mm, up to 1e9 mm from the origin",
            "",
            set(Basis::BSpline, points, false),
            true,
        ));
    }
    all
}

/// Pitches from 0.01 mm to none, and long yarn.
fn twists() -> Vec<Case> {
    let mut all = Vec::new();
    for pitch in ["0.01", "0.1", "1e3", "1e9", "\"untwisted\""] {
        let yarn = format!("ply_pitch_mm = {pitch}\nfiber_pitch_mm = {pitch}");
        let points = scaled(wave(60), 20.0, DVec3::ZERO);
        all.push(case(
            &format!("pitch {pitch} mm"),
            "0.01 mm to untwisted",
            &yarn,
            set(Basis::CatmullRom, points, false),
            true,
        ));
    }
    all
}

/// Numbers of plies and their shapes.
fn cross_sections() -> Vec<Case> {
    let mut all = Vec::new();
    let curve = || set(Basis::CatmullRom, scaled(wave(24), 20.0, DVec3::ZERO), false);
    for plies in [1, 2, 5, 8] {
        all.push(case(&format!("{plies} plies"), "1 to 8", &format!("ply_count = {plies}"), curve(), true));
    }
    let shapes =
        [(0.01, 1.0, 0.78), (1.0, 0.01, 0.78), (1.2e-3, 1.0, 0.78), (0.3, 0.3, 0.78), (1e-6, 1e-6, 1e-6)];
    for (short, long, radius) in shapes {
        let yarn = format!("ellipse_short_mm = {short}\nellipse_long_mm = {long}\nyarn_radius_mm = {radius}");
        let domain = "a thousandth of the yarn and up";
        all.push(case(&format!("ellipses {short} to {long}"), domain, &yarn, curve(), true));
    }
    all.push(case("no migration", "rate 0", "migration_rate = 0", curve(), true));
    all.push(case("fast migration", "rate 100", "migration_rate = 100", curve(), true));
    all
}

/// Closed curves, large and tiny.
fn loops() -> Vec<Case> {
    let ring = |count: u32, radius: f64| -> Vec<DVec3> {
        let at = |i: u32| {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
            DVec3::new(
                radius * cos,
                radius * sin,
                0.2 * radius * (2.0 * PI * 2.0 * f64::from(i) / f64::from(count)).sin(),
            )
        };
        (0..count).map(at).collect()
    };
    [(3, 5.0), (11, 0.05), (60, 30.0), (200, 1e4)]
        .into_iter()
        .map(|(count, radius)| {
            let name = format!("a loop of {count} points");
            case(&name, "radius 0.05 mm to 10 m", "", set(Basis::CatmullRom, ring(count, radius), true), true)
        })
        .collect()
}

/// Yarn of `length_mm` in pieces of `piece_mm`, in wide bends.
pub fn long_yarn(length_mm: f64, piece_mm: f64) -> CurveSet {
    let count = (length_mm / piece_mm).round() as u32;
    let at = |i: u32| {
        let a = 0.02 * f64::from(i);
        // A coil: 314 pieces to a turn, each turn beside the last.
        let radius = piece_mm / 0.02;
        DVec3::new(radius * a.cos(), radius * a.sin(), 0.01 * piece_mm * f64::from(i))
    };
    set(Basis::CatmullRom, (0..=count).map(at).collect(), false)
}
