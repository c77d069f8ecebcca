//! How far the device is from f64: |device - f64| / max(|f64|, floor), or of a table's range.

use crate::answers;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;
use worsted::precompute::occlusion_table::OCCLUSION_LIMIT;
use worsted::precompute::self_shadow::SELF_SHADOW_LIMIT;
use worsted::precompute::table_error::TableError;
use worsted::probe::find;

/// Bounds where a formula is evaluated, where a table of scattering is read, and so near to grazing.
const BY_FORMULA: f64 = 1e-4;
const BY_TABLE: f64 = 1e-3;
const AT_GRAZING: f64 = 1e-2;
const GRAZING: f64 = 1e-3;
/// The floor as a share of a scattering function's peak, and that of factors.
const SHARE_OF_PEAK: f64 = 1e-4;
const FACTOR: f64 = 1e-3;
/// Below the largest of any of the integrals over uniform light, at any width.
const AMBIENT_PEAK: f64 = 0.2;

/// What a comparison came to.
pub struct Figures {
    /// Largest error as a share of what is allowed; for tables of the yarn's inside, of each of their limits.
    worst: f64,
    /// Largest error away from grazing, and there.
    errors: [f64; 2],
    table: Option<TableError>,
    /// Where it is worst.
    pub worst_query: String,
}

impl Figures {
    /// Whether nothing is beyond its bound.
    pub fn good(&self) -> bool {
        self.worst <= 1.0
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.table {
            Some(TableError { rms, p99, worst }) => {
                write!(f, "rms {rms:.1e}, p99 {p99:.1e}, worst {worst:.1e}")
            }
            None => write!(f, "worst {:.1e}, grazing {:.1e}", self.errors[0], self.errors[1]),
        }
    }
}

