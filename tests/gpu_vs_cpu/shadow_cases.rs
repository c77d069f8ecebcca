//! `glsl/yarn/tube.glsl` and `glsl/shading/shadow_map.glsl`.

use crate::harness::{Args, Case, Row, number, numbers, vector};
use crate::inputs::{Random, RowBuilder, random_rows, row, special_units};
use crate::math_cases::first_vec3;
use glam::{DMat4, DVec3, DVec4};
use std::f64::consts::TAU;
use worsted::scene::camera::Camera;
use worsted::scene::file::CameraTable;
use worsted::scene::light::{LightKind, LightTable};
use worsted::scene::shadow::{ShadowView, shadow_views};
use worsted::scene::shadow_light::{self, SHADOW_STEEPEST, SHADOW_TAPS};
use worsted::yarn::tube::{self, TUBE_ROWS};

pub fn cases() -> Vec<Case> {
    let mut all = vec![tube_row(), tube_corner(), shadow_window(), shadow_place()];
    all.extend([shadow_face(), shadow_hides(), shadow_tap()]);
    all
}

fn tube_row() -> Case {
    Case {
        function: "tube_row",
        rows: (0..TUBE_ROWS).map(|index| row().bits(index).end()).collect(),
        twin: |args| vec![number("t", tube::tube_row(args.bits()), 1e-3)],
        invariant: Some(|args, found| {
            let end = [0, 1, TUBE_ROWS - 2, TUBE_ROWS - 1].contains(&args.bits());
            // Rows that share an end must share it to the bit.
            let good = (0.0..=1.0).contains(&found[0]) && (!end || found[0] == 0.0 || found[0] == 1.0);
            good.then_some(()).ok_or_else(|| "not on the piece, or not its end".to_owned())
        }),
    }
}

/// What `corner_row` puts at the start of a row: centre, tangent, toward the light.
fn corner_row(center: DVec3, tangent: DVec3, toward: DVec3, radius: f64, index: u32, edge: f64) -> Row {
    row().vec3(center).vec3(tangent).vec3(toward).real(radius).bits(index).real(edge).end()
}

fn tube_corner() -> Case {
    let mut rows = random_rows("tube_corner", |random| {
        let toward = random.unit();
        let tangent = if random.below(4) == 0 { random.unit_near(toward) } else { random.unit() };
        let radius = random.magnitude(1e-3, 1e2);
        // At the origin too, where all of the answer is the ribbon's.
        let center = f64::from(random.below(3)) * radius * random.magnitude(1e-2, 1e3) * random.unit();
        let edge = [-1.0, 1.0][random.below(2) as usize];
        corner_row(center, tangent, toward, radius, random.below(TUBE_ROWS), edge)
    });
    for toward in special_units() {
        // Along the light, against it, and across it.
        for tangent in [toward, -toward, toward.any_orthonormal_vector(), DVec3::ZERO] {
            for index in 0..TUBE_ROWS {
                rows.push(corner_row(DVec3::ZERO, tangent, toward, 0.5, index, -1.0));
                rows.push(corner_row(DVec3::splat(1e5), tangent, toward, 1e-3, index, 1.0));
                rows.push(corner_row(DVec3::ONE, tangent, toward, 0.0, index, 1.0));
            }
        }
    }
    Case {
        function: "tube_corner",
        rows,
        twin: |args| {
            let (center, tangent, toward, radius) = (args.vec3(), args.vec3(), args.vec3(), args.real());
            let corner = tube::tube_corner(center, tangent, toward, radius, args.bits(), args.real());
            // Of a ribbon's width where that is seen; rounding of the centre where it is far away.
            let floor = radius.max(1e-2 * center.length()).max(f64::MIN_POSITIVE);
            vec![vector("corner", corner, floor).within(1e-5)]
        },
        invariant: Some(ribbon_holds),
    }
}

/// Fails where the ribbon does not face the light, or is smaller than the tube or much larger.
fn ribbon_holds(args: &mut Args<'_>, found: &[f32]) -> Result<(), String> {
    let (center, _, toward, radius) = (args.vec3(), args.vec3(), args.vec3(), args.real());
    let away = first_vec3(found) - center;
    let rounding = 1e-6 * center.length() + 1e-3 * radius;
    let (height, size) = (away.dot(toward), away.length());
    if height.abs() > rounding {
        return Err(format!("{height} toward the light, in a radius of {radius}"));
    }
    let fits = size >= radius - rounding && size <= 1.083 * radius + rounding;
    fits.then_some(()).ok_or_else(|| format!("{size} from the yarn's centre, radius {radius}"))
}

