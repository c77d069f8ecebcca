//! `glsl/bsdf/khungurn.glsl` and `glsl/lib/special.glsl` against their twins, which read the same tables.

use crate::harness::{Args, Case, Part, Row, number, vector};
use crate::inputs::{Random, random_rows, row};
use crate::khungurn_rows::{ambient_rows, bcsdf_cos_rows, bcsdf_rows, pole_distance, take_fiber, variance};
use crate::scattering_tables::{WIDTHS_DEG, table, width};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use worsted::bsdf::khungurn::tabulated::{self, Scattering, TabulatedLobe};
use worsted::bsdf::khungurn::{Lobes, schlick, schlick_rest};
use worsted::math::special::{i0e, normal_cdf, normal_density};

/// The floor of a scattering function's error, as a share of its peak.
pub const SHARE_OF_PEAK: f64 = 1e-4;

pub fn cases() -> Vec<Case> {
    let mut all = vec![normal_case("normal_density"), normal_case("normal_cdf")];
    all.extend([schlick_case("schlick"), schlick_case("schlick_rest")]);
    all.extend(shapes());
    all.extend([azimuthal_tt(), scattering_table_at(), longitudinal(), ambient_integrals()]);
    all.extend([bcsdf(), bcsdf_cos(), ambient_scattering()]);
    all
}

fn not_negative(_: &mut Args<'_>, found: &[f32]) -> Result<(), String> {
    found.iter().all(|v| *v >= 0.0).then_some(()).ok_or_else(|| format!("below 0: {found:?}"))
}

fn normal_case(function: &'static str) -> Case {
    let mut rows = random_rows(function, |random| row().real(random.between(-9.0, 9.0)).end());
    rows.extend([0.0, 1e-20, -40.0, 40.0, 1e4].map(|z| row().real(z).end()));
    let twin: fn(&mut Args<'_>) -> Vec<Part> = if function == "normal_cdf" {
        // Abramowitz and Stegun's formula is good to 1.5e-7 of 1.
        |args| vec![number("share", normal_cdf(args.real()), 1e-2)]
    } else {
        |args| vec![number("density", normal_density(args.real()), SHARE_OF_PEAK)]
    };
    Case { function, rows, twin, invariant: Some(not_negative) }
}

fn schlick_case(function: &'static str) -> Case {
    let mut rows = random_rows(function, |random| row().real(pole_distance(random, 0.1).sin()).end());
    rows.extend([0.0, 1e-9, 1.0, 0.999_999_94].map(|c| row().real(c).end()));
    let twin: fn(&mut Args<'_>) -> Vec<Part> = if function == "schlick" {
        |args| vec![number("share", schlick(args.real()), SHARE_OF_PEAK)]
    } else {
        |args| vec![number("share", schlick_rest(args.real()), f64::MIN_POSITIVE)]
    };
    Case { function, rows, twin, invariant: Some(not_negative) }
}

/// An angle, by its cosine or as the distance from the pole, and a width.
fn shape_rows(function: &str, by_cosine: bool) -> Vec<Row> {
    let mut rows = random_rows(function, |random| {
        let width = random.magnitude(0.5, 60.0).to_radians();
        let x = pole_distance(random, width);
        row().real(if by_cosine { x.sin() } else { x }).real(width).end()
    });
    for width_deg in WIDTHS_DEG {
        let ends = if by_cosine { [0.0, 1e-9, 1.0] } else { [0.0, 1e-9, FRAC_PI_2] };
        rows.extend(ends.map(|x| row().real(x).real(width_deg.to_radians()).end()));
    }
    rows
}

fn shapes() -> [Case; 5] {
    let case = |function, by_cosine, twin| Case {
        function,
        rows: shape_rows(function, by_cosine),
        twin,
        invariant: Some(not_negative),
    };
    [
        case("gaussian_normaliser", true, |args| {
            vec![number("normaliser", tabulated::gaussian_normaliser(args.real(), args.real()), 1e-30)]
        }),
        case("normaliser_position", true, |args| {
            vec![number("position", tabulated::normaliser_position(args.real(), args.real()), 1e-2)]
        }),
        Case {
            // A rounding below 0 is clamped where the table is read.
            invariant: None,
            ..case("ambient_position", false, |args| {
                vec![number("position", tabulated::ambient_position(args.real(), args.real()), 1e-2)]
            })
        },
        case("grazing_moment", true, |args| {
            let (cos_o, width) = (args.real(), args.real());
            let peak = tabulated::grazing_moment(0.0, width);
            vec![number("moment", tabulated::grazing_moment(cos_o, width), SHARE_OF_PEAK * peak)]
        }),
        case("through_moment", true, |args| {
            vec![number("moment", tabulated::through_moment(args.real(), args.real()), 1e-30)]
        }),
    ]
}

/// |cos(phi / 2)|, k and the factor that goes with it.
pub fn azimuthal_rows(function: &str) -> Vec<Row> {
    let with = |c: f64, gamma_deg: f64| {
        let k = f64::from(gamma_deg.to_radians().powi(-2) as f32);
        row().real(c).real(k).real(1.0 / (2.0 * PI * i0e(k))).end()
    };
    let mut rows = random_rows(function, |random| {
        let gamma_deg = random.magnitude(0.5, 60.0);
        let near = 0.5 * gamma_deg.to_radians() * random.between(0.0, 5.0);
        with(if random.below(4) == 0 { random.between(0.0, 1.0) } else { near.min(1.0) }, gamma_deg)
    });
    for gamma_deg in [0.5, 6.08, 12.0, 60.0] {
        rows.extend([0.0, 1e-9, 1e-3, 1.0].map(|c| with(c, gamma_deg)));
    }
    rows
}

