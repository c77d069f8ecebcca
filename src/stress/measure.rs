//! How far the device is from f64, and how far it may be: |device - f64| / max(|f64|, floor), by `equations.md`.

use crate::probe::Function;
use crate::probe::fields::Values;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// Largest error where a formula is evaluated.
pub const BY_FORMULA: f64 = 1e-4;
/// Where a table of scattering is read.
pub const BY_TABLE: f64 = 1e-3;
/// The same within [`GRAZING`] of the fiber's direction.
pub const AT_GRAZING: f64 = 1e-2;
/// How near to the fiber's direction light or eye are when they graze, in radians.
pub const GRAZING: f64 = 1e-3;
/// The floor as a share of a scattering function's peak, and that of factors.
const SHARE_OF_PEAK: f64 = 1e-4;
const FACTOR: f64 = 1e-3;
/// Below the largest of any of the integrals over uniform light, at any width.
const AMBIENT_PEAK: f64 = 0.2;
/// Where all is 0, nothing may be more than this off.
const NOTHING: f64 = 1e-30;

/// One part of one answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Error {
    /// The part's name.
    pub part: &'static str,
    /// How far off it is, as a share of `scale`.
    pub error: f64,
    /// The most that may be.
    pub limit: f64,
    /// What an error of 1 is, in the answer's unit.
    pub scale: f64,
}

/// The errors of every answer's parts, query by query, of the device's answers `found` against those of f64.
pub fn errors(
    function: &Function,
    queries: &[Vec<f64>],
    found: &[Vec<f64>],
    exact: &[Vec<f64>],
) -> Vec<Vec<Error>> {
    let floors = floors(function, queries);
    let of = |i: usize| {
        let limit = limit(function, &queries[i]);
        let mut start = 0;
        let part = |(name, shape): &(&'static str, crate::probe::function::Shape)| {
            let range = start..start + shape.numbers();
            start = range.end;
            let (found, exact) = (found[i].get(range.clone()), exact[i].get(range));
            let (Some(found), Some(exact)) = (found, exact) else {
                return Error { part: name, error: f64::NAN, limit, scale: 1.0 };
            };
            let off: Vec<f64> = found.iter().zip(exact).map(|(a, b)| a - b).collect();
            let scale = length(exact).max(floor(function, name, &queries[i], &floors[i]));
            Error { part: name, error: length(&off) / scale, limit, scale }
        };
        function.results.iter().map(part).collect()
    };
    (0..queries.len()).map(of).collect()
}

