//! Every parameter of a probed function, alone and in random pairs, to the ends of its domain and past them.

use super::inputs::{inside, outside};
use super::measure::{self, errors};
use super::order::{Order, orders};
use super::queries::{self, Random};
use super::verdict::{Collector, Row};
use crate::probe::fields::{Domain, Field, Values};
use crate::probe::{Function, Kernel, parse};
use crate::vulkan::VulkanError;
use rayon::prelude::*;
use serde_json::Value;

/// Queries evaluated at once.
const BATCH: usize = 8192;

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Random surroundings in which a parameter is swept.
    pub surroundings: usize,
    /// Random values of a parameter beside its ends.
    pub values: usize,
    /// Random pairs of parameters for each function.
    pub pairs: usize,
}

impl Effort {
    /// The same with so many times fewer pairs and values.
    pub fn less(self, times: usize) -> Self {
        let at_least = |n: usize, low: usize| (n / times).max(low);
        Self {
            surroundings: at_least(self.surroundings, 2),
            values: at_least(self.values, 4),
            pairs: at_least(self.pairs, 100),
        }
    }
}

/// Puts a value at a field's path, where the query has its parent.
pub fn set(query: &mut Value, path: &str, value: Value) {
    let mut place = query;
    for key in path.split('.') {
        place = &mut place[key];
    }
    *place = value;
}

/// Queries that were evaluated.
struct Evaluated {
    queries: Vec<Value>,
    found: Vec<Vec<f64>>,
    exact: Vec<Vec<f64>>,
    errors: Vec<Vec<measure::Error>>,
    /// For each query that was asked, its place among those evaluated; `None` where it was refused.
    place: Vec<Option<usize>>,
    /// Queries that were refused, with why.
    refused: Vec<(Value, String)>,
}

/// A function on a device.
struct Tried {
    function: &'static Function,
    kernel: Kernel,
}

impl Tried {
    fn evaluate(&mut self, asked: Vec<Value>) -> Result<Evaluated, VulkanError> {
        let parsed: Vec<_> = asked.par_iter().map(|q| parse(self.function, &q.to_string())).collect();
        let (mut queries, mut numbers, mut place, mut refused) = (vec![], vec![], vec![], vec![]);
        for (query, parsed) in asked.into_iter().zip(parsed) {
            match parsed {
                Ok(values) => {
                    place.push(Some(queries.len()));
                    queries.push(query);
                    numbers.push(values);
                }
                Err(why) => {
                    place.push(None);
                    refused.push((query, why));
                }
            }
        }
        let slices: Vec<&[f64]> = numbers.iter().map(Vec::as_slice).collect();
        let mut found = Vec::with_capacity(slices.len());
        for batch in slices.chunks(BATCH) {
            found.extend(self.kernel.numbers(batch)?);
        }
        let exact: Vec<Vec<f64>> =
            slices.par_iter().map(|query| (self.function.exact)(Values::new(query))).collect();
        let errors = errors(self.function, &numbers, &found, &exact);
        Ok(Evaluated { queries, found, exact, errors, place, refused })
    }
}

/// Counts errors and wrong numbers of all that was evaluated.
fn collect(c: &mut Collector, function: &Function, all: &Evaluated) {
    let signed = matches!(function.name, "curve_point" | "fiber_point");
    c.points(all.queries.len() as u64);
    for (i, query) in all.queries.iter().enumerate() {
        c.numbers(&all.found[i], signed, || query.to_string());
        for e in &all.errors[i] {
            c.error(e.error, e.limit, || query.to_string());
        }
    }
    for (query, why) in &all.refused {
        // Each field is in its own domain: what is refused is what they are together.
        let named = function.fields.iter().find(|field| why.contains(last(field.path)));
        c.refusal(Some(why), named.map_or("\n", |field| last(field.path)), || query.to_string());
    }
}