fn shadow_window() -> Case {
    let window_row = |along: f64, radius: f64, length: f64| row().real(along).real(radius).real(length).end();
    let mut rows = random_rows("shadow_window", |random| {
        let along = match random.below(4) {
            // Where light grazes, about the cotangent that is the most.
            0 => (1.0 / SHADOW_STEEPEST * random.magnitude(1e-2, 1e1)).cos(),
            _ => random.between(-1.0, 1.0),
        };
        window_row(along, random.magnitude(1e-2, 1e1), random.magnitude(1e-4, 1e2))
    });
    for along in [0.0, 1.0, -1.0, 1.000_001, -1.000_001, 0.999_999_9, 1e-30] {
        for length in [0.0, 1e-30, 1e-6, 1e-3, 1.0, 1e30] {
            rows.extend([0.0, 1e-6, 0.5, 1e6].map(|radius| window_row(along, radius, length)));
        }
    }
    Case {
        function: "shadow_window",
        rows,
        twin: |args| {
            let window = shadow_light::shadow_window(args.real(), args.real(), args.real());
            vec![number("pieces", window, 1.0)]
        },
        invariant: Some(|_, found| {
            (found[0] >= 1.0).then_some(()).ok_or_else(|| "its neighbours are not in it".to_owned())
        }),
    }
}

/// The views of a light of some kind about cloth of some size, near the origin or far from it.
fn random_views(random: &mut Random, resolution: u32) -> Vec<ShadowView> {
    let size = random.magnitude(1.0, 1e3);
    let middle = f64::from(random.below(2)) * size * random.unit();
    let kind = [LightKind::Directional, LightKind::Point, LightKind::Spot][random.below(3) as usize];
    let local = kind != LightKind::Directional;
    let light = LightTable {
        kind,
        direction: (kind != LightKind::Point).then(|| random.unit().to_array()),
        position_mm: local.then(|| (middle + size * random.magnitude(0.1, 10.0) * random.unit()).to_array()),
        ..Default::default()
    };
    let cloth = (middle - DVec3::splat(size), middle + size * DVec3::new(1.0, 1.0, 0.2));
    let table = CameraTable { yaw_deg: random.between(0.0, 360.0), ..Default::default() };
    let camera = Camera::new(&table, [400, 300], DVec3::ZERO, [cloth.0, cloth.1].into_iter(), 1.0);
    shadow_views(&light, DVec3::ZERO, &camera, cloth, resolution)
}

fn place_row(matrix: DMat4, depth_axis: DVec4, position: DVec3, resolution: f64) -> Row {
    let vec4 = |row: RowBuilder, v: DVec4| row.vec3(v.truncate()).real(v.w);
    let view = matrix.to_cols_array_2d().into_iter().map(DVec4::from_array).fold(row(), vec4);
    vec4(view, depth_axis).vec3(position).real(resolution).end()
}

fn shadow_place() -> Case {
    let mut rows = random_rows("shadow_place", |random| {
        let resolution = 16 + random.below(8177);
        let views = random_views(random, resolution);
        let view = views[random.below(views.len() as u32) as usize];
        let clip =
            DVec3::new(random.between(-1.2, 1.2), random.between(-1.2, 1.2), random.magnitude(2e-3, 1.0));
        let position = match random.below(8) {
            // Anywhere, behind a point light too.
            0 => random.magnitude(1.0, 1e4) * random.unit(),
            _ => view.clip_from_world.inverse().project_point3(clip),
        };
        place_row(view.clip_from_world, view.depth_axis, position, resolution.into())
    });
    let mut random = Random::of("special places");
    for _ in 0..20 {
        for view in random_views(&mut random, 512) {
            // Huge distances, and a point light's own place.
            let origin = view.toward.truncate();
            for position in [DVec3::ZERO, DVec3::splat(1e9), DVec3::new(0.0, -1e9, 0.0), origin] {
                rows.push(place_row(view.clip_from_world, view.depth_axis, position, 512.0));
            }
        }
    }
    rows.push(place_row(DMat4::ZERO, DVec4::ZERO, DVec3::ONE, 512.0));
    Case { function: "shadow_place", rows, twin: place_parts, invariant: None }
}

