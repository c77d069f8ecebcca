//! Centre lines and fibers: the piece as the renderer holds it, relative to an origin, its turns reduced in f64.

use super::entries::Entries;
use super::fields::{Domain, LENGTH, PHI, PIXELS, POINTS, SHARE, TWIST, VECTOR, Values, field};
use super::function::{Function, OnDevice, Shape, any, as_given, words};
use super::yarn::bare_yarn;
use crate::math::curve::{Basis, bezier_from_basis, bezier_point};
use crate::math::frame::{direction_or, normal_perpendicular_to, octahedral_from_normal};
use crate::yarn::detail::lod_factor;
use crate::yarn::fiber::{self, PieceTurns, Turns, piece_tangent, turned_normal, twist_at, yarn_point};
use crate::yarn::migration::migration_radius;
use crate::yarn::params::YarnParams;
use crate::yarn::period::migration_shape;
use crate::yarn::table::Fiber;
use glam::DVec3;
use std::f64::consts::TAU;

/// Most turns of anything over one piece: one of them in f32 keeps 1e-5 of a turn up to here.
const MOST_TURNS: f64 = 128.0;

/// Position and derivative by t of one cubic piece.
pub const CURVE_POINT: Function = Function {
    name: "curve_point",
    about: "a point of a centre line's cubic piece and its derivative by t",
    fields: &[field("control_points", POINTS), field("basis", Domain::Basis), field("t", SHARE)],
    results: &[("position", Shape::Vector), ("derivative", Shape::Vector)],
    check: any,
    exact: |mut query| {
        let (piece, t) = (Piece::new(&mut query), query.real());
        let point = bezier_point(&piece.bezier(), t);
        [point.position.to_array(), point.derivative.to_array()].concat()
    },
    device: OnDevice {
        kernel: "probe/curve_point.comp",
        given: 6,
        words: |mut query, _| {
            let piece = Piece::new(&mut query);
            let mut row = piece.words();
            row.extend(words([query.real()]));
            row
        },
        finish: |mut query, given| {
            let origin = Piece::new(&mut query).origin();
            let mut point = as_given(query, given);
            point.iter_mut().zip(origin.to_array()).for_each(|(p, o)| *p += o);
            point
        },
        table: None,
    },
};

/// Four control points of one basis.
struct Piece {
    points: [DVec3; 4],
    basis: Basis,
}

impl Piece {
    fn new(query: &mut Values<'_>) -> Self {
        let points = query.points();
        let basis = if query.whole() == Basis::CatmullRom as u32 { Basis::CatmullRom } else { Basis::Bezier };
        Self { points, basis }
    }

    fn bezier(&self) -> [DVec3; 4] {
        bezier_from_basis(&self.points, self.basis)
    }

    /// The middle of what the points span, as a scene's origin is.
    fn origin(&self) -> DVec3 {
        let [a, b, c, d] = self.points;
        0.5 * (a.min(b).min(c.min(d)) + a.max(b).max(c.max(d)))
    }

    /// Basis and points relative to the origin, subtracted in f64.
    fn words(&self) -> Vec<u32> {
        let relative = self.points.map(|p| (p - self.origin()).to_array());
        std::iter::once(self.basis as u32).chain(words(relative.into_iter().flatten())).collect()
    }
}

