//! `fiber_point` of `glsl/yarn/fiber.glsl` over free-standing yarn points, twists, yarns, fibers and
//! shapes.

use crate::harness::{Args, Case, Part, Row, number, vector};
use crate::inputs::{Random, RowBuilder, random_rows, row, some_yarn};
use crate::math_cases::is_unit;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use worsted::yarn::fiber::{self, Twist, YarnPoint};
use worsted::yarn::params::YarnParams;
use worsted::yarn::period::FiberShape;
use worsted::yarn::table::Fiber;

/// Everything the function takes, in the order in which the kernel takes it.
#[derive(Clone)]
struct Arguments {
    at: YarnPoint,
    twist: Twist,
    yarn: YarnParams,
    fiber: Fiber,
    shape: FiberShape,
}

impl Arguments {
    fn into_row(self) -> Row {
        let Self { at, twist, yarn, fiber, shape } = self;
        let reals = |row: RowBuilder, values: &[f64]| values.iter().fold(row, |row, v| row.real(*v));
        let point = row().vec3(at.center).vec3(at.tangent).vec3(at.normal).real(at.speed).vec3(at.bend);
        let twisted = reals(point, &[twist.ply, twist.fiber, twist.ply_rate, twist.fiber_rate]);
        let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
        let beyond = yarn.beyond_mm() - axes;
        let lengths = [yarn.ply_offset_mm(), axes.x, axes.y, beyond.x, beyond.y, yarn.migration_max];
        let placed = reals(reals(twisted.bits(yarn.ply_count), &lengths), &[fiber.angle]).bits(fiber.ply);
        reals(placed, &[shape.radius, shape.radius_rate, shape.angle, shape.angle_rate, shape.width]).end()
    }

    fn read(args: &mut Args<'_>) -> Self {
        let at = YarnPoint {
            center: args.vec3(),
            tangent: args.vec3(),
            normal: args.vec3(),
            speed: args.real(),
            bend: args.vec3(),
        };
        let twist = Twist {
            ply: args.real(),
            fiber: args.real(),
            ply_rate: args.real(),
            fiber_rate: args.real(),
            ..NO_TWIST
        };
        let yarn = YarnParams {
            ply_count: args.bits(),
            // The device has the ply's offset, half of this; doubling is exact.
            yarn_radius_mm: 2.0 * args.real(),
            ellipse_short_mm: args.real(),
            ellipse_long_mm: args.real(),
            // What the device has of the half-axes beyond the ply's surface follows from these.
            migration_max: (args.real(), args.real(), args.real()).2,
            ..some_yarn()
        };
        let fiber = Fiber { angle: args.real(), ply: args.bits(), ..NO_FIBER };
        let shape = FiberShape {
            radius: args.real(),
            radius_rate: args.real(),
            angle: args.real(),
            angle_rate: args.real(),
            width: args.real(),
        };
        Self { at, twist, yarn, fiber, shape }
    }

    /// A yarn of one size in mm, 1e-6 to 1e4, not far from the origin as the sizes go.
    fn random(random: &mut Random) -> Self {
        let size = random.magnitude(1e-6, 1e4);
        let tangent = random.unit();
        let speed = size * random.magnitude(0.1, 10.0);
        let at = YarnPoint {
            center: random.unit() * size * random.magnitude(1e-3, 1e2),
            tangent,
            normal: random.unit_around(tangent),
            speed,
            bend: random.unit() * speed * random.between(0.0, 0.5),
        };
        let mut angle = || random.between(0.0, TAU);
        let (ply, fiber, ply_rate, fiber_rate) = (angle(), angle(), 0.5 * (angle() - PI), angle() - PI);
        let yarn = YarnParams {
            ply_count: 1 + random.below(8),
            yarn_radius_mm: size * random.between(0.2, 1.0),
            ellipse_short_mm: size * random.between(0.1, 0.6),
            ellipse_long_mm: size * random.between(0.1, 0.6),
            migration_max: random.between(0.5, 1.5),
            ..some_yarn()
        };
        let shape = FiberShape {
            radius: random.between(0.0, 4.0),
            radius_rate: random.between(-5.0, 5.0),
            angle: random.between(-PI, PI),
            angle_rate: random.between(-5.0, 5.0),
            width: random.between(0.0, 1.0),
        };
        Self {
            at,
            twist: Twist { ply, fiber, ply_rate, fiber_rate, ..NO_TWIST },
            fiber: Fiber { angle: random.between(0.0, TAU), ply: random.below(yarn.ply_count), ..NO_FIBER },
            yarn,
            shape,
        }
    }
}

