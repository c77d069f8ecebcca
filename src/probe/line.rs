//! One line of JSON to numbers, and back.

use super::fields::{Domain, Values};
use super::function::{Function, Shape};
use serde_json::{Map, Value, json};

/// The numbers of a query's line, rounded to f32, in the order of the function's fields.
///
/// # Errors
/// What is wrong with it, in one line.
pub fn parse(function: &Function, line: &str) -> Result<Vec<f64>, String> {
    let query: Value = serde_json::from_str(line).map_err(|error| format!("not JSON: {error}"))?;
    if !query.is_object() {
        return Err("expected an object".into());
    }
    let mut values = Vec::new();
    for field in function.fields {
        field.read(&query, &mut values)?;
    }
    (function.check)(Values::new(&values))?;
    Ok(values)
}

/// The line that answers a query, whose numbers are `query`.
///
/// # Errors
/// Numbers that are none.
pub fn answer(function: &Function, query: &[f64], numbers: &[f64]) -> Result<Value, String> {
    let grey = all_grey(function, query);
    let mut rest = numbers;
    let mut object = Map::new();
    for (name, shape) in function.results {
        let (part, after) = rest.split_at_checked(shape.numbers()).unwrap_or((&[], &[]));
        rest = after;
        if part.is_empty() || part.iter().any(|number| !number.is_finite()) {
            return Err(format!("{name} came out as {part:?}"));
        }
        let single = *shape == Shape::Number || (*shape == Shape::Color && grey);
        object.insert((*name).to_owned(), if single { json!(part[0]) } else { json!(part) });
    }
    Ok(Value::Object(object))
}

/// What stands in an answer's place.
pub fn error(line: u64, message: &str) -> Value {
    json!({ "error": format!("line {line}: {message}") })
}

/// Whether every color of a query was a single number.
fn all_grey(function: &Function, query: &[f64]) -> bool {
    let mut values = Values::new(query);
    function.fields.iter().all(|field| {
        let count = field.domain.numbers();
        let last = (0..count).map(|_| values.real()).last();
        !matches!(field.domain, Domain::Color) || last == Some(1.0)
    })
}
