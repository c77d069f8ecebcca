//! `glsl/lib`.

use crate::harness::{Args, Case, Part, Row, number, numbers, vector};
use crate::inputs::{RANDOM_ROWS, Random, SPECIAL_T, random_rows, row, special_pieces, special_units};
use glam::{DVec3, DVec4};
use worsted::math::curve::{self, Basis, CurvePoint};
use worsted::math::{angle, color, frame, motion, strip, tone};

pub const BASES: [Basis; 4] = [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline];
/// Below this an angle or a factor has no relative error worth speaking of.
const FACTOR_FLOOR: f64 = 1e-3;

pub fn cases() -> Vec<Case> {
    let mut all = vec![bezier_from_basis(), bezier_point(), curve_point()];
    all.extend([unit_from_octahedral(), any_perpendicular(), direction_or(), normal_perpendicular_to()]);
    all.extend([angle_of(), longitudinal_angle(), cos_half_azimuth(), strip_side(), strip_normals()]);
    all.extend([seen_motion(), carried_vector()]);
    all.extend([tone_neutral(), tone_filmic(), srgb_from_linear()]);
    all
}

/// Fails unless the first three answers are a unit vector.
pub fn is_unit(found: &[f32]) -> Result<(), String> {
    let length = first_vec3(found).length();
    ((length - 1.0).abs() < 1e-5).then_some(()).ok_or_else(|| format!("length is {length}, not 1"))
}

/// Fails unless the first three answers are perpendicular to `axis`, to a thousandth of a radian.
pub fn is_perpendicular(found: &[f32], axis: DVec3) -> Result<(), String> {
    let cosine = first_vec3(found).dot(axis);
    (cosine.abs() < 1e-3).then_some(()).ok_or_else(|| format!("cosine with the axis is {cosine}, not 0"))
}

pub fn first_vec3(found: &[f32]) -> DVec3 {
    DVec3::new(found[0].into(), found[1].into(), found[2].into())
}

/// Largest magnitude of the points: the floor of a position's error.
pub fn largest(points: &[DVec3; 4]) -> f64 {
    points.iter().map(|p| p.length()).fold(f64::MIN_POSITIVE, f64::max)
}

/// Largest difference of neighbouring points: the floor of a derivative's error.
pub fn largest_difference(points: &[DVec3; 4]) -> f64 {
    points.windows(2).map(|pair| (pair[1] - pair[0]).length()).fold(f64::MIN_POSITIVE, f64::max)
}

fn curve_parts(p: &[DVec3; 4], c: CurvePoint) -> Vec<Part> {
    let floor = largest_difference(p);
    vec![
        vector("position", c.position, largest(p)),
        vector("derivative", c.derivative, floor),
        vector("second derivative", c.second_derivative, floor),
    ]
}

fn bezier_from_basis() -> Case {
    let mut rows =
        random_rows("bezier_from_basis", |random| row().bits(random.below(4)).piece(&random.piece()).end());
    rows.extend(special_pieces().iter().flat_map(|p| (0..4).map(|basis| row().bits(basis).piece(p).end())));
    Case {
        function: "bezier_from_basis",
        rows,
        twin: |args| {
            let basis = BASES[args.bits() as usize];
            let p = args.piece();
            let b = curve::bezier_from_basis(&p, basis);
            ["b0", "b1", "b2", "b3"]
                .iter()
                .zip(b)
                .map(|(name, point)| vector(name, point, largest(&p)))
                .collect()
        },
        invariant: None,
    }
}

fn bezier_point() -> Case {
    let mut rows = random_rows("bezier_point", |random| row().piece(&random.piece()).real(random.t()).end());
    rows.extend(special_pieces().iter().flat_map(|p| SPECIAL_T.map(|t| row().piece(p).real(t).end())));
    Case {
        function: "bezier_point",
        rows,
        twin: |args| {
            let b = args.piece();
            curve_parts(&b, curve::bezier_point(&b, args.real()))
        },
        invariant: None,
    }
}

