//! `glsl/shading`: lights and the environment.

use crate::harness::{Args, Case, Row, vector};
use crate::inputs::{Random, random_rows, row, special_units};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::FRAC_PI_2;
use worsted::math::strip::strip_normals;
use worsted::precompute::environment::{self, Environment};
use worsted::scene::light::{self, LIGHT_RADIUS, Light, LightKind, LightTable};

pub fn cases() -> Vec<Case> {
    vec![light_at(), environment_mean(), environment_diffuse(), environment_toward(), environment_cone()]
}

fn light_row(light: &Light, position: DVec3) -> Row {
    let placed = row().vec3(light.position.unwrap_or_default()).bits(light.position.is_some().into());
    let aimed = placed.vec3(light.toward).real(light.cone_scale);
    aimed.vec3(light.strength).real(light.cone_offset).vec3(position).end()
}

fn random_light(random: &mut Random) -> Light {
    let kind = [LightKind::Directional, LightKind::Point, LightKind::Spot][random.below(3) as usize];
    let strength = || Some([3.6, 3.5, 3.3]);
    let local = kind != LightKind::Directional;
    let outer = random.magnitude(0.5, 90.0);
    let table = LightTable {
        kind,
        direction: (kind != LightKind::Point).then(|| random.unit().to_array()),
        irradiance: strength().filter(|_| !local),
        intensity: strength().filter(|_| local),
        position_mm: local.then(|| (random.unit() * random.magnitude(1.0, 1e4)).to_array()),
        inner_angle_deg: (kind == LightKind::Spot).then(|| random.between(0.0, 0.95) * outer),
        outer_angle_deg: (kind == LightKind::Spot).then_some(outer),
        ..Default::default()
    };
    Light::new(&table, DVec3::ZERO)
}

/// Where a fiber is lit: about a spot's edge, close to a light, at it, anywhere.
fn random_place(random: &mut Random, light: &Light) -> DVec3 {
    let Some(place) = light.position else { return random.unit() * random.magnitude(1e-3, 1e4) };
    match random.below(4) {
        0 => place + random.unit() * random.magnitude(1e-4, 1.5) * LIGHT_RADIUS,
        1 => random.unit() * random.magnitude(1e-3, 1e4),
        _ if light.cone_scale > 0.0 => {
            let edge = (1.0 - light.cone_offset / light.cone_scale).clamp(-1.0, 1.0).acos();
            let (s, c) = (random.between(0.0, 1.3) * edge).sin_cos();
            let away = s * random.unit_around(light.toward) - c * light.toward;
            place + random.magnitude(10.0, 1e4) * away
        }
        _ => place + random.unit() * random.magnitude(1.0, 1e4),
    }
}

fn light_at() -> Case {
    let mut rows = random_rows("light_at", |random| {
        let light = random_light(random);
        let position = random_place(random, &light);
        light_row(&light, position)
    });
    for toward in special_units() {
        for (cone_scale, cone_offset) in [(0.0, 1.0), (1.0, 1.0), (1e9, 1.5e8), (50.0, 1.5)] {
            let at = |position| Light { position, toward, strength: DVec3::ONE, cone_scale, cone_offset };
            let light = at(Some(DVec3::new(1.0, -2.0, 3.0)));
            // At the light itself, too close to it for a direction, on its axis, and behind it.
            for offset in [DVec3::ZERO, 1e-14 * DVec3::X, -500.0 * toward, 500.0 * toward, 1e6 * DVec3::Y] {
                rows.push(light_row(&light, light.position.unwrap_or_default() + offset));
            }
            rows.push(light_row(&at(None), DVec3::ONE));
        }
    }
    Case {
        function: "light_at",
        rows,
        twin: |args| {
            let (place, is_local) = (args.vec3(), args.bits());
            let (toward, cone_scale) = (args.vec3(), args.real());
            let (strength, cone_offset) = (args.vec3(), args.real());
            let position = (is_local != 0).then_some(place);
            let light = Light { position, toward, strength, cone_scale, cone_offset };
            let lit = args.vec3();
            let arriving = light::light_at(&light, lit);
            // Outside a spot's cone nothing arrives: what is left there is rounding of what would.
            let distance_m = 1e-3 * (place - lit).length().max(LIGHT_RADIUS);
            let whole = if is_local != 0 { strength / (distance_m * distance_m) } else { strength };
            vec![
                vector("to_light", arriving.to_light, 1.0),
                vector("irradiance", arriving.irradiance, 1e-3 * whole.length()),
            ]
        },
        invariant: Some(|_, found| {
            found[3..].iter().all(|&c| c >= 0.0).then_some(()).ok_or("below 0".into())
        }),
    }
}

/// Nine colours: a positive mean and what varies about it, often so much that sums ring below 0.
fn random_environment(random: &mut Random) -> Environment {
    let strength = random.magnitude(1e-3, 1e3);
    let ringing = if random.below(4) == 0 { 2.0 } else { 0.15 };
    std::array::from_fn(|k| {
        let range = if k == 0 { [0.5, 1.0] } else { [-ringing, ringing] };
        DVec3::from_array(std::array::from_fn(|_| strength * random.between(range[0], range[1])))
    })
}

fn environment_of(args: &mut Args<'_>) -> Environment {
    std::array::from_fn(|_| args.vec3())
}