fn azimuthal_tt() -> Case {
    Case {
        function: "azimuthal_tt",
        rows: azimuthal_rows("azimuthal_tt"),
        twin: |args| {
            let (cos_half_phi, k, n_tt) = (args.real(), args.real(), args.real());
            let value = tabulated::azimuthal_tt(cos_half_phi, k, n_tt);
            vec![number("per radian", value, SHARE_OF_PEAK * n_tt)]
        },
        invariant: Some(not_negative),
    }
}

fn random_table(random: &mut Random) -> u32 {
    random.below(WIDTHS_DEG.len() as u32)
}

fn scattering_table_at() -> Case {
    let mut rows = random_rows("scattering_table_at", |random| {
        row().bits(random_table(random)).real(random.between(-0.01, 1.01)).end()
    });
    for index in 0..WIDTHS_DEG.len() as u32 {
        rows.extend([0.0, 1.0, 0.999_999_94, -1.0, 7.0].map(|p| row().bits(index).real(p).end()));
    }
    Case {
        function: "scattering_table_at",
        rows,
        twin: |args| {
            let table = table(args.bits());
            let [x, y, z, w] = tabulated::scattering_table_at(table, args.real());
            vec![vector("factors", DVec3::new(x, y, z), 1e-30), number("through", w, 1e-30)]
        },
        invariant: Some(not_negative),
    }
}

fn take_lobe(args: &mut Args<'_>) -> TabulatedLobe<'static> {
    let table = table(args.bits());
    TabulatedLobe { width: args.real(), table }
}

fn longitudinal() -> Case {
    let rows = random_rows("longitudinal", |random| {
        let index = random_table(random);
        let spread = variance(random);
        let theta_sum = (width(index).powi(2) + spread).sqrt() * random.between(-6.0, 6.0);
        let cos_i = pole_distance(random, width(index)).sin();
        row().bits(index).real(width(index)).real(theta_sum).real(cos_i).real(spread).end()
    });
    Case {
        function: "longitudinal",
        rows,
        twin: |args| {
            let lobe = take_lobe(args);
            let (theta_sum, cos_i, variance) = (args.real(), args.real(), args.real());
            let peak = tabulated::longitudinal(0.0, cos_i, variance, lobe);
            let value = tabulated::longitudinal(theta_sum, cos_i, variance, lobe);
            vec![number("per radian", value, SHARE_OF_PEAK * peak)]
        },
        invariant: Some(not_negative),
    }
}

fn ambient_integrals() -> Case {
    let rows = random_rows("ambient_integrals", |random| {
        let index = random_table(random);
        let x_o = pole_distance(random, width(index));
        row().bits(index).real(width(index)).real(x_o).real(x_o.sin()).end()
    });
    Case {
        function: "ambient_integrals",
        rows,
        twin: |args| {
            let lobe = take_lobe(args);
            let [all, grazing, through] = tabulated::ambient_integrals(args.real(), args.real(), lobe);
            vec![
                number("all", all, SHARE_OF_PEAK),
                number("grazing", grazing, SHARE_OF_PEAK),
                number("through", through, SHARE_OF_PEAK),
            ]
        },
        invariant: Some(not_negative),
    }
}

/// Both lobes, each with a floor that is a share of its peak.
pub fn parts(lobes: Lobes, peak: Lobes) -> Vec<Part> {
    let floor = |peak: DVec3| (SHARE_OF_PEAK * peak.length()).max(1e-30);
    vec![vector("r", lobes.r, floor(peak.r)), vector("tt", lobes.tt, floor(peak.tt))]
}

/// The largest S for light from where the cosine is `cos_i`, if R reflected all of it: F is the difference of numbers
/// near 1 where light comes in straight.
fn peak(cos_i: f64, variance: f64, s: &Scattering<'_>) -> Lobes {
    let reflected = tabulated::longitudinal(0.0, cos_i, variance, s.r) / TAU;
    Lobes { r: DVec3::splat(reflected), tt: tabulated::bcsdf(0.0, cos_i, 0.0, variance, s).tt }
}

fn bcsdf() -> Case {
    Case {
        function: "bcsdf",
        rows: bcsdf_rows("bcsdf"),
        twin: |args| {
            let (s, _) = take_fiber(args);
            let (theta_sum, cos_i, cos_half_phi) = (args.real(), args.real(), args.real());
            let variance = args.real();
            let lobes = tabulated::bcsdf(theta_sum, cos_i, cos_half_phi, variance, &s);
            parts(lobes, peak(cos_i, variance, &s))
        },
        invariant: Some(not_negative),
    }
}

fn bcsdf_cos() -> Case {
    Case {
        function: "bcsdf_cos",
        rows: bcsdf_cos_rows("bcsdf_cos"),
        twin: |args| {
            let (s, _) = take_fiber(args);
            let [tangent, to_light, to_eye] = [args.vec3(), args.vec3(), args.vec3()];
            let variance = args.real();
            let lobes = tabulated::bcsdf_cos(tangent, to_light, to_eye, variance, &s);
            let cos_i = tangent.cross(to_light).length().min(1.0);
            parts(lobes, peak(cos_i, variance, &s).scaled(cos_i))
        },
        invariant: Some(not_negative),
    }
}

fn ambient_scattering() -> Case {
    Case {
        function: "ambient_scattering",
        rows: ambient_rows("ambient_scattering"),
        twin: |args| {
            let (s, _) = take_fiber(args);
            let lobes = tabulated::ambient_scattering(args.vec3(), args.vec3(), &s);
            parts(lobes, Lobes { r: DVec3::ONE, tt: DVec3::ONE })
        },
        invariant: Some(not_negative),
    }
}
