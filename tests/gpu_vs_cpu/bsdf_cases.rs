//! `glsl/bsdf` and `glsl/shading`.

use crate::harness::{Case, Part, Row, number, vector};
use crate::inputs::{Random, random_rows, row, special_units};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, PI};
use worsted::bsdf::simple;
use worsted::precompute::occlusion_fit;

/// The floor of a scattering function's error, as a share of its peak.
const SHARE_OF_PEAK: f64 = 1e-4;
const WIDTHS_DEG: [f64; 5] = [0.5, 2.0, 10.0, 30.0, 90.0];

pub fn cases() -> Vec<Case> {
    let mut all = vec![filtered_cosine(), simple_diffuse(), half_angle_variance()];
    all.extend([simple_specular(), simple_specular_cos(), distance_occlusion()]);
    all
}

/// A fiber's frame: side and toward, unit and perpendicular to each other.
fn frame(random: &mut Random) -> (DVec3, DVec3) {
    let side = random.unit();
    (side, random.unit_around(side))
}

/// Means of sin phi, cos phi, sin 2 phi and cos 2 phi of normals at these azimuths, alike in weight.
fn moments(azimuths: &[f64]) -> DVec4 {
    let of = |phi: &f64| DVec4::new(phi.sin(), phi.cos(), (2.0 * phi).sin(), (2.0 * phi).cos());
    azimuths.iter().map(of).sum::<DVec4>() / azimuths.len() as f64
}

/// Of one normal, of several that are seen, of ones spread evenly about a direction, of as many one way as
/// the other.
fn random_moments(random: &mut Random) -> DVec4 {
    let phi = random.between(-FRAC_PI_2, FRAC_PI_2);
    match random.below(4) {
        0 => moments(&[phi]),
        1 => moments(&[phi, random.between(-FRAC_PI_2, FRAC_PI_2), random.between(-FRAC_PI_2, FRAC_PI_2)]),
        2 => {
            let variance = random.magnitude(1e-6, 4.0);
            let one = moments(&[phi]);
            let fade = [0.5, 0.5, 2.0, 2.0].map(|rate: f64| (-rate * variance).exp());
            one * DVec4::from_array(fade)
        }
        _ => moments(&[phi, phi + random.between(0.8 * PI, PI)]),
    }
}

fn filter_rows(function: &str, strength: Option<DVec3>) -> Vec<Row> {
    let start = || strength.map_or_else(row, |strength| row().vec3(strength));
    let filter_row = |normals: DVec4, side: DVec3, toward: DVec3, to_light: DVec3| {
        start().vec3(normals.truncate()).real(normals.w).vec3(side).vec3(toward).vec3(to_light).end()
    };
    let mut rows = random_rows(function, |random| {
        let (side, toward) = frame(random);
        let to_light = match random.below(8) {
            0 => random.unit_near(side.cross(toward)),
            1 => random.unit_near(toward),
            _ => random.unit(),
        };
        filter_row(random_moments(random), side, toward, to_light)
    });
    let exact = [[0.0], [FRAC_PI_2], [-FRAC_PI_2], [0.3]].map(|phi| moments(&phi));
    let opposite = moments(&[0.0, PI]);
    // No normal is preferred at all, next to none is, and an average that overshoots.
    for normals in exact.into_iter().chain([DVec4::ZERO, DVec4::splat(1e-20), opposite, 1.000_01 * exact[0]])
    {
        rows.extend(special_units().into_iter().map(|l| filter_row(normals, DVec3::X, DVec3::Z, l)));
        rows.push(filter_row(normals, DVec3::X, DVec3::Z, DVec3::ZERO));
    }
    rows
}

/// The floor of the filtered cosine's error, as a share of the light's part across the fiber. Where normals
/// face away it is 0, of terms whose sizes add up to 2: they leave some 2e-7 of rounding, and four squarings of
/// the remainder, at most 0.106, as much again. Together they stay below the 5e-7 that this floor allows.
const FILTER_FLOOR: f64 = 5e-3;

