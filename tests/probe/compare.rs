//! How far the device is from f64: |device - f64| / max(|f64|, floor), or of a table's range.

use serde_json::{Value, json};
use std::fmt;
use worsted::precompute::occlusion_table::OCCLUSION_LIMIT;
use worsted::precompute::self_shadow::SELF_SHADOW_LIMIT;
use worsted::precompute::table_error::TableError;
use worsted::probe::function::Shape;
use worsted::probe::{Function, find, parse};
use worsted::stress::measure::{AT_GRAZING, Error, errors};

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

fn formulas(name: &str, queries: &[Value], found: &[Value], exact: &[Value]) -> Figures {
    let function = find(name).unwrap();
    let asked: Vec<Vec<f64>> =
        queries.iter().map(|query| parse(function, &query.to_string()).unwrap()).collect();
    let flat = |answers: &[Value]| -> Vec<Vec<f64>> {
        answers.iter().map(|answer| flat(function, answer)).collect()
    };
    let mut figures = Figures { worst: 0.0, errors: [0.0; 2], table: None, worst_query: String::new() };
    for (index, parts) in errors(function, &asked, &flat(found), &flat(exact)).into_iter().enumerate() {
        for Error { part, error, limit, .. } in parts {
            let worst = &mut figures.errors[usize::from(limit == AT_GRAZING)];
            *worst = worst.max(error);
            // What is no number is worst of all.
            let share = if error.is_nan() { f64::INFINITY } else { error / limit };
            if share > figures.worst {
                figures.worst = share;
                let (query, found, exact) = (&queries[index], &found[index], &exact[index]);
                figures.worst_query = format!("{part} is {error:.1e} off: {query} gave {found}, not {exact}");
            }
        }
    }
    figures
}

/// The numbers of an answer, part by part; a grey colour is three of them.
fn flat(function: &Function, answer: &Value) -> Vec<f64> {
    let part = |(name, shape): &(&str, Shape)| {
        let numbers = numbers(&answer[*name]);
        if numbers.len() < shape.numbers() { vec![numbers[0]; shape.numbers()] } else { numbers }
    };
    function.results.iter().flat_map(part).collect()
}