/// A migrating fiber of a twisted yarn.
pub const FIBER_POINT: Function = Function {
    name: "fiber_point",
    about: "centres of yarn and ply, and a migrating fiber, at t of a piece between two rest lengths of the yarn; \
            ply 0 and the fibers' angles count from normal_reference's part across the yarn at t; a negative pitch \
            turns clockwise (Wu & Yuksel 2019, Sec. 3.1)",
    fields: &[
        field("control_points", POINTS),
        field("basis", Domain::Basis),
        field("t", SHARE),
        field("length_start", LENGTH),
        field("length_end", LENGTH),
        field("normal_reference", VECTOR),
        field("yarn.ply_count", Domain::Yarn("ply_count")),
        field("yarn.yarn_radius", Domain::Yarn("yarn_radius_mm")),
        field("yarn.ply_pitch", Domain::Yarn("ply_pitch_mm")),
        field("yarn.fiber_pitch", Domain::Yarn("fiber_pitch_mm")),
        field("yarn.ellipse_short", Domain::Yarn("ellipse_short_mm")),
        field("yarn.ellipse_long", Domain::Yarn("ellipse_long_mm")),
        field("yarn.migration_min", Domain::Yarn("migration_min")),
        field("yarn.migration_max", Domain::Yarn("migration_max")),
        field("yarn.migration_rate", Domain::Yarn("migration_rate")),
        field("fiber.ply", Domain::IndexBelow("ply_count")),
        field("fiber.radius", SHARE),
        field("fiber.angle", PHI),
        field("fiber.migration_phase", PHI),
    ],
    results: &[("yarn_center", Shape::Vector), ("ply_center", Shape::Vector), ("position", Shape::Vector)],
    check: |query| FiberQuery::new(query).check(),
    exact: |query| FiberQuery::new(query).exact(),
    device: OnDevice {
        kernel: "probe/fiber_point.comp",
        given: 9,
        words: |query, _| FiberQuery::new(query).words(),
        finish: |query, given| {
            let origin = FiberQuery::new(query).piece.origin().to_array();
            let placed = as_given(query, given).into_iter().zip(origin.into_iter().cycle());
            placed.map(|(p, o)| p + o).collect()
        },
        table: None,
    },
};

/// What `fiber_point` is asked.
struct FiberQuery {
    piece: Piece,
    t: f64,
    reference: DVec3,
    turns: PieceTurns,
    yarn: YarnParams,
    fiber: Fiber,
}

impl FiberQuery {
    fn new(mut query: Values<'_>) -> Self {
        let (piece, t) = (Piece::new(&mut query), query.real());
        let (start, end) = (query.real(), query.real());
        let reference = query.vec3();
        let (ply_count, yarn_radius_mm) = (query.whole(), query.real());
        let (ply_rate, fiber_rate) = (1.0 / query.real(), 1.0 / query.real());
        let ellipse = query.vec2();
        let (migration_min, migration_max, migration_rate) = (query.real(), query.real(), query.real());
        let turns = |rate: f64| Turns { start: rate * start, delta: rate * (end - start) };
        Self {
            piece,
            t,
            reference,
            turns: PieceTurns {
                ply: turns(ply_rate),
                fiber: turns(fiber_rate),
                migration: turns(migration_rate * fiber_rate),
            },
            yarn: YarnParams {
                yarn_radius_mm,
                migration_min,
                migration_max,
                ..bare_yarn(ply_count, ellipse)
            },
            // Drawn between 0 and a turn where the renderer makes them.
            fiber: Fiber {
                ply: query.whole(),
                radius: query.real(),
                angle: query.real().rem_euclid(TAU),
                migration_phase: query.real().rem_euclid(TAU),
            },
        }
    }

    fn check(&self) -> Result<(), String> {
        let PieceTurns { ply, fiber, migration } = self.turns;
        let most = [ply, fiber, migration].map(|turns| turns.delta.abs()).into_iter().fold(0.0, f64::max);
        if most > MOST_TURNS {
            let lengths = "length_end - length_start";
            return Err(format!(
                "{lengths}: expected at most {MOST_TURNS} turns over the piece, found {most}"
            ));
        }
        let (low, high) = (self.yarn.migration_min, self.yarn.migration_max);
        if low > high {
            return Err(format!("yarn.migration_max = {high}: expected at least migration_min = {low}"));
        }
        if self.fiber.ply >= self.yarn.ply_count {
            let (ply, count) = (self.fiber.ply, self.yarn.ply_count);
            return Err(format!("fiber.ply = {ply}: expected less than ply_count = {count}"));
        }
        if direction_or(self.reference, DVec3::ZERO) == DVec3::ZERO {
            return Err(format!("normal_reference = {}: expected a direction", self.reference));
        }
        Ok(())
    }

    /// Normals at the piece's two knots, which the renderer carries, such that at t they come to the reference's
    /// part across the yarn.
    fn knot_normals(&self) -> [DVec3; 2] {
        let b = self.piece.bezier();
        let tangent = piece_tangent(&b, bezier_point(&b, self.t).derivative);
        let normal = normal_perpendicular_to(tangent, direction_or(self.reference, DVec3::X));
        self.knot_tangents().map(|knot| direction_or(turned_normal(tangent, knot, normal), normal))
    }