/// What the function does not read: migration comes with the shape.
const NO_TWIST: Twist =
    Twist { ply: 0.0, fiber: 0.0, migration: 0.0, ply_rate: 0.0, fiber_rate: 0.0, migration_rate: 0.0 };
const NO_FIBER: Fiber = Fiber { radius: 0.0, angle: 0.0, migration_phase: 0.0, ply: 0 };

/// What a scene can bring at its worst, one thing at a time.
fn extremes() -> Vec<Arguments> {
    let usual = || {
        let mut arguments = Arguments::random(&mut Random::of("usual fiber"));
        arguments.yarn = some_yarn();
        arguments.fiber.ply = 0;
        arguments
    };
    let edits: [fn(&mut Arguments); 12] = [
        |a| a.shape.radius = 0.0,
        |a| (a.yarn.ellipse_short_mm, a.shape.radius) = (0.01 * a.yarn.ellipse_long_mm, 5.0),
        |a| (a.yarn.ellipse_long_mm, a.shape.radius) = (0.01 * a.yarn.ellipse_short_mm, 5.0),
        |a| a.yarn.yarn_radius_mm = 0.0,
        |a| (a.at.speed, a.at.bend) = (0.0, DVec3::ZERO),
        // A cusp: the centre line stands still but bends.
        |a| (a.at.speed, a.at.bend) = (0.0, DVec3::new(3.0, -2.0, 1.0)),
        |a| a.at.bend *= 1e4,
        |a| (a.twist.ply_rate, a.twist.fiber_rate, a.shape.angle_rate) = (0.0, 0.0, 0.0),
        |a| a.twist = Twist { ply: TAU, fiber: TAU, ..a.twist },
        |a| (a.twist.ply_rate, a.twist.fiber_rate) = (1e4, -1e4),
        |a| a.at.center = DVec3::new(1e6, -1e6, 1e6),
        |a| (a.at.tangent, a.at.normal) = (-DVec3::Z, DVec3::Y),
    ];
    edits
        .into_iter()
        .map(|edit| {
            let mut arguments = usual();
            edit(&mut arguments);
            arguments
        })
        .collect()
}

fn twin(args: &mut Args<'_>) -> Vec<Part> {
    let Arguments { at, twist, yarn, fiber, shape } = Arguments::read(args);
    let f = fiber::fiber_point(&at, &twist, &yarn, &fiber, &shape);
    let floor = at.center.length().max(yarn.outer_radius_mm() * shape.radius.max(1.0));
    vec![
        vector("ply center", f.ply_center, floor),
        vector("ply normal", f.ply_normal, 1.0),
        vector("ply binormal", f.ply_binormal, 1.0),
        vector("position", f.position, floor),
        vector("tangent", f.tangent, 1.0),
        number("center distance", f.center_distance, 1e-3 * yarn.outer_radius_mm()),
        number("width", f.width, 1e-3),
    ]
}

pub fn case() -> Case {
    let mut rows = random_rows("fiber_point", |random| Arguments::random(random).into_row());
    rows.extend(extremes().into_iter().map(Arguments::into_row));
    Case { function: "fiber_point", rows, twin, invariant: Some(|_, found| is_unit(&found[12..15])) }
}

pub fn surface_radius() -> Case {
    Case {
        function: "surface_radius",
        rows: random_rows("surface_radius", |random| row().real(random.between(0.0, 1.5)).end()),
        twin: |args| {
            let yarn = YarnParams { migration_max: args.real(), ..some_yarn() };
            vec![number("R", yarn.surface_radius(), 1e-3)]
        },
        invariant: None,
    }
}
