//! `glsl/yarn`, but for the fiber function itself.

use crate::harness::{Case, Row, number, vector};
use crate::inputs::{Random, SPECIAL_T, random_rows, row, special_pieces, special_units};
use crate::math_cases::{first_vec3, is_perpendicular, is_unit, largest, largest_difference};
use glam::{DVec3, DVec4};
use std::f64::consts::{PI, TAU};
use worsted::yarn::density;
use worsted::yarn::fiber::{self, PieceTurns, Turns};
use worsted::yarn::level::{self, Cutting};
use worsted::yarn::migration;

const FACTOR_FLOOR: f64 = 1e-3;

pub fn cases() -> Vec<Case> {
    let mut all = vec![migration_radius(), turning_angle(), subdivisions(), outside_frustum()];
    all.extend([period_pieces(), nearest_depth(), one_minus_exp(), fiber_density()]);
    all.extend([piece_tangent(), turned_normal(), twist_at(), yarn_point()]);
    all
}

fn migration_radius() -> Case {
    let mut rows = random_rows("migration_radius", |random| {
        let low = random.between(0.0, 1.0);
        let phase = random.between(0.0, 2.0 * TAU);
        row().real(random.between(0.0, 1.0)).real(phase).real(low).real(random.between(low, 1.5)).end()
    });
    for phase in [0.0, PI, TAU, 2.0 * TAU, 0.5 * PI, 1e-6] {
        rows.extend(
            [(0.0, 1.0), (1.0, 1.0), (0.8, 1.5)]
                .map(|(low, high)| row().real(1.0).real(phase).real(low).real(high).end()),
        );
    }
    Case {
        function: "migration_radius",
        rows,
        twin: |args| {
            let (radius, slope) =
                migration::migration_radius(args.real(), args.real(), args.real(), args.real());
            vec![number("radius", radius, FACTOR_FLOOR), number("slope", slope, FACTOR_FLOOR)]
        },
        invariant: None,
    }
}

fn one_minus_exp() -> Case {
    let mut rows = random_rows("one_minus_exp", |random| row().real(random.magnitude(1e-7, 1.0)).end());
    rows.extend([0.0, 1e-30, 0.249_999, 0.25, 1.0].map(|x| row().real(x).end()));
    let twin = |args: &mut crate::harness::Args<'_>| vec![number("share", -(-args.real()).exp_m1(), 1e-30)];
    Case { function: "one_minus_exp", rows, twin, invariant: None }
}

fn fiber_density() -> Case {
    let density_row =
        |radius: f64, beta: f64, epsilon: f64| row().real(radius).real(beta).real(epsilon).end();
    let mut rows = random_rows("fiber_density", |random| {
        let from_rim = random.magnitude(1e-7, 1.0);
        let beta = if random.below(2) == 0 { random.between(0.0, 1.0) } else { random.between(0.0, 20.0) };
        density_row(1.0 - from_rim, beta, random.between(0.0, 0.5))
    });
    for radius in [0.0, 0.5, 0.75, 1.0, -0.1, 1.000_001] {
        for beta in [0.0, 1e-6, 0.4, 20.0] {
            rows.extend([0.0, 0.1, 0.5].map(|epsilon| density_row(radius, beta, epsilon)));
        }
    }
    Case {
        function: "fiber_density",
        rows,
        twin: |args| {
            let value = density::fiber_density(args.real(), args.real(), args.real());
            vec![number("density", value, FACTOR_FLOOR)]
        },
        invariant: Some(|_, found| (0.0..=1.0).contains(&found[0]).then_some(()).ok_or("not a share".into())),
    }
}

/// Two vectors of any lengths: at any angle, nearly parallel, nearly opposite.
fn vector_pairs(function: &str) -> Vec<Row> {
    let mut rows = random_rows(function, |random| {
        let a = random.unit();
        let b = if random.below(3) == 0 { random.unit_near(a) } else { random.unit() };
        row().vec3(a * random.magnitude(1e-6, 1e6)).vec3(b * random.magnitude(1e-6, 1e6)).end()
    });
    for a in special_units() {
        for (s, b) in [(1.0, a), (-1.0, a), (0.0, a), (1e30, -a), (1e-30, a), (1.0, DVec3::ZERO)] {
            rows.push(row().vec3(s * a).vec3(b).end());
        }
    }
    rows
}

