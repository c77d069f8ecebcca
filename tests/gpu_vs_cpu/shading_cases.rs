//! `glsl/shading/table.glsl`, `self_shadow.glsl`, `sky.glsl` and the places of `occlusion.glsl`; what reads a texture is in
//! `table_reads.rs`.

use crate::harness::{Args, Case, Row, number, vector};
use crate::inputs::{Random, random_rows, row};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use worsted::precompute::chord_shadow;
use worsted::precompute::occlusion_fit;
use worsted::precompute::occlusion_table::occlusion_place as occlusion_place_twin;
use worsted::precompute::self_shadow::{self, SelfShadowSize};
use worsted::precompute::sky;
use worsted::precompute::table;

/// Below this a share has no relative error worth speaking of.
const FLOOR: f64 = 1e-3;
/// How far light stays from where its mirror image is as right, in turns from one ply to the next.
const CLEAR: f64 = 1e-4;

pub fn cases() -> Vec<Case> {
    vec![
        node_coordinate(),
        self_shadow_place(),
        self_shadow_stretch(),
        self_shadow_light(),
        ply_chord(),
        occlusion_place(),
        reflected_occlusion(),
        sky_toward(),
        sky_gathered(),
    ]
}

fn node_coordinate() -> Case {
    let mut rows = random_rows("node_coordinate", |random| {
        row().real(random.between(0.0, 1.0)).bits(1 + random.below(256)).end()
    });
    for texels in [1, 2, 3, 128, 16_384] {
        rows.extend([0.0, 0.5, 1.0].map(|share| row().real(share).bits(texels).end()));
    }
    let twin = |args: &mut Args<'_>| {
        vec![number("coordinate", table::node_coordinate(args.real(), args.bits()), FLOOR)]
    };
    Case { function: "node_coordinate", rows, twin, invariant: None }
}

fn take_vec2(args: &mut Args<'_>) -> DVec2 {
    DVec2::new(args.real(), args.real())
}

/// Light at some turns from ply 0 toward the next one, its projection of some length.
fn light_row(random: &mut Random, position: DVec2, turns: f64, ply_count: u32, length: f64) -> Row {
    let light = length * DVec2::from_angle(TAU * turns / f64::from(ply_count));
    let placed = row().real(position.x).real(position.y).real(light.x).real(light.y).bits(ply_count);
    placed.bits(2 + random.below(255)).bits(1 + random.below(64)).end()
}

fn self_shadow_place() -> Case {
    let mut rows = random_rows("self_shadow_place", |random| {
        let ply_count = 1 + random.below(8);
        // At a half and a whole turn both ways of folding are right, and rounding decides.
        let turns = f64::from(random.below(8)) + 0.5 * f64::from(random.below(2));
        let turns = turns + random.between(CLEAR, 0.5 - CLEAR);
        let position = random.magnitude(1e-3, 3.0) * DVec2::from_angle(random.between(0.0, TAU));
        let length = random.magnitude(1e-6, 1.0);
        light_row(random, position, turns, ply_count, length)
    });
    let mut random = Random::of("special light");
    for ply_count in 1..=8 {
        for position in [DVec2::ZERO, DVec2::X, -DVec2::Y, DVec2::splat(1e6), DVec2::new(0.1, -0.2)] {
            rows.push(light_row(&mut random, position, 0.0, ply_count, 0.0));
            rows.push(light_row(&mut random, position, 0.0, ply_count, 1.0));
            rows.push(light_row(&mut random, position, 0.25, ply_count, 1e-12));
        }
    }
    Case {
        function: "self_shadow_place",
        rows,
        twin: |args| {
            let (position, light, ply_count) = (take_vec2(args), take_vec2(args), args.bits());
            let size = SelfShadowSize { across: args.bits(), slices: args.bits() };
            vec![vector("place", self_shadow::self_shadow_place(position, light, ply_count, size), FLOOR)]
        },
        invariant: Some(|_, found| {
            let inside = found.iter().all(|v| (0.0..=1.0).contains(v));
            inside.then_some(()).ok_or_else(|| "outside of the texture".to_owned())
        }),
    }
}

fn self_shadow_stretch() -> Case {
    let mut rows = random_rows("self_shadow_stretch", |random| row().real(random.between(0.0, 1.0)).end());
    rows.extend([0.0, 1e-30, 0.124_999, 0.125, 0.125_001, 1.0, 1.000_001].map(|sin| row().real(sin).end()));
    let twin =
        |args: &mut Args<'_>| vec![number("stretch", self_shadow::self_shadow_stretch(args.real()), FLOOR)];
    Case { function: "self_shadow_stretch", rows, twin, invariant: None }
}

fn self_shadow_light() -> Case {
    let mut rows = random_rows("self_shadow_light", |random| {
        let depth = random.magnitude(1e-4, 2.0);
        row().real(depth).real(random.magnitude(0.1, 20.0)).real(random.between(0.0, 1.0)).end()
    });
    for depth in [0.0, 1e-6, 2.0, 1e30] {
        for extinction in [0.0, 7.0, 1e30] {
            rows.extend(
                [0.0, 1e-30, 0.125, 1.0, 1.000_001]
                    .map(|sin| row().real(depth).real(extinction).real(sin).end()),
            );
        }
    }
    Case {
        function: "self_shadow_light",
        rows,
        twin: |args| {
            vec![number(
                "light",
                self_shadow::self_shadow_light(args.real(), args.real(), args.real()),
                FLOOR,
            )]
        },
        invariant: Some(|_, found| {
            let share = (0.0..=1.0).contains(&found[0]);
            share.then_some(()).ok_or_else(|| "not a share of the light".to_owned())
        }),
    }
}

