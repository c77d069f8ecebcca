//! Whether the values of a scene are what its parameters may be.

use super::{Kind, Parameter, of_table};
use crate::scene::keys::KeyError;
use toml::{Table, Value};

/// Shortest vector that still has a direction.
const SHORTEST: f64 = 1e-9;

/// Checks the values of one table of a scene, whose types are right, against the ranges of its parameters; errors
/// name keys at `path`. Tables in it, and keys that are no parameter, are left alone.
///
/// # Errors
/// The first value, in the parameters' order, that is out of its range.
pub fn check_table(table: &'static str, path: &str, values: &Table) -> Result<(), KeyError> {
    of_table(table).try_for_each(|parameter| match values.get(parameter.key) {
        None => Ok(()),
        Some(value) => check_value(parameter, &format!("{path}.{}", parameter.key), value),
    })
}

/// Checks one value, whose type is right, against the range of its parameter; errors name it `path`.
///
/// # Errors
/// What was found and what is allowed.
pub fn check_value(parameter: &Parameter, path: &str, value: &Value) -> Result<(), KeyError> {
    let vector = || <[f64; 3]>::try_from(numbers(value).as_slice()).ok();
    match parameter.kind {
        Kind::Number(low, high) | Kind::Pitch(low, high) => in_range(path, value, low, high),
        Kind::Count(low, high) => in_range(path, value, low as f64, high as f64),
        Kind::PowerOfTwo(low, high) => power_of_two(path, value, low, high),
        Kind::Vector(low, high) => {
            numbers(value).into_iter().try_for_each(|c| KeyError::range(path, c, low, high))
        }
        Kind::Rgb(most) => vector().map_or(Ok(()), |rgb| KeyError::rgb(path, rgb, most)),
        Kind::Direction => vector().map_or(Ok(()), |direction| points_somewhere(path, direction)),
        Kind::Spread(low, high) => match numbers(value)[..] {
            [mean, deviation] => {
                KeyError::range(path, mean, low, high)?;
                KeyError::range(path, deviation, 0.0, high)
            }
            _ => Ok(()),
        },
        Kind::Switch | Kind::Name(_) | Kind::Preset(_) | Kind::File => Ok(()),
    }
}

fn in_range(path: &str, value: &Value, low: f64, high: f64) -> Result<(), KeyError> {
    number(value).map_or(Ok(()), |value| KeyError::range(path, value, low, high))
}

fn power_of_two(path: &str, value: &Value, low: u64, high: u64) -> Result<(), KeyError> {
    let Some(found) = value.as_integer() else { return Ok(()) };
    let good = u64::try_from(found).is_ok_and(|n| (low..=high).contains(&n) && n.is_power_of_two());
    let message = || format!(" = {found}: allowed is a power of two from {low} to {high}");
    if good { Ok(()) } else { Err(KeyError::new(path, message())) }
}

fn points_somewhere(path: &str, direction: [f64; 3]) -> Result<(), KeyError> {
    let length = direction.iter().map(|c| c * c).sum::<f64>().sqrt();
    // Written so that what is no number is refused.
    if direction.iter().all(|c| c.is_finite()) && length >= SHORTEST {
        return Ok(());
    }
    Err(KeyError::new(path, format!(" = {direction:?}: allowed is any vector but 0")))
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|whole| whole as f64))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().filter_map(number).collect()
}