/// Length of the light's part across the fiber, the largest that the filtered cosine can be.
fn across(side: DVec3, toward: DVec3, to_light: DVec3) -> f64 {
    to_light.dot(side).hypot(to_light.dot(toward)).max(f64::MIN_POSITIVE)
}

fn filtered_cosine() -> Case {
    Case {
        function: "filtered_cosine",
        rows: filter_rows("filtered_cosine", None),
        twin: |args| {
            let (normals, side, toward, to_light) = (args.vec4(), args.vec3(), args.vec3(), args.vec3());
            let value = simple::filtered_cosine(normals, side, toward, to_light);
            vec![number("cosine", value, FILTER_FLOOR * across(side, toward, to_light))]
        },
        invariant: Some(|_, found| (found[0] >= 0.0).then_some(()).ok_or("below 0".into())),
    }
}

fn simple_diffuse() -> Case {
    let mut rows = filter_rows("simple_diffuse", Some(DVec3::new(0.2, 0.5, 1.0)));
    rows.extend(random_rows("strengths", |random| {
        let strength =
            DVec3::new(random.between(0.0, 1.0), random.between(0.0, 1.0), random.magnitude(1e-3, 1.0));
        let (side, toward) = frame(random);
        let normals = random_moments(random);
        let lit = row().vec3(strength).vec3(normals.truncate()).real(normals.w);
        lit.vec3(side).vec3(toward).vec3(random.unit()).end()
    }));
    Case {
        function: "simple_diffuse",
        rows,
        twin: |args| {
            let (strength, normals) = (args.vec3(), args.vec4());
            let (side, toward, to_light) = (args.vec3(), args.vec3(), args.vec3());
            let radiance = simple::simple_diffuse(strength, normals, side, toward, to_light);
            let floor = FILTER_FLOOR * across(side, toward, to_light) * strength.length() / PI;
            vec![vector("radiance", radiance, floor)]
        },
        invariant: None,
    }
}

/// Variances of tangents along side and toward, and their covariance, which the variances bound.
fn random_spread(random: &mut Random) -> DVec3 {
    let (x, y): (f64, f64) = (random.magnitude(1e-6, 1.0), random.magnitude(1e-6, 1.0));
    DVec3::new(x, y, (x * y).sqrt() * random.between(-1.0, 1.0))
}

fn half_angle_variance() -> Case {
    let variance_row = |spread: DVec3, (side, toward): (DVec3, DVec3), light: DVec3, eye: DVec3| {
        row().vec3(spread).vec3(side).vec3(toward).vec3(light).vec3(eye).end()
    };
    let mut rows = random_rows("half_angle_variance", |random| {
        let frame = frame(random);
        let light = random.unit();
        let eye = if random.below(4) == 0 { random.unit_near(light) } else { random.unit() };
        variance_row(random_spread(random), frame, light, eye)
    });
    for light in special_units() {
        // Nothing spread, all of it one way, and tangents that go with each other or against.
        for spread in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE, DVec3::new(1.0, 1.0, -1.0)] {
            rows.extend(
                [light, -light, DVec3::X].map(|eye| variance_row(spread, (DVec3::X, DVec3::Z), light, eye)),
            );
        }
    }
    Case {
        function: "half_angle_variance",
        rows,
        twin: |args| {
            let spread = args.vec3();
            let value =
                simple::half_angle_variance(spread, args.vec3(), args.vec3(), args.vec3(), args.vec3());
            vec![number("variance", value, 1e-3 * (spread.x + spread.y).max(f64::MIN_POSITIVE))]
        },
        invariant: Some(|_, found| (found[0] >= 0.0).then_some(()).ok_or("below 0".into())),
    }
}

/// None in a row of four, else of any size that tangents have.
fn random_variance(random: &mut Random) -> f64 {
    if random.below(4) == 0 { 0.0 } else { random.magnitude(1e-6, 1.0) }
}