/// Chords of plies up to a thousand times thinner than the yarn, at places and for light about which all is well
/// conditioned: a line's distance from a ply's axis is a difference that f32 has to a millionth of the yarn at best.
fn ply_chord() -> Case {
    let mut rows = random_rows("ply_chord", |random| {
        let axes = DVec2::new(random.magnitude(1e-3, 1.0), random.magnitude(1e-3, 1.0));
        let offset = random.between(0.0, 1.0);
        let in_ply = random.between(0.0, 0.95) * DVec2::from_angle(random.between(0.0, TAU));
        chord_row(DVec2::new(offset, 0.0) + in_ply * axes, random.between(0.0, TAU), offset, axes)
    });
    // Past the ply, at its tips, on its axis, along both.
    for axes in [DVec2::new(0.3, 0.4), DVec2::new(1e-3, 1.0), DVec2::new(1.0, 1e-3)] {
        for position in
            [DVec2::new(0.5, 0.0), DVec2::new(3.0, 3.0), DVec2::new(-3.0, 0.0), DVec2::new(0.5, 2.0)]
        {
            rows.extend([0.0, 0.25, 0.5, 0.75].map(|turns| chord_row(position, TAU * turns, 0.5, axes)));
        }
    }
    let twin = |args: &mut Args<'_>| {
        let (position, toward) = (take_vec2(args), take_vec2(args));
        let (offset, axes) = (args.real(), take_vec2(args));
        vec![vector("chord", chord_shadow::ply_chord(position, toward, offset, axes), FLOOR)]
    };
    Case {
        function: "ply_chord",
        rows,
        twin,
        invariant: Some(|_, found| {
            let inside = found.iter().all(|v| (0.0..=1.001).contains(v));
            inside.then_some(()).ok_or_else(|| "outside of the table, or longer than the ply".to_owned())
        }),
    }
}

fn chord_row(position: DVec2, angle: f64, offset: f64, axes: DVec2) -> Row {
    let toward = DVec2::from_angle(angle);
    let placed = row().real(position.x).real(position.y).real(toward.x).real(toward.y);
    placed.real(offset).real(axes.x).real(axes.y).end()
}

fn occlusion_place() -> Case {
    let mut rows = random_rows("occlusion_place", |random| {
        let place = |random: &mut Random| random.between(-1.2, 1.2);
        row().real(place(random)).real(place(random)).bits(2 + random.below(255)).end()
    });
    for position in [DVec2::ZERO, DVec2::splat(-1e30), DVec2::new(1e30, -1.0), DVec2::splat(1.0)] {
        rows.push(row().real(position.x).real(position.y).bits(128).end());
    }
    Case {
        function: "occlusion_place",
        rows,
        twin: |args| {
            let place = occlusion_place_twin(take_vec2(args), args.bits());
            vec![number("x", place.x, FLOOR), number("y", place.y, FLOOR)]
        },
        invariant: None,
    }
}

fn reflected_occlusion() -> Case {
    let args = |visibility: f64, lean: [f64; 4], distance: f64, facing: f64| {
        let reals = lean.into_iter().fold(row().real(visibility), |row, c| row.real(c));
        reals.real(distance).real(facing).end()
    };
    let mut rows = random_rows("reflected_occlusion", |random| {
        let lean = std::array::from_fn(|_| random.between(-1.5, 1.5));
        let visibility = random.between(0.0, 1.0);
        args(visibility, lean, random.between(-0.2, 1.4), random.between(-1.0, 1.0))
    });
    for lean in [[0.0; 4], [0.0, 0.3, 0.2, 0.1], [1e3, 1.0, 1.0, 1.0]] {
        rows.extend(
            [(0.0, 0.0), (1.0, -1.0), (1e6, 1.0)].map(|(distance, facing)| args(0.5, lean, distance, facing)),
        );
    }
    let twin = |args: &mut Args<'_>| {
        let (visibility, lean) = (args.real(), args.vec4());
        let share = occlusion_fit::reflected_occlusion(visibility, lean, args.real(), args.real());
        vec![number("share", share, FLOOR)]
    };
    Case { function: "reflected_occlusion", rows, twin, invariant: None }
}

fn sky_toward() -> Case {
    let skies = |x: f64, slope: DVec3, direction: DVec3| row().real(x).vec3(slope).vec3(direction).end();
    let mut rows = random_rows("sky_toward", |random| {
        let slope = random.between(0.0, 1.5) * random.unit();
        skies(random.between(0.0, 1.0), slope, random.between(0.0, 1.0) * random.unit())
    });
    for direction in [DVec3::ZERO, DVec3::X, DVec3::NEG_Z] {
        rows.extend([0.0, 0.5, 1.0, -1e6, 1e6].map(|x| skies(x, DVec3::splat(0.5), direction)));
    }
    let twin = |args: &mut Args<'_>| {
        let sky = args.vec4();
        vec![number("share", sky::sky_toward(sky, args.vec3()), FLOOR)]
    };
    Case { function: "sky_toward", rows, twin, invariant: None }
}

fn sky_gathered() -> Case {
    let mut rows = random_rows("sky_gathered", |random| {
        row().vec3(random.unit()).vec3(random.between(0.0, 3.0) * random.unit()).end()
    });
    rows.extend([DVec3::ZERO, 1e6 * DVec3::Y].map(|outward| row().vec3(DVec3::X).vec3(outward).end()));
    let twin = |args: &mut Args<'_>| {
        let toward = args.vec3();
        vec![vector("direction", sky::sky_gathered(toward, args.vec3()), FLOOR)]
    };
    Case { function: "sky_gathered", rows, twin, invariant: None }
}