/// Where bands cancel, rounding is in proportion to the largest of them.
fn floor(environment: &Environment) -> f64 {
    1e-2 * environment.iter().map(|c| c.length()).fold(f64::MIN_POSITIVE, f64::max)
}

fn with_environment(environment: &Environment) -> crate::inputs::RowBuilder {
    environment.iter().fold(row(), |row, coefficient| row.vec3(*coefficient))
}

/// Environments that are special: none, the same from everywhere, one harmonic by itself.
fn special_environments() -> Vec<Environment> {
    let colour = DVec3::new(0.2, 0.5, 1.0);
    let one = |k: usize| std::array::from_fn(|i| if i == k { colour } else { DVec3::ZERO });
    (0..9).map(one).chain([[DVec3::ZERO; 9], [colour; 9], [-colour; 9]]).collect()
}

fn never_below_0(_: &mut Args<'_>, found: &[f32]) -> Result<(), String> {
    found.iter().all(|&c| c >= 0.0).then_some(()).ok_or("below 0".into())
}

fn environment_mean() -> Case {
    let mean_row = |environment: &Environment, d: DVec3, bands: [f64; 2]| {
        let products = d * DVec3::new(d.y, d.z, d.x);
        let first = with_environment(environment).vec3(d).vec3(d * d).vec3(products);
        first.real(bands[0]).real(bands[1]).end()
    };
    let mut rows = random_rows("environment_mean", |random| {
        let bands = [random.between(-1.0, 1.0), random.between(-0.5, 1.0)];
        mean_row(&random_environment(random), random.unit(), bands)
    });
    for environment in special_environments() {
        rows.extend(special_units().into_iter().map(|d| mean_row(&environment, d, [1.0, 0.25])));
    }
    Case {
        function: "environment_mean",
        rows,
        twin: |args| {
            let environment = environment_of(args);
            let (first, squares, products) = (args.vec3(), args.vec3(), args.vec3());
            let bands = DVec2::new(args.real(), args.real());
            let value = environment::environment_mean(&environment, first, squares, products, bands);
            vec![vector("radiance", value, floor(&environment))]
        },
        invariant: Some(never_below_0),
    }
}

fn environment_diffuse() -> Case {
    let diffuse_row = |environment: &Environment, normals: DVec4, side: DVec3, toward: DVec3| {
        let lit = with_environment(environment).vec3(normals.truncate()).real(normals.w);
        lit.vec3(side).vec3(toward).end()
    };
    let mut rows = random_rows("environment_diffuse", |random| {
        let side = random.unit();
        let count = 1 + random.below(4);
        let normals = (0..count).map(|_| strip_normals(random.between(-1.0, 1.0))).sum::<DVec4>();
        let toward = random.unit_around(side);
        diffuse_row(&random_environment(random), normals / f64::from(count), side, toward)
    });
    let normals = [-FRAC_PI_2, 0.0, 0.3].map(|phi| strip_normals(phi.sin()));
    for environment in special_environments() {
        for side in special_units() {
            let toward = side.any_orthonormal_vector();
            rows.extend(
                normals
                    .into_iter()
                    .chain([DVec4::ZERO])
                    .map(|normals| diffuse_row(&environment, normals, side, toward)),
            );
        }
    }
    Case {
        function: "environment_diffuse",
        rows,
        twin: |args| {
            let environment = environment_of(args);
            let value = environment::environment_diffuse(&environment, args.vec4(), args.vec3(), args.vec3());
            vec![vector("radiance", value, floor(&environment))]
        },
        invariant: Some(never_below_0),
    }
}

/// No blur in a row of four, else any that a lobe has.
fn random_variance(random: &mut Random) -> f64 {
    if random.below(4) == 0 { 0.0 } else { random.magnitude(1e-5, 3.0) }
}

fn environment_toward() -> Case {
    let mut rows = random_rows("environment_toward", |random| {
        let environment = random_environment(random);
        let direction = random.unit();
        with_environment(&environment).vec3(direction).real(random_variance(random)).end()
    });
    for environment in special_environments() {
        for direction in special_units() {
            rows.extend(
                [0.0, 0.1, 200.0].map(|v| with_environment(&environment).vec3(direction).real(v).end()),
            );
        }
    }
    Case {
        function: "environment_toward",
        rows,
        twin: |args| {
            let environment = environment_of(args);
            let value = environment::environment_toward(&environment, args.vec3(), args.real());
            vec![vector("radiance", value, floor(&environment))]
        },
        invariant: Some(never_below_0),
    }
}

fn environment_cone() -> Case {
    let mut rows = random_rows("environment_cone", |random| {
        let environment = random_environment(random);
        let tangent = random.unit();
        let placed = with_environment(&environment).vec3(tangent).real(random.between(-1.0, 1.0));
        placed.real(random_variance(random)).end()
    });
    for environment in special_environments() {
        for tangent in special_units() {
            for sine in [-1.0, 0.0, 1.0] {
                rows.extend(
                    [0.0, 200.0]
                        .map(|v| with_environment(&environment).vec3(tangent).real(sine).real(v).end()),
                );
            }
        }
    }
    Case {
        function: "environment_cone",
        rows,
        twin: |args| {
            let environment = environment_of(args);
            let value = environment::environment_cone(&environment, args.vec3(), args.real(), args.real());
            vec![vector("radiance", value, floor(&environment))]
        },
        invariant: Some(never_below_0),
    }
}