fn simple_specular() -> Case {
    let mut rows = random_rows("simple_specular", |random| {
        let width = random.magnitude(0.5, 90.0).to_radians();
        let variance = random_variance(random);
        let theta_h = (width * width + variance).sqrt() * random.between(-6.0, 6.0);
        let placed = row().real(random.between(0.0, 1.0)).real(theta_h.clamp(-FRAC_PI_2, FRAC_PI_2));
        placed.real(width).real(variance).end()
    });
    for width_deg in WIDTHS_DEG {
        for theta_h in [0.0, 1e-6, -1e-3, 0.04, -0.5, FRAC_PI_2, -FRAC_PI_2] {
            for variance in [0.0, 1e-12, 1e-2, 10.0] {
                rows.extend(
                    [0.0, 1e-4, 1.0].map(|c| {
                        row().real(c).real(theta_h).real(width_deg.to_radians()).real(variance).end()
                    }),
                );
            }
        }
    }
    Case {
        function: "simple_specular",
        rows,
        twin: |args| {
            let value = simple::simple_specular(args.real(), args.real(), args.real(), args.real());
            vec![number("factor", value, SHARE_OF_PEAK)]
        },
        invariant: None,
    }
}

/// Light, eye: around the mirror cone, several widths from it, and close to the tangent.
fn lobe_directions(random: &mut Random, tangent: DVec3, width: f64) -> (DVec3, DVec3) {
    let at = |theta: f64, around: DVec3| theta.sin() * tangent + theta.cos() * around;
    let theta_light = random.between(-FRAC_PI_2, FRAC_PI_2);
    let theta_eye = (2.0 * width * random.between(-5.0, 5.0) - theta_light).clamp(-FRAC_PI_2, FRAC_PI_2);
    (at(theta_light, random.unit_around(tangent)), at(theta_eye, random.unit_around(tangent)))
}

fn simple_specular_cos() -> Case {
    let mut rows = random_rows("simple_specular_cos", |random| {
        let width = random.magnitude(0.5, 90.0).to_radians();
        let tangent = random.unit();
        let (to_light, to_eye) = match random.below(8) {
            0 => (random.unit_near(tangent), random.unit()),
            1 => (random.unit(), random.unit_near(tangent)),
            _ => lobe_directions(random, tangent, width),
        };
        let variance = random_variance(random);
        row().vec3(tangent).vec3(to_light).vec3(to_eye).real(width).real(variance).end()
    });
    for width_deg in WIDTHS_DEG {
        let width = f64::to_radians(width_deg);
        for tangent in special_units() {
            for (l, e) in
                [(tangent, tangent), (tangent, -tangent), (DVec3::X, tangent), (-DVec3::Z, DVec3::Y)]
            {
                rows.extend(
                    [0.0, 0.01].map(|v| row().vec3(tangent).vec3(l).vec3(e).real(width).real(v).end()),
                );
            }
        }
    }
    Case {
        function: "simple_specular_cos",
        rows,
        twin: |args| {
            let [tangent, to_light, to_eye] = [args.vec3(), args.vec3(), args.vec3()];
            let value = simple::simple_specular_cos(tangent, to_light, to_eye, args.real(), args.real());
            vec![number("lobe", value, SHARE_OF_PEAK)]
        },
        invariant: None,
    }
}

fn distance_occlusion() -> Case {
    let mut rows = random_rows("distance_occlusion", |random| {
        let cubic: [f64; 4] = std::array::from_fn(|_| random.between(-1.5, 1.5));
        let reals = cubic.into_iter().fold(row(), |row, c| row.real(c));
        reals.real(random.between(-0.2, 1.4)).end()
    });
    for cubic in
        [[0.0; 4], [1.0, 0.0, 0.0, 0.0], [0.1, -0.3, 0.2, 0.9], [5.0, 1.0, 1.0, 1.0], [-5.0, 0.0, 0.0, 0.0]]
    {
        for distance in [0.0, 1.0, 1e-6, 1e6, -1e6] {
            rows.push(cubic.into_iter().fold(row(), |row, c| row.real(c)).real(distance).end());
        }
    }
    let twin = |args: &mut crate::harness::Args<'_>| -> Vec<Part> {
        let cubic: DVec4 = args.vec4();
        vec![number("visibility", occlusion_fit::distance_occlusion(cubic, args.real()), 1e-3)]
    };
    Case { function: "distance_occlusion", rows, twin, invariant: None }
}