/// An answer with every number times `factor`.
pub fn scaled(answer: &Value, factor: f64) -> Value {
    match answer {
        Value::Object(parts) => {
            parts.iter().map(|(name, part)| (name.clone(), scaled(part, factor))).collect()
        }
        Value::Array(parts) => parts.iter().map(|part| scaled(part, factor)).collect(),
        number => json!(factor * number.as_f64().unwrap()),
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .map_or_else(|| vec![value.as_f64().unwrap()], |parts| parts.iter().flat_map(numbers).collect())
}

fn length(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn off(found: &Value, exact: &Value) -> f64 {
    let difference: Vec<f64> = numbers(found).iter().zip(numbers(exact)).map(|(a, b)| a - b).collect();
    length(&difference)
}

/// Compares all answers to a function's queries.
pub fn figures(function: &str, queries: &[Value], found: &[Value], exact: &[Value]) -> Figures {
    assert!(queries.len() == found.len() && queries.len() == exact.len() && !queries.is_empty());
    match function {
        "self_shadow_depth" => tables(queries, found, exact, "optical_depth", SELF_SHADOW_LIMIT),
        "ambient_occlusion" => {
            let limit = TableError { rms: OCCLUSION_LIMIT, p99: OCCLUSION_LIMIT, worst: OCCLUSION_LIMIT };
            tables(queries, found, exact, "visibility", limit)
        }
        _ => formulas(function, queries, found, exact),
    }
}

/// Shares of each yarn's largest value; visibilities are of 1 as they are.
fn tables(queries: &[Value], found: &[Value], exact: &[Value], part: &str, limit: TableError) -> Figures {
    let range = |yarn: &Value| {
        let of_yarn = queries.iter().zip(exact).filter(|(query, _)| query["yarn"] == *yarn);
        of_yarn.map(|(_, exact)| exact[part].as_f64().unwrap()).fold(0.0, f64::max)
    };
    let mut ranges: Vec<(&Value, f64)> = Vec::new();
    for query in queries {
        if !ranges.iter().any(|(yarn, _)| **yarn == query["yarn"]) {
            ranges.push((&query["yarn"], if part == "visibility" { 1.0 } else { range(&query["yarn"]) }));
        }
    }
    let pair = |((query, found), exact): ((&Value, &Value), &Value)| {
        let range = ranges.iter().find(|(yarn, _)| **yarn == query["yarn"]).unwrap().1;
        (found[part].as_f64().unwrap() / range, exact[part].as_f64().unwrap() / range)
    };
    let pairs: Vec<(f64, f64)> = queries.iter().zip(found).zip(exact).map(pair).collect();
    let error = TableError::new(&pairs, 1.0);
    let apart = |i: &usize| (pairs[*i].0 - pairs[*i].1).abs();
    let at = (0..pairs.len()).max_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
    Figures {
        worst: (error.rms / limit.rms).max(error.p99 / limit.p99).max(error.worst / limit.worst),
        errors: [error.worst, 0.0],
        worst_query: format!("{} gave {}, not {}", queries[at], found[at], exact[at]),
        table: Some(error),
    }
}

fn formulas(function: &str, queries: &[Value], found: &[Value], exact: &[Value]) -> Figures {
    let mut figures = Figures { worst: 0.0, errors: [0.0; 2], table: None, worst_query: String::new() };
    let peaks = peaks(function, queries);
    for (index, query) in queries.iter().enumerate() {
        for (name, truth) in exact[index].as_object().unwrap() {
            let floor = floor(function, name, query, &peaks[index]);
            let error = off(&found[index][name], truth) / length(&numbers(truth)).max(floor);
            let near = grazing(query);
            let bound = match function {
                "bcsdf" | "bcsdf_cos" | "ambient_scattering" | "longitudinal_normaliser" if near => {
                    AT_GRAZING
                }
                "bcsdf" | "bcsdf_cos" | "ambient_scattering" | "longitudinal_normaliser" => BY_TABLE,
                _ => BY_FORMULA,
            };
            let worst = &mut figures.errors[usize::from(near)];
            *worst = worst.max(error);
            // What is no number is worst of all.
            let share = if error.is_nan() { f64::INFINITY } else { error / bound };
            if share > figures.worst {
                figures.worst = share;
                figures.worst_query =
                    format!("{name} is {error:.1e} off: {query} gave {}, not {}", found[index], exact[index]);
            }
        }
    }
    figures
}

fn grazing(query: &Value) -> bool {
    ["theta", "theta_i", "theta_o"].iter().any(|angle| {
        query.get(angle).is_some_and(|theta| FRAC_PI_2 - theta.as_f64().unwrap().abs() < GRAZING)
    })
}

/// Answers in f64 where each query's function has its peak; nothing where floors need none.
fn peaks(function: &str, queries: &[Value]) -> Vec<Value> {
    let at = |edit: fn(&mut Value)| {
        let edited = |query: &Value| {
            let mut query = query.clone();
            edit(&mut query);
            query
        };
        answers(find(function).unwrap(), &queries.iter().map(edited).collect::<Vec<_>>(), false)
    };
    match function {
        "azimuthal_tt" => at(|query| query["phi"] = json!(PI)),
        "longitudinal_normaliser" => at(|query| query["theta"] = json!(0.0)),
        "simple_specular" => at(|query| (query["phi"], query["theta_h"]) = (json!(0.0), json!(0.0))),
        "bcsdf" | "bcsdf_cos" => {
            let lobes = at(mirrored);
            // As if R reflected all: F is the difference of numbers near 1 where light comes in straight.
            let mut white = at(|query| {
                mirrored(query);
                query["fiber"]["c_r"] = json!(1.0);
            });
            white.iter_mut().zip(lobes).for_each(|(white, lobes)| white["tt"] = lobes["tt"].clone());
            white
        }
        _ => vec![Value::Null; queries.len()],
    }
}

/// Toward where both lobes are largest.
fn mirrored(query: &mut Value) {
    query["phi"] = json!(PI);
    query["theta_o"] = json!(-query["theta_i"].as_f64().unwrap());
}

fn floor(function: &str, name: &str, query: &Value, peak: &Value) -> f64 {
    let points =
        || -> Vec<Vec<f64>> { query["control_points"].as_array().unwrap().iter().map(numbers).collect() };
    match (function, name) {
        ("curve_point", "derivative") => {
            let points = points();
            let apart = points.iter().flat_map(|a| points.iter().map(move |b| off(&json!(a), &json!(b))));
            apart.fold(1e-30, f64::max)
        }
        ("curve_point" | "fiber_point", _) => points().iter().map(|p| length(p)).fold(1e-30, f64::max),
        ("migration_radius" | "lod_factor" | "fiber_density", _) => FACTOR,
        ("ambient_scattering", _) => SHARE_OF_PEAK * AMBIENT_PEAK,
        _ => (SHARE_OF_PEAK * length(&numbers(&peak[name]))).max(1e-30),
    }
}
