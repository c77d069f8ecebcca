//! Centre lines made ready for fibers: windows of control points, rest lengths, turns and frames.

use super::cusps::opened;
use super::fiber::{PieceTurns, Turns, piece_tangent};
use super::params::YarnParams;
use super::transport::{close_normals, knot_normals};
use crate::math::curve::{Basis, Curve, arc_length, bezier_from_basis};
use crate::math::rng::Rng;
use glam::DVec3;
use rayon::prelude::*;

/// Migrations after which the periods of an open curve count from 0 again, their random identities with them: with
/// up to 64 periods to each, four numbers a period fit 32 bits. A closed curve may have no more.
pub const MOST_MIGRATIONS: u32 = 1 << 22;

/// One cubic piece of a yarn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Index of the first of its four control points in [`Strands::points`].
    pub first_point: usize,
    /// The curve it belongs to.
    pub curve: usize,
    /// Rest length of the curve before this piece, in mm.
    pub length_start_mm: f64,
    /// Rest length of this piece, in mm.
    pub length_mm: f64,
    /// Rotations at its start and over it.
    pub turns: PieceTurns,
}

/// Turns along one curve: plies, fibers and migration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurveTurns {
    /// Turns at its start, in [0, 1).
    pub phases: [f64; 3],
    /// Turns per mm.
    pub rates: [f64; 3],
    /// Its rest length.
    pub length_mm: f64,
}

/// All yarns of a fabric, ready to carry fibers.
#[derive(Clone, Debug, PartialEq)]
pub struct Strands {
    /// How the windows of four points are to be read. Never `Polyline`: see [`strands`].
    pub basis: Basis,
    /// Control points in mm with phantom and wrapped ones in place, so that every piece reads four in a
    /// row.
    pub points: Vec<DVec3>,
    /// Unit normal of the knot at each control point; arbitrary at points that are no knot.
    pub normals: Vec<DVec3>,
    /// The pieces, curve by curve.
    pub pieces: Vec<Piece>,
    /// Control points as given, without phantom ones.
    pub control_point_count: usize,
    /// For each curve, whether its last point joins its first.
    pub closed: Vec<bool>,
    /// For each curve, how many migrations of the fibers' radius it closes after; an open one [`MOST_MIGRATIONS`]
    /// where it has more than that, and 0 where it has not.
    pub period_counts: Vec<u32>,
    /// What the turns of each curve's pieces follow from: all that the device is told of them.
    pub curves: Vec<CurveTurns>,
}

impl Strands {
    /// The four control points of a piece.
    pub fn window(&self, piece: &Piece) -> [DVec3; 4] {
        std::array::from_fn(|k| self.points[piece.first_point + k])
    }

    /// A piece as a Bezier curve.
    pub fn bezier(&self, piece: &Piece) -> [DVec3; 4] {
        bezier_from_basis(&self.window(piece), self.basis)
    }

    /// Unit normals at the two knots of a piece.
    pub fn knot_normals(&self, piece: &Piece) -> [DVec3; 2] {
        knot_offsets(self.basis).map(|k| self.normals[piece.first_point + k])
    }

    /// Which two of a piece's four points carry the normals of its knots.
    pub fn knot_offsets(&self) -> [usize; 2] {
        knot_offsets(self.basis)
    }

    /// Unit tangent of the knot at each control point, as the piece behind it has it; +X at points that are no knot.
    pub fn knot_tangents(&self) -> Vec<DVec3> {
        self.knot_tangents_at(&self.points)
    }

    /// The same with the strands' points elsewhere: as many as there are.
    pub fn knot_tangents_at(&self, points: &[DVec3]) -> Vec<DVec3> {
        let mut tangents = vec![DVec3::X; points.len()];
        let [start, end] = knot_offsets(self.basis);
        let of_piece = |piece: &Piece| {
            let window = std::array::from_fn(|k| points[piece.first_point + k]);
            let b = bezier_from_basis(&window, self.basis);
            [piece_tangent(&b, b[1] - b[0]), piece_tangent(&b, b[3] - b[2])]
        };
        for pieces in self.pieces.chunks(PIECES_AT_A_TIME) {
            let made: Vec<[DVec3; 2]> = pieces.par_iter().map(of_piece).collect();
            // The piece behind a knot has the last word.
            for (piece, [at_start, at_end]) in pieces.iter().zip(made) {
                tangents[piece.first_point + end] = at_end;
                tangents[piece.first_point + start] = at_start;
            }
        }
        tangents
    }
}

