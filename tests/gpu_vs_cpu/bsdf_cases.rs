//! `glsl/bsdf` and `glsl/shading`.

use crate::harness::{Case, Part, number, vector};
use crate::inputs::{Random, random_rows, row, special_units};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, PI};
use worsted::bsdf::simple;
use worsted::precompute::occlusion_fit;

/// The floor of a scattering function's error, as a share of its peak.
const SHARE_OF_PEAK: f64 = 1e-4;
const WIDTHS_DEG: [f64; 5] = [0.5, 2.0, 10.0, 30.0, 90.0];

pub fn cases() -> Vec<Case> {
    vec![simple_diffuse(), simple_specular(), simple_specular_cos(), distance_occlusion()]
}

fn simple_diffuse() -> Case {
    let mut rows = random_rows("simple_diffuse", |random| {
        let strength =
            DVec3::new(random.between(0.0, 1.0), random.between(0.0, 1.0), random.magnitude(1e-3, 1.0));
        row().vec3(strength).vec3(random.unit()).vec3(random.unit()).end()
    });
    for n in special_units() {
        rows.extend(
            special_units().into_iter().map(|l| row().vec3(DVec3::new(0.2, 0.5, 1.0)).vec3(n).vec3(l).end()),
        );
    }
    Case {
        function: "simple_diffuse",
        rows,
        twin: |args| {
            let (strength, normal, to_light) = (args.vec3(), args.vec3(), args.vec3());
            let floor = SHARE_OF_PEAK * strength.length() / PI;
            vec![vector("radiance", simple::simple_diffuse(strength, normal, to_light), floor)]
        },
        invariant: None,
    }
}

fn simple_specular() -> Case {
    let mut rows = random_rows("simple_specular", |random| {
        let width = random.magnitude(0.5, 90.0).to_radians();
        let theta_h = width * random.between(-6.0, 6.0);
        row().real(random.between(0.0, 1.0)).real(theta_h.clamp(-FRAC_PI_2, FRAC_PI_2)).real(width).end()
    });
    for width_deg in WIDTHS_DEG {
        for theta_h in [0.0, 1e-6, -1e-3, 0.04, -0.5, FRAC_PI_2, -FRAC_PI_2] {
            rows.extend(
                [0.0, 1e-4, 1.0].map(|c| row().real(c).real(theta_h).real(width_deg.to_radians()).end()),
            );
        }
    }
    Case {
        function: "simple_specular",
        rows,
        twin: |args| {
            let value = simple::simple_specular(args.real(), args.real(), args.real());
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
        row().vec3(tangent).vec3(to_light).vec3(to_eye).real(width).end()
    });
    for width_deg in WIDTHS_DEG {
        let width = f64::to_radians(width_deg);
        for tangent in special_units() {
            for (l, e) in
                [(tangent, tangent), (tangent, -tangent), (DVec3::X, tangent), (-DVec3::Z, DVec3::Y)]
            {
                rows.push(row().vec3(tangent).vec3(l).vec3(e).real(width).end());
            }
        }
    }
    Case {
        function: "simple_specular_cos",
        rows,
        twin: |args| {
            let value = simple::simple_specular_cos(args.vec3(), args.vec3(), args.vec3(), args.real());
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
