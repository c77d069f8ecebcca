//! `glsl/bsdf/khungurn.glsl`, tables and all, against quadrature in f64 that reads none.

use crate::answers;
use crate::harness::{Args, Case, Part, Row, Summary, compare, compare_strictly, number, twin_of};
use crate::khungurn_cases::{SHARE_OF_PEAK, azimuthal_rows, parts};
use crate::khungurn_rows::{ambient_rows, bcsdf_cos_rows, bcsdf_rows, take_fiber};
use glam::DVec3;
use std::f64::consts::TAU;
use worsted::bsdf::khungurn::{self, FiberScattering, Lobes, bcsdf_of_sum, longitudinal};

/// Bound where a table is read, and where a direction is within so many radians of the tangent.
const BY_TABLE: f64 = 1e-3;
const GRAZING: f64 = 1e-3;
const AT_GRAZING: f64 = 1e-2;
/// The largest S for light from where the cosine is `cos_i`, if R reflected all of it: F is the difference of numbers
/// near 1 where light comes in straight. TT is nothing at the pole, and so would be its peak.
fn peak(cos_i: f64, variance: f64, fiber: &FiberScattering) -> Lobes {
    let theta_i = cos_i.clamp(1e-6, 1.0).acos();
    let reflected = longitudinal(0.0, theta_i, fiber.beta_r, variance) / TAU;
    let tt = bcsdf_of_sum(0.0, theta_i, 0.0, variance, fiber).tt;
    Lobes { r: DVec3::splat(reflected), tt }
}

/// Random rows are made in parts of `RANDOM_ROWS`.
const PARTS: usize = 10;
const LEAST_ROWS: usize = 20_000;

fn many(function: &str, rows: fn(&str) -> Vec<Row>) -> Vec<Row> {
    (0..PARTS).flat_map(|part| rows(&format!("{function} {part}"))).collect()
}

fn bounded(parts: Vec<Part>, grazing: bool) -> Vec<Part> {
    let bound = if grazing { AT_GRAZING } else { BY_TABLE };
    parts.into_iter().map(|part| part.within(bound)).collect()
}

fn case(function: &'static str, rows: fn(&str) -> Vec<Row>, twin: fn(&mut Args<'_>) -> Vec<Part>) -> Case {
    Case { function, rows: many(function, rows), twin, invariant: None }
}

fn azimuthal_tt() -> Case {
    case("azimuthal_tt", azimuthal_rows, |args| {
        let (cos_half_phi, k, n_tt) = (args.real(), args.real(), args.real());
        let value = khungurn::azimuthal_tt(cos_half_phi, k.powf(-0.5));
        vec![number("per radian", value, SHARE_OF_PEAK * n_tt)]
    })
}

fn bcsdf() -> Case {
    case("bcsdf", bcsdf_rows, |args| {
        let (_, fiber) = take_fiber(args);
        let (theta_sum, cos_i, cos_half_phi) = (args.real(), args.real(), args.real());
        let variance = args.real();
        let lobes = bcsdf_of_sum(theta_sum, cos_i.acos(), cos_half_phi, variance, &fiber);
        bounded(parts(lobes, peak(cos_i, variance, &fiber)), cos_i < GRAZING)
    })
}

fn bcsdf_cos() -> Case {
    case("bcsdf_cos", bcsdf_cos_rows, |args| {
        let (_, fiber) = take_fiber(args);
        let [tangent, to_light, to_eye] = [args.vec3(), args.vec3(), args.vec3()];
        let variance = args.real();
        let lobes = khungurn::bcsdf_cos_of_directions(tangent, to_light, to_eye, variance, &fiber);
        let [cos_i, cos_o] = [to_light, to_eye].map(|w| tangent.cross(w).length());
        let peak = peak(cos_i, variance, &fiber);
        bounded(parts(lobes, peak.scaled(cos_i.max(1e-6))), cos_i.min(cos_o) < GRAZING)
    })
}

/// Below the largest value of any of the integrals over uniform light, at any width.
const AMBIENT_PEAK: f64 = 0.2;

fn ambient_scattering() -> Case {
    case("ambient_scattering", ambient_rows, |args| {
        let (_, fiber) = take_fiber(args);
        let (tangent, to_eye) = (args.vec3(), args.vec3());
        let cos_o = tangent.cross(to_eye).length();
        let theta_o = tangent.dot(to_eye).atan2(cos_o);
        let rest = DVec3::ONE - fiber.c_r;
        let peak = Lobes { r: DVec3::ONE, tt: rest * fiber.c_tt }.scaled(AMBIENT_PEAK);
        bounded(parts(khungurn::ambient_scattering(theta_o, &fiber), peak), cos_o < GRAZING)
    })
}

fn report(function: &str, summary: Result<Summary, String>) {
    let summary = summary.unwrap_or_else(|message| panic!("{message}"));
    println!("{function}: {summary:?}");
    assert!(summary.rows >= LEAST_ROWS, "{function}: {} rows", summary.rows);
}

/// The device against the truth, with nothing allowed for how the arguments were rounded; and against a truth half a
/// percent off, which must be refused.
fn check_strictly(case: &Case) {
    let found = answers(case);
    report(case.function, compare_strictly(case, &found, |row| twin_of(case, row)));
    let wrong = compare_strictly(case, &found, |row| {
        let mut parts = twin_of(case, row);
        parts.iter_mut().for_each(|part| part.values.iter_mut().for_each(|v| *v *= 1.005));
        parts
    });
    assert!(wrong.is_err(), "{}: a truth half a percent off passed", case.function);
}

#[test]
fn the_azimuthal_lobe_is_the_truth_on_the_device() {
    check_strictly(&azimuthal_tt());
}

#[test]
fn the_scattering_function_is_the_truth_on_the_device() {
    check_strictly(&bcsdf());
}

#[test]
fn scattering_of_uniform_light_is_the_truth_on_the_device() {
    check_strictly(&ambient_scattering());
}

#[test]
fn the_scattering_function_of_directions_is_the_truth_on_the_device() {
    let case = bcsdf_cos();
    report(case.function, compare(&case, &answers(&case), |row| twin_of(&case, row)));
}