/// Which two of a window's points carry the normals of the piece's knots.
fn knot_offsets(basis: Basis) -> [usize; 2] {
    if basis == Basis::Bezier { [0, 3] } else { [1, 2] }
}

/// The curve's control points with what its windows need besides: the neighbours across the closing
/// point, or phantom points reflected at open ends.
fn window_points(curve: &Curve, basis: Basis) -> Vec<DVec3> {
    let p = &curve.points;
    let n = p.len();
    let mut points = Vec::with_capacity(n + 3);
    match (basis, curve.closed) {
        (Basis::Bezier, closed) => {
            points.extend_from_slice(p);
            points.extend(closed.then(|| p[0]));
        }
        (_, true) => {
            points.push(p[n - 1]);
            points.extend_from_slice(p);
            points.extend([p[0], p[1 % n]]);
        }
        (_, false) => {
            points.push(2.0 * p[0] - p[1]);
            points.extend_from_slice(p);
            points.push(2.0 * p[n - 1] - p[n - 2]);
        }
    }
    points
}

/// Turns per mm so that a closed curve of `length_mm` makes a whole number of them, at least one; an
/// open or untwisted curve keeps its own.
fn closed_rate(turns_per_mm: f64, length_mm: f64, closed: bool) -> f64 {
    let turns = turns_per_mm * length_mm;
    if !closed || turns == 0.0 || length_mm <= 0.0 {
        return turns_per_mm;
    }
    turns.abs().round().max(1.0).copysign(turns) / length_mm
}

/// Prepares all curves (in mm) of a fabric. A polyline is read as Catmull-Rom through its points: its
/// corners would tear the cross-sections apart. Curves of fewer than two points, or a Bezier curve
/// without a whole piece, are left out. `seed` gives each curve its own phase.
pub fn strands(curves: &[Curve], basis: Basis, yarn: &YarnParams, seed: u64) -> Strands {
    let basis = if basis == Basis::Polyline { Basis::CatmullRom } else { basis };
    let mut all = Strands {
        basis,
        points: Vec::new(),
        normals: Vec::new(),
        pieces: Vec::new(),
        control_point_count: curves.iter().map(|c| c.points.len()).sum(),
        closed: curves.iter().map(|curve| curve.closed).collect(),
        period_counts: vec![0; curves.len()],
        curves: vec![CurveTurns::default(); curves.len()],
    };
    // At most three points more than given to each, and no more pieces than that.
    let most = all.control_point_count + 3 * curves.len();
    all.points.reserve(most);
    all.normals.reserve(most);
    all.pieces.reserve(if basis == Basis::Bezier { most / 3 } else { most });
    // Some curves at a time: what they are made of is then not held for all of them at once.
    for (start, some) in (0..).step_by(AT_A_TIME).zip(curves.chunks(AT_A_TIME)) {
        let made: Vec<_> = some
            .par_iter()
            .enumerate()
            .filter(|(_, curve)| curve.points.len() >= 2)
            .map(|(k, curve)| (start + k, prepared(start + k, curve, basis, yarn, seed)))
            .collect();
        made.into_iter().for_each(|(index, made)| append(&mut all, index, made));
    }
    all
}

/// Curves that are made ready together.
const AT_A_TIME: usize = 64;
/// Pieces whose tangents are found together.
const PIECES_AT_A_TIME: usize = 1 << 16;

/// One curve made ready; its pieces count points from its own first.
struct Prepared {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    pieces: Vec<Piece>,
    period_count: u32,
    turns: CurveTurns,
}

fn append(all: &mut Strands, index: usize, made: Prepared) {
    let first_point = all.points.len();
    all.pieces.extend(
        made.pieces.into_iter().map(|piece| Piece { first_point: first_point + piece.first_point, ..piece }),
    );
    all.points.extend(made.points);
    all.normals.extend(made.normals);
    all.period_counts[index] = made.period_count;
    all.curves[index] = made.turns;
}

