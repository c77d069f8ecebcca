//! What a field of a query is tried with: the ends of its domain, places near them and far from them, and past them.

use super::queries::Random;
use crate::probe::fields::{Domain, Field, allowed};
use crate::yarn::ranges::Allowed;
use glam::DVec3;
use serde_json::{Value, json};

/// Smallest step from an end of a domain that is tried, as a share of its width.
const LEAST_STEP: f64 = 1e-7;
/// Sizes and distances from the origin at which pieces of yarn are tried.
const SIZES: [f64; 5] = [1e-6, 1e-3, 1.0, 1e3, 1e6];
const AWAY: [f64; 4] = [0.0, 1.0, 1e3, 1e6];

/// Values inside a field's domain, its ends first, then `count` random ones.
pub fn inside(field: &Field, random: &mut Random, count: usize) -> Vec<Value> {
    match field.domain {
        Domain::Number(low, high) => numbers(low, high, random, count),
        Domain::Numbers(length, low, high) => (0..count.max(8))
            .map(|i| {
                let size = if i == 0 { high } else { random.magnitude(1e-6, high) };
                let numbers = random.numbers(length, size).into_iter();
                json!(numbers.map(|v| if low < 0.0 { v } else { v.abs() }).collect::<Vec<_>>())
            })
            .collect(),
        Domain::Points(..) => pieces(),
        Domain::Basis => vec![json!("catmull_rom"), json!("bezier")],
        Domain::Color => {
            let mut colors = vec![json!(0), json!(1), json!([0, 0.5, 1]), json!([1e-6, 1e-3, 1.0 - 1e-7])];
            colors.extend((0..count / 4).map(|_| json!([0.0; 3].map(|_: f64| random.between(0.0, 1.0)))));
            colors
        }
        Domain::Yarn(key) => match allowed(key) {
            Allowed::Count(low, high) => (low..=high).map(|n| json!(n)).collect(),
            Allowed::Pitch(low, high) => {
                let signed = numbers(low, high, random, count).into_iter();
                let turned = |v: Value| json!(random.sign() * v.as_f64().unwrap_or(high));
                [json!(null), json!(-low), json!(0.01), json!(-high)]
                    .into_iter()
                    .chain(signed.map(turned))
                    .collect()
            }
            Allowed::Number(low, high) => numbers(low, high, random, count),
            Allowed::Flag | Allowed::Spread(..) => Vec::new(),
        },
        Domain::IndexBelow(_) => (0..8).map(|n| json!(n)).collect(),
    }
}

/// Both ends, steps away from them and from 0 of all sizes, and places anywhere.
fn numbers(low: f64, high: f64, random: &mut Random, count: usize) -> Vec<Value> {
    let width = high - low;
    let mut values = vec![low, high];
    values.extend((low < 0.0 && high > 0.0).then_some(0.0));
    for i in 0..count {
        let step = random.magnitude(LEAST_STEP * width, width);
        values.push(match i % 4 {
            0 => low + step,
            1 => high - step,
            2 if low > 0.0 => random.magnitude(low, high),
            2 if low < 0.0 => (random.sign() * random.magnitude(LEAST_STEP * high, high)).max(low),
            _ => random.between(low, high),
        });
    }
    values.into_iter().map(|v| json!(v.clamp(low, high))).collect()
}

/// Values that a field must refuse: just past either end, far past it, and of other types.
pub fn outside(field: &Field) -> Vec<Value> {
    let past = |low: f64, high: f64| {
        let step = |end: f64| 1e-3 * (1.0 + end.abs());
        [low - step(low), high + step(high), -1e300, 1e300]
    };
    let mut values: Vec<Value> = match field.domain {
        Domain::Number(low, high) => past(low, high).map(|v| json!(v)).into(),
        Domain::Numbers(count, low, high) => past(low, high).map(|v| json!(vec![v; count])).into(),
        Domain::Points(low, high) => past(low, high).map(|v| json!(vec![vec![v; 3]; 4])).into(),
        Domain::Basis => vec![json!("b_spline"), json!(2)],
        Domain::Color => past(0.0, 1.0).map(|v| json!(v)).into_iter().chain([json!([0, 2, 0])]).collect(),
        Domain::Yarn(key) => match allowed(key) {
            Allowed::Count(low, high) => {
                vec![json!(f64::from(low) - 1.0), json!(high + 1), json!(f64::from(low) + 0.5), json!(1e300)]
            }
            Allowed::Pitch(low, high) => {
                vec![json!(0), json!(0.5 * low), json!(-0.5 * low), json!(1.01 * high)]
            }
            Allowed::Number(low, high) => past(low, high).map(|v| json!(v)).into(),
            Allowed::Flag | Allowed::Spread(..) => Vec::new(),
        },
        Domain::IndexBelow(_) => vec![json!(-1), json!(8), json!(0.5)],
    };
    values.extend([json!("x"), json!({}), json!(true)]);
    values
}

/// Four control points each of what centre lines do at their worst, of every size and at every distance.
fn pieces() -> Vec<Value> {
    let mut all = Vec::new();
    for shape in shapes() {
        for size in SIZES {
            for away in AWAY {
                let place = |p: DVec3| (size * p + away * DVec3::new(1.0, -0.7, 0.4)).to_array();
                all.push(json!(shape.map(place)));
            }
        }
    }
    all
}

/// Shapes of size 1: straight, uneven, with repeated points, doubling back, with a cusp, in one point.
pub fn shapes() -> [[DVec3; 4]; 12] {
    let v = DVec3::new;
    let (o, x, y) = (DVec3::ZERO, DVec3::X, DVec3::Y);
    [
        [o, v(1.0 / 3.0, 0.0, 0.0), v(2.0 / 3.0, 0.0, 0.0), x],
        [o, 1e-3 * x, 0.9 * x, x],
        [o; 4],
        [o, o, x, v(1.0, 1.0, 0.0)],
        [o, x, x, v(1.0, 1.0, 0.0)],
        [o, x, v(1.0, 1.0, 0.0), v(1.0, 1.0, 0.0)],
        [o, x, o, x],
        [o, x, x, o],
        [o, v(1.0, 1.0, 0.0), y, x],
        [o, v(1.0, 1e-3, 0.0), v(1.0, 2e-3, 0.0), v(0.0, 3e-3, 0.0)],
        [o, x, v(1.0, 1.0, 0.0), v(0.3, 0.5, 1.0)],
        [o, v(0.7, 0.6, -0.3), v(-0.2, 0.8, 0.9), v(0.5, -0.4, 0.6)],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::{FUNCTIONS, parse};
    use crate::stress::queries;

    #[test]
    fn values_inside_are_taken_and_those_outside_are_refused() {
        for function in FUNCTIONS {
            let good = queries::random(function.name, 1).remove(0);
            for field in function.fields {
                let mut random = Random::new(&[1]);
                for (values, may_pass) in [(inside(field, &mut random, 20), true), (outside(field), false)] {
                    assert!(!values.is_empty());
                    for value in values {
                        let mut query = good.clone();
                        crate::stress::sweep::set(&mut query, field.path, value);
                        let answer = parse(function, &query.to_string());
                        // Fields that do not go together are refused by what they are together.
                        let single = answer.as_ref().is_err_and(|e| {
                            e.starts_with(&format!("{} = ", field.path))
                                && e.ends_with(&field.domain.to_string())
                        });
                        let together = answer.is_err() && !single;
                        assert!(
                            if may_pass { answer.is_ok() || together } else { single },
                            "{query}: {answer:?}"
                        );
                    }
                }
            }
        }
    }
}
