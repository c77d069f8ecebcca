//! What every yarn parameter may be: the one table that errors and listings print.

use std::fmt;
use toml::Value;

/// One key of a yarn table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// The key in scene and preset files.
    pub key: &'static str,
    /// What the papers call it; empty where they have no letter for it.
    pub symbol: &'static str,
    /// What it is measured in; empty for counts, shares and flags.
    pub unit: &'static str,
    /// What it may be.
    pub allowed: Allowed,
}

/// What a parameter may be; bounds belong to the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    /// True or false.
    Flag,
    /// A whole number.
    Count(u32, u32),
    /// A number.
    Number(f64, f64),
    /// A number, or `"untwisted"` (absent in [`super::params::YarnParams`]).
    Pitch(f64, f64),
    /// `[mean, deviation]`: the mean within these bounds, the deviation from 0 to the upper one.
    Spread(f64, f64),
}

/// A parameter that is of the wrong type or outside its range, as one line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("yarn.{key} = {found}: {rule}")]
pub struct ParamError {
    /// The parameter's key in a scene or preset file.
    pub key: &'static str,
    /// What was given, as it would stand in a file.
    pub found: String,
    /// What is allowed, in words.
    pub rule: String,
}

/// Largest length, radius or deviation in mm: a kilometre.
const FAR: f64 = 1e6;

/// Every yarn parameter, in the order of [`super::params::YarnParams`].
pub const PARAMETERS: &[Parameter] = &[
    row("ply_count", "n_ply", "", Allowed::Count(1, 8)),
    row("fibers_per_ply", "", "", Allowed::Count(1, 2000)),
    row("yarn_radius_mm", "", "mm", Allowed::Number(0.0, FAR)),
    row("ply_pitch_mm", "alpha_ply", "mm", Allowed::Pitch(1e-3, 1e9)),
    row("ply_clockwise", "", "", Allowed::Flag),
    row("fiber_pitch_mm", "alpha", "mm", Allowed::Pitch(1e-3, 1e9)),
    row("fiber_clockwise", "", "", Allowed::Flag),
    row("ellipse_short_mm", "e_N", "mm", Allowed::Number(1e-6, FAR)),
    row("ellipse_long_mm", "e_B", "mm", Allowed::Number(1e-6, FAR)),
    row("density_beta", "beta", "", Allowed::Number(0.0, 20.0)),
    row("density_epsilon", "epsilon", "", Allowed::Number(0.0, 0.5)),
    row("migration_min", "R_min", "", Allowed::Number(0.0, 1.0)),
    row("migration_max", "R_max", "", Allowed::Number(0.0, 1.5)),
    row("migration_rate", "s", "", Allowed::Number(0.0, 100.0)),
    row("fiber_diameter_um", "", "micrometres", Allowed::Number(1e-3, FAR)),
    row("loop_density_per_mm", "", "per mm and ply", Allowed::Number(0.0, 1000.0)),
    row("loop_radius_mm", "r_1", "mm", Allowed::Spread(0.0, FAR)),
    row("hair_density_per_mm", "", "per mm and ply", Allowed::Number(0.0, 1000.0)),
    row("hair_length_mm", "z_e", "mm", Allowed::Spread(-FAR, FAR)),
    row("hair_radius_start_mm", "r_0", "mm", Allowed::Spread(0.0, FAR)),
    row("hair_radius_gain_mm", "r_e", "mm", Allowed::Spread(0.0, FAR)),
    row("hair_angle_rad", "p_e", "rad", Allowed::Spread(-1000.0, 1000.0)),
    row("hair_pitch_mm", "alpha_hair", "mm", Allowed::Pitch(1e-3, 1e9)),
    row("hair_taper", "", "", Allowed::Number(0.0, 1.0)),
];

const fn row(key: &'static str, symbol: &'static str, unit: &'static str, allowed: Allowed) -> Parameter {
    Parameter { key, symbol, unit, allowed }
}

/// The parameter of that key, or `None`.
pub fn find(key: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.key == key)
}

impl Parameter {
    /// What is allowed, in words: `0 to 1000000 mm`.
    pub fn range(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        format!("{}{unit}", self.allowed)
    }

    /// Checks the type and the range of a value of this key. A whole number is a number.
    ///
    /// # Errors
    /// The key with what was found and what is allowed.
    pub fn check(&self, value: &Value) -> Result<(), ParamError> {
        let rule = match judge(self.allowed, value) {
            Verdict::Good => return Ok(()),
            Verdict::OutOfRange => format!("allowed is {}", self.range()),
            Verdict::WrongType(expected) => format!("expected {expected}, allowed is {}", self.range()),
        };
        Err(ParamError { key: self.key, found: shown(value), rule })
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag => f.write_str("true or false"),
            Self::Count(low, high) => write!(f, "{low} to {high}"),
            Self::Number(low, high) => write!(f, "{low} to {high}"),
            Self::Pitch(low, high) => write!(f, "\"untwisted\" or {low} to {high}"),
            Self::Spread(low, high) => write!(f, "a mean of {low} to {high} and a deviation of 0 to {high}"),
        }
    }
}