fn prepared(index: usize, curve: &Curve, basis: Basis, yarn: &YarnParams, seed: u64) -> Prepared {
    let curve = &*opened(curve, basis);
    let points = window_points(curve, basis);
    let stride = basis.point_stride();
    let starts: Vec<usize> = (0..points.len().saturating_sub(3)).step_by(stride).collect();
    let window = |&first: &usize| -> [DVec3; 4] { std::array::from_fn(|k| points[first + k]) };
    let beziers: Vec<_> = starts.iter().map(|s| bezier_from_basis(&window(s), basis)).collect();
    let lengths: Vec<f64> = beziers.iter().map(|b| arc_length(b, Basis::Bezier, 0.0, 1.0)).collect();
    let total: f64 = lengths.iter().sum();

    let mut knots = knot_normals(&beziers);
    if curve.closed {
        close_normals(&beziers, &lengths, &mut knots);
    }
    let mut normals = vec![DVec3::X; points.len()];
    for (k, start) in starts.iter().enumerate() {
        for (offset, knot) in knot_offsets(basis).into_iter().zip([k, k + 1]) {
            normals[start + offset] = knots[knot];
        }
    }

    let rates = rates(yarn, total, curve.closed);
    let migrations = (rates[2] * total).abs();
    let wraps = migrations > f64::from(MOST_MIGRATIONS);
    let period_count = match curve.closed {
        true => migrations.round() as u32,
        false if wraps => MOST_MIGRATIONS,
        false => 0,
    };
    let mut rng = Rng::new(seed, &[index as u64]);
    let phases: [f64; 3] = std::array::from_fn(|_| rng.uniform());
    let wrapped = |turns: Turns| match wraps {
        true => Turns { start: turns.start.rem_euclid(f64::from(MOST_MIGRATIONS)), ..turns },
        false => turns,
    };
    let mut length_start_mm = 0.0;
    let mut pieces = Vec::with_capacity(starts.len());
    for (&first_point, length_mm) in starts.iter().zip(lengths) {
        let turns = |which: usize| Turns {
            start: phases[which] + rates[which] * length_start_mm,
            delta: rates[which] * length_mm,
        };
        pieces.push(Piece {
            first_point,
            curve: index,
            length_start_mm,
            length_mm,
            turns: PieceTurns { ply: turns(0), fiber: turns(1), migration: wrapped(turns(2)) },
        });
        length_start_mm += length_mm;
    }
    let turns = CurveTurns { phases, rates, length_mm: total };
    Prepared { points, normals, pieces, period_count, turns }
}

