//! Values to start from where a key is absent.

use super::Document;
use crate::scene::fiber_table::resolve_fiber;
use crate::scene::parameters::{Group, Kind, Parameter, find};
use crate::viewer::lights::to_digits;
use toml::{Table, Value};

/// Digits of what is worked out.
const DIGITS: usize = 4;

impl Document {
    /// A value to start from where a key is absent: what it came to where that is known, or the middle of what is usual.
    pub fn start_value(&self, path: &str) -> Option<Value> {
        let row = find(path)?;
        let noted = self.automatic.get(path).cloned();
        let fiber = (row.group == Group::Fiber).then(|| self.fiber_start(path, row)).flatten();
        noted.or(fiber).or_else(|| Some(plain_start(row)))
    }

    fn fiber_start(&self, path: &str, row: &Parameter) -> Option<Value> {
        let own = path.strip_prefix("fabric.").and_then(|rest| rest.split('.').next()?.parse::<usize>().ok());
        let none = Table::new();
        let fabric =
            own.and_then(|index| self.good.file.fabric.get(index)).map_or(&none, |fabric| &fabric.fiber);
        let fiber = resolve_fiber(&self.good.file.fiber, fabric).ok()?;
        let rounded = |rgb: [f64; 3]| Value::from(rgb.map(|c| to_digits(c, DIGITS)).to_vec());
        match row.key {
            "diffuse" | "color" => Some(rounded(fiber.diffuse())),
            "specular" => Some(rounded(fiber.specular())),
            "specular_width_deg" => Some(to_digits(fiber.specular_width().to_degrees(), DIGITS).into()),
            _ => None,
        }
    }
}

fn plain_start(row: &Parameter) -> Value {
    let (low, high) = row.usual;
    let middle = if row.logarithmic { (low.max(1e-3) * high).sqrt() } else { 0.5 * (low + high) };
    let middle = to_digits(middle, 2);
    match row.kind {
        Kind::Switch => Value::Boolean(false),
        Kind::Count(..) => Value::Integer(middle as i64),
        Kind::PowerOfTwo(..) => Value::Integer(1 << (middle.log2().round() as u32)),
        Kind::Name(names) => Value::String(names[0].to_owned()),
        Kind::Preset(_) | Kind::File => Value::String(String::new()),
        Kind::Rgb(_) => Value::from(vec![0.5; 3]),
        Kind::Vector(..) => Value::from(vec![middle; 3]),
        Kind::Direction => Value::from(vec![0.0, -1.0, 0.0]),
        Kind::Spread(..) => Value::from(vec![middle, 0.0]),
        Kind::Number(..) | Kind::Pitch(..) => Value::Float(middle),
    }
}