fn curve_point() -> Case {
    let mut rows = random_rows("curve_point", |random| {
        row().bits(random.below(4)).piece(&random.piece()).real(random.t()).end()
    });
    for p in special_pieces() {
        for basis in 0..4 {
            rows.extend(SPECIAL_T.map(|t| row().bits(basis).piece(&p).real(t).end()));
        }
    }
    Case {
        function: "curve_point",
        rows,
        twin: |args| {
            let basis = BASES[args.bits() as usize];
            let p = args.piece();
            curve_parts(&p, curve::curve_point(&p, basis, args.real()))
        },
        invariant: None,
    }
}

fn unit_from_octahedral() -> Case {
    let mut rows = random_rows("unit_from_octahedral", |random| row().bits(random.bits()).end());
    let corners = [0_u32, 1, 0x3fff, 0x4000, 0x7fff, 0x8000, 0x8001, 0xbfff, 0xc000, 0xffff];
    rows.extend(corners.iter().flat_map(|x| corners.map(|y| row().bits(x | y << 16).end())));
    rows.extend(special_units().into_iter().map(|v| row().bits(frame::octahedral_from_unit(v)).end()));
    Case {
        function: "unit_from_octahedral",
        rows,
        twin: |args| vec![vector("unit", frame::unit_from_octahedral(args.bits()), 1.0)],
        invariant: Some(|_, found| is_unit(found)),
    }
}

fn any_perpendicular() -> Case {
    let mut rows = random_rows("any_perpendicular", |random| {
        let pole = if random.below(2) == 0 { DVec3::Z } else { -DVec3::Z };
        let v = if random.below(2) == 0 { random.unit() } else { random.unit_near(pole) };
        row().vec3(v).end()
    });
    rows.extend(special_units().into_iter().map(|v| row().vec3(v).end()));
    Case {
        function: "any_perpendicular",
        rows,
        twin: |args| vec![vector("perpendicular", frame::any_perpendicular(args.vec3()), 1.0)],
        invariant: Some(|args, found| is_unit(found).and_then(|()| is_perpendicular(found, args.vec3()))),
    }
}

fn direction_or() -> Case {
    let mut rows = random_rows("direction_or", |random| {
        row().vec3(random.unit() * random.magnitude(1e-11, 1e37)).vec3(random.unit()).end()
    });
    for v in special_units() {
        // On both sides of where a vector ceases to have a direction, and near the ends of f32.
        for scale in [0.0, 1e-30, 1e-20, 1e-13, 1e-11, 1e-6, 1e6, 1e20, 1e38] {
            rows.push(row().vec3(v * scale).vec3(DVec3::new(0.6, 0.0, 0.8)).end());
        }
    }
    Case {
        function: "direction_or",
        rows,
        twin: |args| vec![vector("unit", frame::direction_or(args.vec3(), args.vec3()), 1.0)],
        invariant: Some(|_, found| is_unit(found)),
    }
}

/// Pairs of a unit axis and a unit vector: any, nearly parallel, parallel and opposite.
fn axis_pairs(function: &str) -> Vec<crate::harness::Row> {
    let mut rows = random_rows(function, |random| {
        let axis = random.unit();
        let other = if random.below(4) == 0 { random.unit_near(axis) } else { random.unit() };
        row().vec3(axis).vec3(other).end()
    });
    let pair = |a: DVec3, b: DVec3| row().vec3(a).vec3(b).end();
    rows.extend(
        special_units().into_iter().flat_map(|a| special_units().into_iter().map(move |b| pair(a, b))),
    );
    // Parallel as f32 has it: the axis itself, whose rounded length is not quite 1.
    let mut random = Random::of("parallel");
    for _ in 0..RANDOM_ROWS / 10 {
        let axis = random.unit();
        rows.extend([pair(axis, axis), pair(axis, -axis)]);
    }
    rows
}

fn normal_perpendicular_to() -> Case {
    let mut rows = axis_pairs("normal_perpendicular_to");
    rows.extend(special_units().into_iter().map(|t| row().vec3(t).vec3(DVec3::ZERO).end()));
    Case {
        function: "normal_perpendicular_to",
        rows,
        twin: |args| vec![vector("normal", frame::normal_perpendicular_to(args.vec3(), args.vec3()), 1.0)],
        invariant: Some(|args, found| is_unit(found).and_then(|()| is_perpendicular(found, args.vec3()))),
    }
}