fn length(numbers: &[f64]) -> f64 {
    numbers.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The most that an answer may be off.
fn limit(function: &Function, query: &[f64]) -> f64 {
    match function.name {
        "bcsdf" | "bcsdf_cos" | "ambient_scattering" | "longitudinal_normaliser"
            if grazes(function, query) =>
        {
            AT_GRAZING
        }
        "bcsdf" | "bcsdf_cos" | "ambient_scattering" | "longitudinal_normaliser" => BY_TABLE,
        _ => BY_FORMULA,
    }
}

fn grazes(function: &Function, query: &[f64]) -> bool {
    ["theta", "theta_i", "theta_o"].iter().any(|angle| {
        function.place_of(angle).is_some_and(|place| FRAC_PI_2 - query[place.start].abs() < GRAZING)
    })
}

fn floor(function: &Function, part: &str, query: &[f64], peak: &[f64]) -> f64 {
    let points = || -> Vec<DVec3> {
        let place = function.place_of("control_points").unwrap_or(0..0);
        query[place].chunks_exact(3).map(DVec3::from_slice).collect()
    };
    match (function.name, part) {
        ("curve_point", "derivative") => {
            let points = points();
            let apart = points.iter().flat_map(|a| points.iter().map(move |b| a.distance(*b)));
            apart.fold(NOTHING, f64::max)
        }
        // Near the end of a very flat ellipse's short axis what f32 has of the angle is far along the long one.
        ("fiber_point", "position") => {
            points().iter().map(|p| p.length()).fold(reach(function, query), f64::max)
        }
        ("curve_point" | "fiber_point", _) => points().iter().map(|p| p.length()).fold(NOTHING, f64::max),
        ("migration_radius" | "lod_factor" | "fiber_density", _) => FACTOR,
        ("tone_neutral" | "tone_filmic" | "srgb_from_linear", _) => FACTOR,
        ("ambient_scattering", _) => SHARE_OF_PEAK * AMBIENT_PEAK,
        (_, "tt") => (SHARE_OF_PEAK * length(peak.get(3..6).unwrap_or_default())).max(NOTHING),
        (_, "r") => (SHARE_OF_PEAK * length(peak.get(..3).unwrap_or_default())).max(NOTHING),
        _ => (SHARE_OF_PEAK * length(peak)).max(NOTHING),
    }
}

/// Ratio of a ply's half-axes from which on a fiber's place is measured by the longer one.
const FLAT: f64 = 100.0;

/// How far a fiber of a ply flatter than 100:1 may be from its yarn's centre line.
fn reach(function: &Function, query: &[f64]) -> f64 {
    let of = |path: &str| function.place_of(path).map_or(0.0, |place| query[place.start]);
    let axes = [of("yarn.ellipse_short"), of("yarn.ellipse_long")];
    let axis = axes[0].max(axes[1]);
    if axis < FLAT * axes[0].min(axes[1]) {
        return NOTHING;
    }
    (0.5 * of("yarn.yarn_radius") + axis * of("fiber.radius") * of("yarn.migration_max")).max(NOTHING)
}

/// What f64 answers where each query's function has its peak; nothing where floors need none.
fn floors(function: &Function, queries: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let at = |edit: &(dyn Fn(&mut Vec<f64>) + Sync)| -> Vec<Vec<f64>> {
        let answer = |query: &Vec<f64>| {
            let mut query = query.clone();
            edit(&mut query);
            (function.exact)(Values::new(&query))
        };
        queries.par_iter().map(answer).collect()
    };
    let set = |query: &mut Vec<f64>, path: &str, value: f64| {
        if let Some(place) = function.place_of(path) {
            query[place].fill(value);
        }
    };
    // Toward where both lobes are largest.
    let mirrored = |query: &mut Vec<f64>| {
        let theta_i = function.place_of("theta_i").map_or(0.0, |place| query[place.start]);
        set(query, "phi", PI);
        set(query, "theta_o", -theta_i);
    };
    match function.name {
        "azimuthal_tt" => at(&|query| set(query, "phi", PI)),
        "longitudinal_normaliser" => at(&|query| set(query, "theta", 0.0)),
        "simple_specular" => at(&|query| {
            set(query, "phi", 0.0);
            set(query, "theta_h", 0.0);
        }),
        "bcsdf" | "bcsdf_cos" => {
            let lobes = at(&mirrored);
            // As if R reflected all: F is the difference of numbers near 1 where light comes in straight.
            let white = at(&|query| {
                mirrored(query);
                set(query, "fiber.c_r", 1.0);
            });
            white.into_iter().zip(lobes).map(|(white, lobes)| [&white[..3], &lobes[3..]].concat()).collect()
        }
        _ => vec![Vec::new(); queries.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::find;

    fn only(name: &str, query: &[f64], found: &[f64], exact: &[f64]) -> Error {
        let function = find(name).unwrap();
        errors(function, &[query.to_vec()], &[found.to_vec()], &[exact.to_vec()])[0][0]
    }

    #[test]
    fn errors_are_shares_of_the_value_or_of_a_floor() {
        let factor = only("lod_factor", &[1.0, 0.5, 2.0], &[0.5001], &[0.5]);
        assert!((factor.error - 2e-4).abs() < 1e-12 && factor.limit == 1e-4, "{factor:?}");
        let floor = only("lod_factor", &[1.0, 0.5, 2.0], &[1e-7], &[0.0]);
        assert!((floor.error - 1e-4).abs() < 1e-12, "{floor:?}");
        let lost = only("lod_factor", &[1.0, 0.5, 2.0], &[], &[0.5]);
        assert!(lost.error.is_nan());
        let nan = only("lod_factor", &[1.0, 0.5, 2.0], &[f64::NAN], &[0.5]);
        assert!(nan.error.is_nan());
    }

    #[test]
    fn grazing_light_may_be_farther_off() {
        for (theta, limit) in
            [(0.3, BY_TABLE), (FRAC_PI_2 - 2e-3, BY_TABLE), (0.5e-3 - FRAC_PI_2, AT_GRAZING)]
        {
            assert_eq!(
                only("longitudinal_normaliser", &[theta, 0.2], &[1.0], &[1.0]).limit,
                limit,
                "{theta}"
            );
        }
    }

    #[test]
    fn far_from_its_peak_a_lobe_is_measured_by_a_share_of_the_peak() {
        let width = 0.01;
        let error = only("azimuthal_tt", &[0.0, width], &[1e-6], &[0.0]);
        // The peak of a narrow lobe is that of a Gaussian.
        let peak = 1.0 / (width * (2.0 * PI).sqrt());
        assert!((error.scale / (1e-4 * peak) - 1.0).abs() < 1e-3, "{error:?}");
    }
}
