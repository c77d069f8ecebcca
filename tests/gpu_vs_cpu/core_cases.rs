//! `glsl/yarn/core.glsl`.

use crate::harness::{Case, Row, number, vector};
use crate::inputs::{Random, random_rows, row, special_units};
use crate::math_cases::{first_vec3, is_perpendicular, is_unit};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use worsted::yarn::core;
use worsted::yarn::detail::CORE_LEVELS;

/// Below this a share or a part of a turn has no relative error worth speaking of.
const FLOOR: f64 = 1e-3;

pub fn cases() -> Vec<Case> {
    vec![core_section(), core_axis(), core_turns(), nearest_turn(), core_thickness()]
}

/// A ply along `tangent`: its ellipse's axes lie in the yarn's cross-section, to which the ply itself is up
/// to `tilt` radians aslant.
fn section_row(random: &mut Random, tangent: DVec3, to_eye: DVec3, ellipse: DVec2, tilt: f64) -> Row {
    let normal = random.unit_around(tangent);
    let (sin, cos) = (tilt * random.between(-1.0, 1.0)).sin_cos();
    let binormal = cos * tangent.cross(normal) + sin * tangent;
    row().vec3(normal).vec3(binormal).vec3(tangent).vec3(to_eye).real(ellipse.x).real(ellipse.y).end()
}

fn core_section() -> Case {
    let mut rows = random_rows("core_section", |random| {
        let size = random.magnitude(1e-6, 1e4);
        let ellipse = DVec2::new(size * random.between(0.1, 0.6), size * random.between(0.1, 0.6));
        let tangent = random.unit();
        let to_eye = if random.below(4) == 0 { random.unit_near(tangent) } else { random.unit() };
        section_row(random, tangent, to_eye, ellipse, 1.0)
    });
    let mut random = Random::of("special sections");
    for tangent in special_units() {
        // From the side, along the ply from both ends, and obliquely; round, flat and upright ellipses.
        for to_eye in [DVec3::X, DVec3::Z, tangent, -tangent, DVec3::splat(1.0).normalize()] {
            for ellipse in [DVec2::splat(0.3), DVec2::new(1e-3, 1.0), DVec2::new(1.0, 1e-3)] {
                rows.push(section_row(&mut random, tangent, to_eye, ellipse, 0.0));
            }
        }
    }
    Case {
        function: "core_section",
        rows,
        twin: |args| {
            let (axes, tangent, to_eye) = ([args.vec3(), args.vec3()], args.vec3(), args.vec3());
            let ellipse = DVec2::new(args.real(), args.real());
            let seen = core::core_section(axes, tangent, to_eye, ellipse);
            let floor = ellipse.max_element();
            vec![
                vector("side", seen.side, 1.0),
                vector("toward", seen.toward, 1.0),
                vector("from yarn", seen.from_yarn.extend(0.0), 1.0),
                number("width", seen.width_mm, FLOOR * floor),
                number("depth", seen.depth_mm, FLOOR * floor),
                number("shear", seen.shear_mm, FLOOR * floor),
                vector("phase", DVec3::new(seen.phase.cos(), seen.phase.sin(), 0.0), 1.0),
            ]
        },
        invariant: Some(|args, found| {
            let (side, toward) = (&found[0..3], &found[3..6]);
            let [_, _, tangent] = [args.vec3(), args.vec3(), args.vec3()];
            is_unit(toward)?;
            is_perpendicular(toward, tangent)?;
            is_perpendicular(side, tangent)?;
            is_perpendicular(side, first_vec3(toward))
        }),
    }
}

fn core_axis() -> Case {
    let rows = random_rows("core_axis", |random| {
        let normal = random.unit();
        let turns_per_mm = match random.below(6) {
            0 => 0.0,
            1 => random.magnitude(1e-6, 1e4),
            _ => random.between(-1.0, 1.0),
        };
        let placed = row().vec3(normal).vec3(random.unit_around(normal));
        placed.real(turns_per_mm).real(random.magnitude(1e-6, 1e3)).end()
    });
    Case {
        function: "core_axis",
        rows,
        twin: |args| {
            let axes = [args.vec3(), args.vec3()];
            vec![vector("axis", core::core_axis(axes, args.real(), args.real()), 1.0)]
        },
        invariant: Some(|_, found| is_unit(found)),
    }
}

fn core_turns() -> Case {
    let mut rows = random_rows("core_turns", |random| {
        row().real(random.between(-8.0 * TAU, 8.0 * TAU)).real(random.between(-PI, PI)).end()
    });
    for (twist, phase) in [(0.0, 0.0), (TAU, 0.0), (0.0, PI), (0.0, -PI), (PI, PI), (1e6, 1.0), (-1e6, -3.0)]
    {
        rows.push(row().real(twist).real(phase).end());
    }
    Case {
        function: "core_turns",
        rows,
        twin: |args| vec![number("turns", core::core_turns(args.real(), args.real()), FLOOR)],
        invariant: None,
    }
}

fn nearest_turn() -> Case {
    let mut rows = random_rows("nearest_turn", |random| {
        let expected = random.between(-64.0, 64.0);
        let whole = f64::from(random.below(128)) - 64.0;
        // Not the middle between two turns, which rounds as the last digit falls.
        row().real(expected + whole + random.between(-0.499, 0.499)).real(expected).end()
    });
    for (turns, expected) in
        [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.25, 7.0), (-0.25, -1e6), (1e6, 0.375), (0.499_9, 0.0)]
    {
        rows.push(row().real(turns).real(expected).end());
    }
    Case {
        function: "nearest_turn",
        rows,
        twin: |args| vec![number("turns", core::nearest_turn(args.real(), args.real()), FLOOR)],
        invariant: Some(|args, found| {
            let (_, expected) = (args.real(), args.real());
            let off = (f64::from(found[0]) - expected).abs();
            (off <= 0.5).then_some(()).ok_or_else(|| format!("{off} turns from what is expected"))
        }),
    }
}

fn core_thickness() -> Case {
    let levels = |mut row: crate::inputs::RowBuilder, random: &mut Random| {
        let mut before = 0.0;
        for _ in 0..CORE_LEVELS {
            before += random.between(0.0, 0.3);
            row = row.real(before);
        }
        row.end()
    };
    let last = f64::from(CORE_LEVELS - 1);
    let mut rows = random_rows("core_thickness", |random| {
        let level = random.between(-0.5, last + 0.5);
        levels(row().real(level), random)
    });
    let mut random = Random::of("special levels");
    let whole = (0..CORE_LEVELS).map(f64::from);
    for level in whole.chain([-1e30, -1.0, 1e-6, last - 1e-6, last + 1e-6, last + 1.0, 1e30]) {
        rows.push(levels(row().real(level), &mut random));
    }
    Case {
        function: "core_thickness",
        rows,
        twin: |args| {
            let level = args.real();
            let thickness = std::array::from_fn(|_| args.real());
            vec![number("thickness", core::core_thickness(level, &thickness), FLOOR)]
        },
        invariant: None,
    }
}