/// Turns per mm of plies, fibers and migration for one curve.
fn rates(yarn: &YarnParams, length_mm: f64, closed: bool) -> [f64; 3] {
    let fiber = yarn.fiber_turns_per_mm();
    [yarn.ply_turns_per_mm(), fiber, yarn.migration_rate * fiber].map(|r| closed_rate(r, length_mm, closed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::fetch::FiberField;
    use crate::yarn::presets;
    use std::f64::consts::TAU;

    fn wavy_loop() -> Curve {
        let points = (0..60)
            .map(|i| {
                let u = TAU * f64::from(i) / 60.0;
                DVec3::new(
                    (10.0 + (4.0 * u).cos()) * u.cos(),
                    (10.0 + (4.0 * u).cos()) * u.sin(),
                    (7.0 * u).sin(),
                )
            })
            .collect();
        Curve { points, closed: true }
    }

    #[test]
    fn neighbouring_pieces_meet_for_every_basis() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        for basis in [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline] {
            for closed in [true, false] {
                let mut curve = wavy_loop();
                curve.closed = closed;
                if basis == Basis::Bezier && !closed {
                    curve.points.truncate(58);
                }
                let field = FiberField::new(strands(&[curve], basis, &yarn, 9), &yarn, 9);
                for pair in field.strands.pieces.windows(2) {
                    let (end, begin) =
                        (field.fiber_at(&pair[0], 7, 1.0).0, field.fiber_at(&pair[1], 7, 0.0).0);
                    // A Bezier chain through arbitrary points has corners; its centre line still meets.
                    let gap = if basis == Basis::Bezier {
                        (end.yarn_center - begin.yarn_center).length()
                    } else {
                        (end.position - begin.position).length()
                    };
                    assert!(gap < 1e-9, "{basis:?} closed {closed}: gap {gap}");
                }
            }
        }
    }

    #[test]
    fn an_open_curve_reaches_its_ends() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let curve = Curve { points: vec![DVec3::ZERO, DVec3::X, DVec3::new(2.0, 1.0, 0.0)], closed: false };
        for basis in [Basis::CatmullRom, Basis::BSpline] {
            let strands = strands(std::slice::from_ref(&curve), basis, &yarn, 0);
            assert_eq!(strands.pieces.len(), 2);
            assert!((strands.bezier(&strands.pieces[0])[0] - curve.points[0]).length() < 1e-14);
            assert!((strands.bezier(&strands.pieces[1])[3] - curve.points[2]).length() < 1e-14);
        }
    }

    #[test]
    fn a_hundred_kilometres_of_yarn_twist_as_crisply_at_the_end_as_at_the_start() {
        // Pieces of 5 m: the last one starts after 99,995 m, 20 million turns of this yarn.
        let mut yarn = presets::yarn("worsted_3ply").unwrap();
        yarn.ply_pitch_mm = Some(5.0);
        yarn.fiber_pitch_mm = Some(4.0);
        yarn.migration_rate = 1.0;
        let points = (0..=20_000).map(|i| DVec3::X * (f64::from(i) * 5000.0)).collect();
        let strands = strands(&[Curve { points, closed: false }], Basis::CatmullRom, &yarn, 3);
        let (first, last) = (&strands.pieces[0].turns, &strands.pieces[19_999].turns);
        // Whole numbers of turns lie between the two starts.
        for (a, b) in [(first.ply, last.ply), (first.fiber, last.fiber), (first.migration, last.migration)] {
            let apart = (b.start - a.start).abs();
            assert!(apart > 1e6 && (apart - apart.round()).abs() < 1e-6, "{apart}");
        }
        assert!(last.ply.start.abs() > 1e7 && last.migration.start < f64::from(MOST_MIGRATIONS));
        assert_eq!(strands.period_counts, [MOST_MIGRATIONS]);
    }

    #[test]
    fn periods_that_count_anew_leave_no_seam() {
        // 5.2 million migrations of this yarn, clockwise and not, cut where they begin to count anew.
        for clockwise in [false, true] {
            let mut yarn = presets::yarn("cotton1").unwrap();
            (yarn.fiber_pitch_mm, yarn.fiber_clockwise, yarn.migration_rate) = (Some(1.0), clockwise, 1.0);
            let points = (0..=5200).map(|i| DVec3::X * (f64::from(i) * 1000.0)).collect();
            let field = FiberField::new(
                strands(&[Curve { points, closed: false }], Basis::CatmullRom, &yarn, 3),
                &yarn,
                3,
            );
            let pieces = &field.strands.pieces;
            let starts = |p: &Piece| p.turns.migration.start;
            let seam = pieces.windows(2).position(|p| (starts(&p[1]) - starts(&p[0])).abs() > 1e6).unwrap();
            for pair in [&pieces[seam..seam + 2], &pieces[7..9]] {
                for fiber in 0..field.fibers.len() {
                    let ((a, end), (b, start)) =
                        (field.fiber_at(&pair[0], fiber, 1.0), field.fiber_at(&pair[1], fiber, 0.0));
                    assert!((a.position - b.position).length() < 1e-5, "fiber {fiber}");
                    let drawn = |p: crate::yarn::period::Period| (p.kind, p.reach, p.share, p.root_first);
                    assert_eq!(drawn(end), drawn(start), "fiber {fiber}");
                }
            }
        }
    }

    #[test]
    fn short_closed_curves_make_at_least_one_turn() {
        assert_eq!(closed_rate(-0.01, 10.0, true), -0.1);
        assert_eq!(closed_rate(0.26, 10.0, true), 0.3);
        assert_eq!(closed_rate(0.26, 10.0, false), 0.26);
        assert_eq!(closed_rate(0.0, 10.0, true), 0.0);
    }
}