    fn knot_tangents(&self) -> [DVec3; 2] {
        let b = self.piece.bezier();
        [b[1] - b[0], b[3] - b[2]].map(|leg| piece_tangent(&b, leg))
    }

    fn exact(&self) -> Vec<f64> {
        let yarn_at = yarn_point(&self.piece.bezier(), self.knot_normals(), self.t);
        let twist = twist_at(&self.turns, self.t);
        let shape = migration_shape(&self.fiber, twist.migration, twist.migration_rate, &self.yarn);
        let point = fiber::fiber_point(&yarn_at, &twist, &self.yarn, &self.fiber, &shape);
        [point.yarn_center, point.ply_center, point.position].into_iter().flat_map(|p| p.to_array()).collect()
    }

    fn words(&self) -> Vec<u32> {
        let mut row = self.piece.words();
        let knots = self.knot_normals().into_iter().zip(self.knot_tangents());
        row.extend(knots.map(|(normal, tangent)| octahedral_from_normal(normal, tangent)));
        row.extend(words([self.t]));
        let PieceTurns { ply, fiber, migration } = self.turns;
        for turns in [ply, fiber, migration] {
            row.extend(words([turns.start.rem_euclid(1.0), turns.delta]));
        }
        row.push(self.yarn.ply_count);
        let y = &self.yarn;
        row.extend(words([y.ply_offset_mm(), y.ellipse_short_mm, y.ellipse_long_mm]));
        row.extend(words([y.migration_min, y.migration_max]));
        row.extend(words([self.fiber.radius, self.fiber.angle, self.fiber.migration_phase]));
        row.push(self.fiber.ply);
        row
    }
}

/// R of a migrating fiber.
pub const MIGRATION_RADIUS: Function = Function {
    name: "migration_radius",
    about: "a migrating fiber's distance from its ply's centre (Wu & Yuksel 2019, Eq. 2, with a phase of its own)",
    fields: &[
        field("twist_angle", TWIST),
        field("radius", SHARE),
        field("migration_phase", PHI),
        field("migration_rate", Domain::Yarn("migration_rate")),
        field("migration_min", Domain::Yarn("migration_min")),
        field("migration_max", Domain::Yarn("migration_max")),
    ],
    results: &[("radius", Shape::Number)],
    check: |query| {
        let [_, _, low, high] = migration(query);
        let wrong = || format!("migration_max = {high}: expected at least migration_min = {low}");
        if low <= high { Ok(()) } else { Err(wrong()) }
    },
    exact: |query| {
        let [radius, phase, low, high] = migration(query);
        vec![migration_radius(radius, phase, low, high).0]
    },
    device: OnDevice {
        kernel: "test/functions/migration_radius.comp",
        given: 2,
        words: |query, _: &Entries| words(migration(query)),
        finish: |query, given| as_given(query, &given[..1]),
        table: None,
    },
};

/// R_i, the phase reduced to a turn, R_min and R_max.
fn migration(mut query: Values<'_>) -> [f64; 4] {
    let (twist, radius, phase, rate) = (query.real(), query.real(), query.real(), query.real());
    [radius, (rate * twist + phase).rem_euclid(TAU), query.real(), query.real()]
}

/// How much of a yarn is drawn.
pub const LOD_FACTOR: Function = Function {
    name: "lod_factor",
    about: "share of fibers drawn one by one, by widths in the picture (Wu & Yuksel 2019, Eq. 4)",
    fields: &[field("width_lod", PIXELS), field("width_fiber", PIXELS), field("width_ply", PIXELS)],
    results: &[("factor", Shape::Number)],
    check: any,
    exact: |mut query| {
        let (threshold, fiber_px, ply_px) = (query.real(), query.real(), query.real());
        vec![lod_factor(fiber_px, ply_px, threshold)]
    },
    device: OnDevice {
        kernel: "test/functions/lod_factor.comp",
        given: 1,
        words: |mut query, _| {
            let (threshold, fiber_px, ply_px) = (query.real(), query.real(), query.real());
            words([fiber_px, ply_px, threshold])
        },
        finish: as_given,
        table: None,
    },
};