fn turning_angle() -> Case {
    Case {
        function: "turning_angle",
        rows: vector_pairs("turning_angle"),
        twin: |args| vec![number("angle", level::turning_angle(args.vec3(), args.vec3()), FACTOR_FLOOR)],
        invariant: None,
    }
}

/// What decides how finely a fiber of a piece about `size` mm long is cut.
fn cutting(random: &mut Random, size: f64) -> Cutting {
    Cutting {
        ply_turns: random.between(-0.5, 0.5),
        fiber_turns: random.between(-2.0, 2.0),
        ply_offset_mm: size * random.between(0.0, 1.0),
        ellipse_long_mm: size * random.between(0.1, 1.0),
        tolerance_mm: size * random.magnitude(1e-4, 1.0),
        per_turn: random.between(0.0, 12.0),
        largest: 1 + random.below(64),
    }
}

fn cut_row(b: &[DVec3; 4], c: &Cutting) -> Row {
    let turns = row().piece(b).real(c.ply_turns).real(c.fiber_turns);
    turns
        .real(c.ply_offset_mm)
        .real(c.ellipse_long_mm)
        .real(c.tolerance_mm)
        .real(c.per_turn)
        .bits(c.largest)
        .end()
}

fn subdivisions() -> Case {
    let mut rows = random_rows("subdivisions", |random| {
        loop {
            let b = random.piece();
            let c = cutting(random, largest_difference(&b));
            // A whole number of pieces rounds up or not as the last digit falls; both are right.
            let count = |turns: f64, tolerance: f64| {
                let (ply_turns, fiber_turns) = (c.ply_turns * turns, c.fiber_turns * turns);
                let tolerance_mm = c.tolerance_mm * tolerance;
                let per_turn = c.per_turn * turns;
                level::subdivisions(&b, &Cutting { ply_turns, fiber_turns, tolerance_mm, per_turn, ..c })
            };
            if count(1.0 + 1e-4, 1.0 - 1e-4) == count(1.0 - 1e-4, 1.0 + 1e-4) {
                return cut_row(&b, &c);
            }
        }
    });
    let usual = Cutting {
        ply_turns: 0.1,
        fiber_turns: -0.23,
        ply_offset_mm: 0.4,
        ellipse_long_mm: 0.3,
        tolerance_mm: 0.0123,
        per_turn: 6.1,
        largest: 64,
    };
    let edits: [fn(&mut Cutting); 8] = [
        |_| {},
        |c| (c.ply_turns, c.fiber_turns) = (0.0, 0.0),
        |c| (c.ply_turns, c.fiber_turns) = (1e6, -1e6),
        |c| c.tolerance_mm = 0.0,
        |c| c.tolerance_mm = 1e6,
        |c| c.largest = 1,
        |c| c.per_turn = 0.0,
        |c| c.per_turn = 1e6,
    ];
    for edit in edits {
        let mut c = usual;
        edit(&mut c);
        rows.extend(special_pieces().iter().map(|b| cut_row(b, &c)));
    }
    Case {
        function: "subdivisions",
        rows,
        twin: |args| {
            let b = args.piece();
            let c = Cutting {
                ply_turns: args.real(),
                fiber_turns: args.real(),
                ply_offset_mm: args.real(),
                ellipse_long_mm: args.real(),
                tolerance_mm: args.real(),
                per_turn: args.real(),
                largest: args.bits(),
            };
            vec![number("pieces", level::subdivisions(&b, &c).into(), 1.0)]
        },
        invariant: None,
    }
}