fn angle_of() -> Case {
    let mut rows = random_rows("angle_of", |random| {
        let (sin, cos) = random.between(-std::f64::consts::PI, std::f64::consts::PI).sin_cos();
        let length = random.magnitude(1e-6, 1e6);
        row().real(length * sin).real(length * cos).end()
    });
    rows.extend(random_rows("angle_of small", |random| {
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        row().real(sign * random.magnitude(1e-9, 1.0)).real(1.0).end()
    }));
    let ends = [0.0, -0.0, 1.0, -1.0, 1e-20, -1e20];
    rows.extend(ends.iter().flat_map(|&y| ends.map(|x| row().real(y).real(x).end())));
    Case {
        function: "angle_of",
        rows,
        twin: |args| vec![number("angle", angle::angle_of(args.real(), args.real()), 1e-12)],
        invariant: None,
    }
}

fn longitudinal_angle() -> Case {
    Case {
        function: "longitudinal_angle",
        rows: axis_pairs("longitudinal_angle"),
        twin: |args| vec![number("theta", angle::longitudinal_angle(args.vec3(), args.vec3()), FACTOR_FLOOR)],
        invariant: None,
    }
}

fn cos_half_azimuth() -> Case {
    let mut rows = random_rows("cos_half_azimuth", |random| {
        let tangent = random.unit();
        let a = if random.below(4) == 0 { random.unit_near(tangent) } else { random.unit() };
        let b = if random.below(4) == 0 { random.unit_near(a) } else { random.unit() };
        row().vec3(tangent).vec3(a).vec3(b).end()
    });
    for t in special_units() {
        for (a, b) in [(t, t), (t, -t), (DVec3::X, t), (DVec3::X, -DVec3::X), (DVec3::Y, DVec3::Z)] {
            rows.push(row().vec3(t).vec3(a).vec3(b).end());
        }
    }
    Case {
        function: "cos_half_azimuth",
        rows,
        twin: |args| {
            let cosine = angle::cos_half_azimuth(args.vec3(), args.vec3(), args.vec3());
            vec![number("cosine", cosine, FACTOR_FLOOR)]
        },
        invariant: Some(|_, found| {
            (0.0..=1.0).contains(&found[0]).then_some(()).ok_or("not in 0 to 1".into())
        }),
    }
}

fn strip_side() -> Case {
    Case {
        function: "strip_side",
        rows: axis_pairs("strip_side"),
        twin: |args| vec![vector("side", strip::strip_side(args.vec3(), args.vec3()), 1.0)],
        invariant: Some(|_, found| is_unit(found)),
    }
}

fn strip_normals() -> Case {
    let mut rows = random_rows("strip_normals", |random| row().real(random.between(-1.0, 1.0)).end());
    // A little over 1: interpolation across a strip may overshoot.
    for across in [-1.0, 1.0, 0.0, 1.000_001, -1.000_001, 0.999_999_9] {
        rows.push(row().real(across).end());
    }
    Case {
        function: "strip_normals",
        rows,
        twin: |args| {
            let values = strip::strip_normals(args.real()).to_array().to_vec();
            vec![numbers("normals", values, 1.0)]
        },
        invariant: None,
    }
}

fn tone_rows(function: &str, ends: &[f64]) -> Vec<Row> {
    let mut rows = random_rows(function, |random| {
        let color =
            DVec3::new(random.between(-0.1, 1.0), random.between(-0.1, 1.0), random.between(-0.1, 1.0));
        row().vec3(color * random.magnitude(1e-3, 1e3)).end()
    });
    for color in [DVec3::ONE, DVec3::X, DVec3::new(1.0, 0.5, -0.25), -DVec3::ONE] {
        rows.extend([0.0, 1e-20, 1.0, 1e6, 1e30].iter().chain(ends).map(|&s| row().vec3(s * color).end()));
    }
    rows
}