enum Verdict {
    Good,
    OutOfRange,
    WrongType(&'static str),
}

fn judge(allowed: Allowed, value: &Value) -> Verdict {
    let within = |number: f64, low: f64, high: f64| {
        if (low..=high).contains(&number) { Verdict::Good } else { Verdict::OutOfRange }
    };
    match (allowed, value) {
        (Allowed::Flag, Value::Boolean(_)) => Verdict::Good,
        (Allowed::Flag, _) => Verdict::WrongType("a flag"),
        (Allowed::Count(low, high), Value::Integer(n)) => {
            if (i64::from(low)..=i64::from(high)).contains(n) {
                Verdict::Good
            } else {
                Verdict::OutOfRange
            }
        }
        (Allowed::Count(..), _) => Verdict::WrongType("a whole number"),
        (Allowed::Pitch(..), Value::String(text)) if text == "untwisted" => Verdict::Good,
        (Allowed::Number(low, high) | Allowed::Pitch(low, high), value) => match number(value) {
            Some(found) => within(found, low, high),
            None => Verdict::WrongType("a number"),
        },
        (Allowed::Spread(low, high), value) => match value.as_array().map(Vec::as_slice) {
            Some([mean, deviation]) => match (number(mean), number(deviation)) {
                (Some(mean), Some(deviation)) => match within(mean, low, high) {
                    Verdict::Good => within(deviation, 0.0, high),
                    other => other,
                },
                _ => Verdict::WrongType("[mean, deviation]"),
            },
            _ => Verdict::WrongType("[mean, deviation]"),
        },
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|whole| whole as f64))
}

/// A value on one line as it would stand in a file; what cannot be is named only.
pub fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => format!("{text:?}"),
        Value::Integer(whole) => whole.to_string(),
        Value::Float(number) => number.to_string(),
        Value::Boolean(flag) => flag.to_string(),
        Value::Array(items) if items.len() <= 4 => {
            format!("[{}]", items.iter().map(shown).collect::<Vec<_>>().join(", "))
        }
        other => format!("({})", other.type_str()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::params::YarnParams;
    use crate::yarn::presets;
    use toml::Table;

    #[test]
    fn the_table_lists_exactly_the_parameters() {
        let full = YarnParams { hair_pitch_mm: Some(2.0), ..presets::yarn("worsted_3ply").unwrap() };
        let table = Table::try_from(&full).unwrap();
        let mut keys: Vec<_> = PARAMETERS.iter().map(|p| p.key).collect();
        keys.sort_unstable();
        assert_eq!(keys, table.keys().map(String::as_str).collect::<Vec<_>>());
    }

    #[test]
    fn types_and_ranges_are_told_apart() {
        let says = |text: &str| {
            let table: Table = toml::from_str(text).unwrap();
            let (key, value) = table.iter().next().unwrap();
            match find(key).unwrap().check(value) {
                Ok(()) => "good".to_owned(),
                Err(error) => error.to_string(),
            }
        };
        for good in
            ["ply_count = 8", "yarn_radius_mm = 1", "ply_pitch_mm = 'untwisted'", "hair_angle_rad = [-1, 0]"]
        {
            assert_eq!(says(good), "good", "{good}");
        }
        for (text, expected) in [
            ("ply_count = 9", "yarn.ply_count = 9: allowed is 1 to 8"),
            ("ply_count = -1", "yarn.ply_count = -1: allowed is 1 to 8"),
            ("ply_count = 2.5", "yarn.ply_count = 2.5: expected a whole number, allowed is 1 to 8"),
            ("ply_clockwise = 1", "yarn.ply_clockwise = 1: expected a flag, allowed is true or false"),
            ("density_beta = nan", "yarn.density_beta = NaN: allowed is 0 to 20"),
            (
                "yarn_radius_mm = 'wide'",
                "yarn.yarn_radius_mm = \"wide\": expected a number, allowed is 0 to 1000000 mm",
            ),
            (
                "ply_pitch_mm = 'none'",
                "yarn.ply_pitch_mm = \"none\": expected a number, allowed is \"untwisted\" or 0.001 to 1000000000 mm",
            ),
            ("ply_pitch_mm = 0", "yarn.ply_pitch_mm = 0: allowed is \"untwisted\" or 0.001 to 1000000000 mm"),
            ("hair_taper = {a = 1}", "yarn.hair_taper = (table): expected a number, allowed is 0 to 1"),
            (
                "loop_radius_mm = [1, -1]",
                "yarn.loop_radius_mm = [1, -1]: allowed is a mean of 0 to 1000000 and a deviation of 0 to 1000000 mm",
            ),
            (
                "loop_radius_mm = 1",
                "yarn.loop_radius_mm = 1: expected [mean, deviation], \
                 allowed is a mean of 0 to 1000000 and a deviation of 0 to 1000000 mm",
            ),
        ] {
            assert_eq!(says(text), expected);
        }
        let error = find("density_beta").unwrap().check(&Value::String("a\nb".into())).unwrap_err();
        assert!(!error.to_string().contains('\n'));
        for wrong in ["hair_length_mm = [1]", "hair_length_mm = [1, 2, 3]", "hair_length_mm = ['a', 1]"] {
            assert!(says(wrong).contains("expected [mean, deviation]"), "{wrong}");
        }
    }
}