fn period_pieces() -> Case {
    let mut rows = random_rows("period_pieces", |random| {
        let periods = f64::from(random.below(60)) / 4.0 + random.between(0.01, 0.24);
        row().bits(1 + random.below(64)).real(periods).bits(64).end()
    });
    rows.extend([0.0, 1.0, -1.0, 2.5, -1e6].map(|periods| row().bits(5).real(periods).bits(64).end()));
    Case {
        function: "period_pieces",
        rows,
        twin: |args| {
            let count = level::period_pieces(args.bits(), args.real(), args.bits());
            vec![number("pieces", count.into(), 1.0)]
        },
        invariant: None,
    }
}

fn nearest_depth() -> Case {
    let depth_row = |b: &[DVec3; 4], depth: DVec4, margin: f64, nearest: f64| {
        row().piece(b).vec3(depth.truncate()).real(depth.w).real(margin).real(nearest).end()
    };
    let mut rows = random_rows("nearest_depth", |random| {
        let b = random.piece();
        let size = largest_difference(&b);
        let eye = b[random.below(4) as usize] + random.unit() * size * random.magnitude(1e-3, 1e3);
        let axis = random.unit();
        depth_row(&b, axis.extend(-axis.dot(eye)), size * random.between(0.0, 1.0), size * 1e-2)
    });
    for b in special_pieces() {
        rows.extend(
            [DVec3::X.extend(0.0), DVec3::NEG_Z.extend(1.0), DVec3::Y.extend(1e6), DVec4::ZERO]
                .map(|depth| depth_row(&b, depth, 0.5, 0.1)),
        );
    }
    Case {
        function: "nearest_depth",
        rows,
        twin: |args| {
            let b = args.piece();
            let depth = level::nearest_depth(&b, args.vec4(), args.real(), args.real());
            vec![number("depth", depth, 1e-12)]
        },
        invariant: None,
    }
}

fn outside_frustum() -> Case {
    let mut rows = random_rows("outside_frustum", |random| {
        let b = random.piece();
        let size = largest_difference(&b);
        let planes: [DVec4; 5] = std::array::from_fn(|_| {
            let normal = random.unit();
            normal.extend(size * random.between(-1.0, 3.0) - normal.dot(b[1]))
        });
        planes
            .iter()
            .fold(row().piece(&b).real(size * random.between(0.0, 1.0)), |row, plane| {
                row.vec3(plane.truncate()).real(plane.w)
            })
            .end()
    });
    for b in special_pieces() {
        for margin in [0.0, 0.25, 1e6] {
            let all_in = (0..5).fold(row().piece(&b).real(margin), |row, _| row.vec3(DVec3::X).real(2e6));
            let all_out = (0..5).fold(row().piece(&b).real(margin), |row, _| row.vec3(DVec3::Y).real(-4e6));
            rows.extend([all_in.end(), all_out.end()]);
        }
    }
    Case {
        function: "outside_frustum",
        rows,
        twin: |args| {
            let (b, margin) = (args.piece(), args.real());
            let planes = std::array::from_fn(|_| args.vec4());
            vec![number("outside", f64::from(u8::from(level::outside_frustum(&b, margin, &planes))), 1.0)]
        },
        invariant: None,
    }
}

fn piece_tangent() -> Case {
    let mut rows = random_rows("piece_tangent", |random| {
        let derivative = random.unit() * random.magnitude(1e-9, 1e6);
        row().piece(&random.piece()).vec3(derivative).end()
    });
    rows.extend(special_pieces().iter().map(|p| row().piece(p).vec3(DVec3::ZERO).end()));
    Case {
        function: "piece_tangent",
        rows,
        twin: |args| vec![vector("tangent", fiber::piece_tangent(&args.piece(), args.vec3()), 1.0)],
        invariant: Some(|_, found| is_unit(found)),
    }
}