fn place_parts(args: &mut Args<'_>) -> Vec<crate::harness::Part> {
    let matrix = DMat4::from_cols(args.vec4(), args.vec4(), args.vec4(), args.vec4());
    let view =
        ShadowView { clip_from_world: matrix, depth_axis: args.vec4(), texel: 1.0, toward: DVec4::ZERO };
    let (position, resolution) = (args.vec3(), args.real());
    let place = shadow_light::shadow_place(&view, position, resolution);
    // A share of a texel, wherever on the map.
    let across = numbers("place", vec![place.x, place.y], resolution).within(1e-6);
    vec![across, number("depth", place.z, position.length().max(1e-3)).within(1e-6)]
}

fn shadow_face() -> Case {
    let mut rows =
        random_rows("shadow_face", |random| row().vec3(random.magnitude(1e-9, 1e9) * random.unit()).end());
    // Both sides compare the same numbers, so that even where two faces meet they agree.
    for scale in [1e-9, 1.0, 1e30] {
        for x in [-1.0, 0.0, 1.0] {
            for y in [-1.0, 0.0, 1.0] {
                rows.extend([-1.0, 0.0, 1.0].map(|z| row().vec3(scale * DVec3::new(x, y, z)).end()));
            }
        }
    }
    Case {
        function: "shadow_face",
        rows,
        twin: |args| vec![number("face", shadow_light::shadow_face(args.vec3()).into(), 1e-3)],
        invariant: Some(|args, found| {
            let from_light = args.vec3();
            let along = [1.0, -1.0][found[0] as usize % 2] * from_light[found[0] as usize / 2];
            let good = found[0] < 6.0 && along == from_light.abs().max_element();
            good.then_some(()).ok_or_else(|| "another face lies nearer its middle".to_owned())
        }),
    }
}

fn shadow_hides() -> Case {
    let hides_row = |held: f64, number: u32, depth: f64, piece: u32, window: f64| {
        row().bits((held as f32).to_bits()).bits(number).real(depth).bits(piece).real(window).end()
    };
    let mut rows = random_rows("shadow_hides", |random| {
        let depth = random.magnitude(1e-2, 1e4);
        let piece = random.below(1 << 20);
        let most = [16, 1 << 20][random.below(2) as usize];
        let apart = random.below(most);
        let other = if random.below(2) == 0 { piece + apart } else { piece.saturating_sub(apart) };
        let number = if random.below(8) == 0 { 0 } else { other + 1 };
        hides_row(depth * random.between(0.5, 1.2), number, depth, piece, random.magnitude(1.0, 32.0))
    });
    for piece in [0, 1, 100, u32::MAX - 1] {
        for number in [0, 1, 2, 90, 101, 110, u32::MAX] {
            for held in [-1.0, 0.0, 9.999_999, 10.0, 10.000_001, 1e30] {
                rows.extend(
                    [1.0, 10.0, 49.0, 1e9].map(|window| hides_row(held, number, 10.0, piece, window)),
                );
            }
        }
    }
    // Where nothing is, its depth may be anything.
    rows.extend([f64::NAN, f64::NEG_INFINITY].map(|held| hides_row(held, 0, 10.0, 5, 1.0)));
    Case {
        function: "shadow_hides",
        rows,
        twin: |args| {
            let (texel, depth) = ([args.bits(), args.bits()], args.real());
            let hides = shadow_light::shadow_hides(texel, depth, args.bits(), args.real());
            vec![number("hides", u32::from(hides).into(), 1e-3)]
        },
        invariant: Some(|args, found| {
            let [_, number] = [args.bits(), args.bits()];
            let (_, piece) = (args.real(), args.bits());
            let never = number == 0 || number - 1 == piece;
            (!never || found[0] == 0.0).then_some(()).ok_or_else(|| "hidden by nothing or itself".to_owned())
        }),
    }
}

fn shadow_tap() -> Case {
    let mut rows = random_rows("shadow_tap", |random| {
        row().bits(random.below(SHADOW_TAPS)).real(random.between(0.0, TAU)).end()
    });
    for tap in 0..SHADOW_TAPS {
        rows.extend([0.0, TAU, -TAU].map(|turn| row().bits(tap).real(turn).end()));
    }
    Case {
        function: "shadow_tap",
        rows,
        twin: |args| {
            let place = shadow_light::shadow_tap(args.bits(), args.real());
            // An angle of six turns in f32.
            vec![numbers("place", place.to_array().to_vec(), 1.0).within(1e-5)]
        },
        invariant: Some(|_, found| {
            let inside = found[0].hypot(found[1]) <= 1.0;
            inside.then_some(()).ok_or_else(|| "outside of the disk".to_owned())
        }),
    }
}