fn last(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// Whether the device's answer changes from one query to the next by more than f64's does and an error may be.
fn jumps(all: &Evaluated, from: usize, to: usize) -> bool {
    let mut start = 0;
    all.errors[from].iter().zip(&all.errors[to]).any(|(a, b)| {
        let count = all.found[from].len() / all.errors[from].len();
        let range = start..start + count;
        start = range.end;
        let change =
            |k: usize| (all.found[to][k] - all.found[from][k]) - (all.exact[to][k] - all.exact[from][k]);
        let apart = range.map(|k| change(k).powi(2)).sum::<f64>().sqrt();
        apart > a.limit.max(b.limit) * a.scale.max(b.scale)
    })
}

/// The next number of the same kind that f32 has.
fn next(value: &Value, domain: Domain) -> Option<Value> {
    let up = |v: &Value| v.as_f64().map(|v| f64::from((v as f32).next_up()));
    match domain {
        Domain::Number(_, high) => up(value).filter(|v| *v <= high).map(Value::from),
        Domain::Yarn(key) => match crate::probe::fields::allowed(key) {
            crate::yarn::ranges::Allowed::Number(_, high) => {
                up(value).filter(|v| *v <= high).map(Value::from)
            }
            _ => None,
        },
        _ => None,
    }
}

/// One parameter, all others as they usually are.
fn alone(tried: &mut Tried, group: &'static str, field: &Field, effort: Effort) -> Result<Row, VulkanError> {
    let function = tried.function;
    let mut random = Random::new(&[field.path.len() as u64, effort.values as u64]);
    let bases = queries::random(function.name, effort.surroundings);
    let mut asked = Vec::new();
    let mut neighbours = Vec::new();
    for base in &bases {
        for value in inside(field, &mut random, effort.values) {
            let with = |value: Value| {
                let mut query = base.clone();
                set(&mut query, field.path, value);
                query
            };
            if let Some(next) = next(&value, field.domain) {
                neighbours.push((asked.len(), asked.len() + 1));
                asked.extend([with(value), with(next)]);
            } else {
                asked.push(with(value));
            }
        }
    }
    let all = tried.evaluate(asked)?;
    let mut c = Collector::default();
    collect(&mut c, function, &all);
    for (from, to) in neighbours {
        if let (Some(from), Some(to)) = (all.place[from], all.place[to])
            && jumps(&all, from, to)
        {
            c.jump(|| format!("{} and its neighbour", all.queries[from]));
        }
    }
    for order in orders(function.name, field.path) {
        in_order(tried, &mut c, field, &bases, order, effort)?;
    }
    past(&mut c, function, field, &bases[0]);
    Ok(c.row(group, function.name, field.path, &field.domain.to_string()))
}

/// Counts places where a result moves the wrong way as the parameter grows.
fn in_order(
    tried: &mut Tried,
    c: &mut Collector,
    field: &Field,
    bases: &[Value],
    order: &Order,
    effort: Effort,
) -> Result<(), VulkanError> {
    let steps = 8 * effort.values;
    for base in bases {
        let [low, high] = (order.range)(base);
        let query = |i: usize| {
            let mut query = base.clone();
            set(&mut query, field.path, Value::from(low + (high - low) * (i as f64 / steps as f64)));
            query
        };
        let all = tried.evaluate((0..=steps).map(query).collect())?;
        let value = |i: usize| all.found[i].iter().sum::<f64>();
        let most = (0..all.found.len()).map(value).fold(0.0, f64::max);
        c.points(all.queries.len() as u64);
        for i in 1..all.found.len() {
            let rise = (value(i) - value(i - 1)) * if order.rising { 1.0 } else { -1.0 };
            if rise < -order.slack * most {
                c.reversal(|| format!("{} and the next", all.queries[i - 1]));
            }
        }
    }
    Ok(())
}

/// Values past the ends must give an error that names the field.
fn past(c: &mut Collector, function: &Function, field: &Field, base: &Value) {
    for value in outside(field) {
        let mut query = base.clone();
        set(&mut query, field.path, value);
        let answer = parse(function, &query.to_string());
        c.refusal(answer.err().as_deref(), field.path, || query.to_string());
    }
}

/// Random pairs of parameters, each anywhere in its domain.
fn pairs(tried: &mut Tried, group: &'static str, effort: Effort) -> Result<Row, VulkanError> {
    let function = tried.function;
    let mut random = Random::new(&[function.name.len() as u64, effort.pairs as u64, 2]);
    let values: Vec<Vec<Value>> =
        function.fields.iter().map(|field| inside(field, &mut random, 8 * effort.values)).collect();
    let bases = queries::random(function.name, effort.pairs);
    let asked = bases.into_iter().map(|mut query| {
        for _ in 0..2 {
            let which = random.below(function.fields.len() as u32) as usize;
            let value = values[which][random.below(values[which].len() as u32) as usize].clone();
            set(&mut query, function.fields[which].path, value);
        }
        query
    });
    let all = tried.evaluate(asked.collect())?;
    let mut c = Collector::default();
    collect(&mut c, function, &all);
    Ok(c.row(group, function.name, "random pairs", "each parameter's own"))
}

/// All rows of one function, whose kernel is given.
///
/// # Errors
/// Those of the device.
pub fn sweep(
    kernel: Kernel,
    function: &'static Function,
    group: &'static str,
    effort: Effort,
) -> Result<Vec<Row>, VulkanError> {
    let mut tried = Tried { function, kernel };
    let mut rows = Vec::new();
    for field in function.fields {
        rows.push(alone(&mut tried, group, field, effort)?);
    }
    rows.push(pairs(&mut tried, group, effort)?);
    Ok(rows)
}