fn tone_neutral() -> Case {
    Case {
        function: "tone_neutral",
        rows: tone_rows("tone_neutral", &[0.8, 0.799_999, 0.800_001]),
        twin: |args| vec![vector("shown", tone::tone_neutral(args.vec3()), FACTOR_FLOOR)],
        invariant: Some(displayable),
    }
}

fn tone_filmic() -> Case {
    Case {
        function: "tone_filmic",
        rows: tone_rows("tone_filmic", &[7.24, 7.25, 8.0, 8.001]),
        twin: |args| vec![vector("shown", tone::tone_filmic(args.vec3()), FACTOR_FLOOR)],
        invariant: Some(displayable),
    }
}

fn displayable(_: &mut Args<'_>, found: &[f32]) -> Result<(), String> {
    found.iter().all(|c| (0.0..=1.0).contains(c)).then_some(()).ok_or("not in 0 to 1".into())
}

fn srgb_from_linear() -> Case {
    let mut rows = random_rows("srgb_from_linear", |random| {
        let value = if random.below(2) == 0 { random.between(0.0, 1.0) } else { random.magnitude(1e-6, 1.0) };
        row().real(value).end()
    });
    rows.extend([0.0, 1.0, 0.003_130_8, 0.003_130_7, 0.003_131, 1e-30].map(|v| row().real(v).end()));
    Case {
        function: "srgb_from_linear",
        rows,
        twin: |args: &mut Args<'_>| {
            vec![number("encoded", color::srgb_from_linear(args.real()), FACTOR_FLOOR)]
        },
        invariant: None,
    }
}

fn seen_motion() -> Case {
    let clip = |random: &mut Random| random.unit().extend(random.magnitude(0.1, 1e3));
    let row_of = |[a, b]: [DVec4; 2], near| {
        row().vec3(a.truncate()).real(a.w).vec3(b.truncate()).real(b.w).real(near).end()
    };
    let mut rows = random_rows("seen_motion", |random| {
        row_of([clip(random), clip(random)], random.magnitude(1e-3, 1.0))
    });
    // As far as one likes, on the near plane, behind it.
    for w in [1e6, 1.0, 0.5, 0.1, -2.0] {
        let (here, there) = (DVec3::new(0.3, -0.2, 0.1).extend(1.0), DVec3::new(-0.1, 0.4, 0.0).extend(w));
        rows.extend([[here, there], [there, here], [there, there]].map(|pair| row_of(pair, 0.5)));
    }
    Case {
        function: "seen_motion",
        rows,
        twin: |args| {
            let (clip, clip_then, near) = (args.vec4(), args.vec4(), args.real());
            let floor = [clip, clip_then].map(|c| c.truncate().truncate().length() / c.w.max(near));
            let found = motion::seen_motion(clip, clip_then, near);
            vec![numbers("motion", found.to_array().to_vec(), floor[0].max(floor[1]).max(f64::MIN_POSITIVE))]
        },
        invariant: None,
    }
}

fn carried_vector() -> Case {
    let axes = |random: &mut Random| {
        let normal = random.unit();
        [normal, normal.cross(frame::any_perpendicular(normal).normalize())]
    };
    let mut rows = random_rows("carried_vector", |random| {
        let ([a, b], [c, d]) = (axes(random), axes(random));
        row().vec3(random.magnitude(1e-3, 1e3) * random.unit()).vec3(a).vec3(b).vec3(c).vec3(d).end()
    });
    let still = [DVec3::X, DVec3::Y];
    for v in [DVec3::ZERO, DVec3::X, DVec3::NEG_Z, DVec3::splat(1e6)] {
        for [c, d] in [still, [DVec3::Y, DVec3::Z], [DVec3::NEG_X, DVec3::Y]] {
            rows.push(row().vec3(v).vec3(still[0]).vec3(still[1]).vec3(c).vec3(d).end());
        }
    }
    Case {
        function: "carried_vector",
        rows,
        twin: |args| {
            let v = args.vec3();
            let (now, then) = ([args.vec3(), args.vec3()], [args.vec3(), args.vec3()]);
            vec![vector("carried", motion::carried_vector(v, now, then), v.length().max(f64::MIN_POSITIVE))]
        },
        invariant: None,
    }
}