fn turned_normal() -> Case {
    let mut rows = random_rows("turned_normal", |random| {
        let from = random.unit();
        let to = if random.below(2) == 0 { random.unit_near(from) } else { random.unit() };
        row().vec3(from).vec3(to).vec3(random.unit_around(from)).end()
    });
    for from in special_units() {
        for to in [from, -from, DVec3::X, DVec3::Z] {
            rows.push(row().vec3(from).vec3(to).vec3(from.any_orthonormal_vector()).end());
        }
    }
    Case {
        function: "turned_normal",
        rows,
        twin: |args| {
            vec![vector("normal", fiber::turned_normal(args.vec3(), args.vec3(), args.vec3()), FACTOR_FLOOR)]
        },
        invariant: None,
    }
}

/// The kernel gives each angle as its cosine and sine, beside its rate: 0 and 2 pi are one rotation.
fn twist_at() -> Case {
    let mut rows = random_rows("twist_at", |random| {
        let starts = (0..3).fold(row(), |row, _| row.real(random.between(0.0, 1.0)));
        (0..3).fold(starts, |row, _| row.real(random.between(-3.0, 3.0))).real(random.t()).end()
    });
    for start in [0.0, 1.0, 0.5] {
        for (delta, t) in [(0.0, 0.0), (1.0, 1.0), (-1.0, 1.0), (-1e-6, 1.0), (64.0, 0.25)] {
            let starts = (0..3).fold(row(), |row, _| row.real(start));
            rows.push((0..3).fold(starts, |row, _| row.real(delta)).real(t).end());
        }
    }
    Case {
        function: "twist_at",
        rows,
        twin: |args| {
            let starts: [f64; 3] = std::array::from_fn(|_| args.real());
            let [ply, fiber, migration] = starts.map(|start| Turns { start, delta: args.real() });
            let twist = fiber::twist_at(&PieceTurns { ply, fiber, migration }, args.real());
            let part = |name, angle: f64, rate| vector(name, DVec3::new(angle.cos(), angle.sin(), rate), 1.0);
            vec![
                part("ply", twist.ply, twist.ply_rate),
                part("fiber", twist.fiber, twist.fiber_rate),
                part("migration", twist.migration, twist.migration_rate),
            ]
        },
        invariant: None,
    }
}

/// Knot normals as a yarn carries them: perpendicular to the piece's ends, turned by up to a radian.
fn knot_normals(random: &mut Random, b: &[DVec3; 4]) -> [DVec3; 2] {
    let start = fiber::piece_tangent(b, b[1] - b[0]);
    let end = fiber::piece_tangent(b, b[3] - b[2]);
    let first = random.unit_around(start);
    let carried = fiber::turned_normal(start, end, first);
    let carried = worsted::math::frame::normal_perpendicular_to(end, carried);
    let (sin, cos) = random.between(-1.0, 1.0).sin_cos();
    [first, cos * carried + sin * end.cross(carried)]
}

fn yarn_point() -> Case {
    let mut rows = random_rows("yarn_point", |random| {
        let b = random.piece();
        let [start, end] = knot_normals(random, &b);
        row().piece(&b).vec3(start).vec3(end).real(random.t()).end()
    });
    let mut random = Random::of("special yarn points");
    for b in special_pieces() {
        let [start, end] = knot_normals(&mut random, &b);
        // As they should be, at odds with each other, and along the yarn, which no knot should have.
        for normals in [[start, end], [start, -start], [DVec3::X, DVec3::X]] {
            rows.extend(SPECIAL_T.map(|t| row().piece(&b).vec3(normals[0]).vec3(normals[1]).real(t).end()));
        }
    }
    Case {
        function: "yarn_point",
        rows,
        twin: |args| {
            let b = args.piece();
            let y = fiber::yarn_point(&b, [args.vec3(), args.vec3()], args.real());
            let floor = largest_difference(&b);
            vec![
                vector("center", y.center, largest(&b)),
                vector("tangent", y.tangent, 1.0),
                vector("normal", y.normal, 1.0),
                number("speed", y.speed, floor),
                vector("bend", y.bend, floor),
            ]
        },
        invariant: Some(|_, found| {
            let (tangent, normal) = (&found[3..6], &found[6..9]);
            is_unit(tangent).and_then(|()| is_unit(normal))?;
            is_perpendicular(normal, first_vec3(tangent))
        }),
    }
}
