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
    /// The paper whose letter `symbol` is; empty where there is none.
    pub paper: &'static str,
    /// Lowest and highest that a slider offers, within what is allowed: what yarns are made of. A spread's is its mean's.
    pub usual: (f64, f64),
    /// Whether a slider's steps are shares of the value.
    pub logarithmic: bool,
    /// What it is, in one line.
    pub about: &'static str,
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

/// Wu & Yuksel 2019, Sec. 3.1.
const WU: &str = "Wu & Yuksel 2019";
/// Zhao et al. 2016.
const ZHAO: &str = "Zhao et al. 2016";

/// Every yarn parameter, in the order of [`super::params::YarnParams`].
pub const PARAMETERS: &[Parameter] = &[
    row("ply_count", "n_ply", "", Allowed::Count(1, 8))
        .of(WU)
        .slide(1.0, 8.0)
        .about("Plies twisted around each other."),
    row("fibers_per_ply", "", "", Allowed::Count(1, 2000))
        .slide_shares(1.0, 400.0)
        .about("Fibers in each ply."),
    row("yarn_radius_mm", "2 R_ply", "mm", Allowed::Number(0.0, FAR))
        .of(WU)
        .slide(0.0, 2.0)
        .about("Twice the distance of a ply's centre from the yarn's: not the yarn's outer radius."),
    row("ply_pitch_mm", "alpha_ply", "mm", Allowed::Pitch(1e-3, 1e9))
        .of(WU)
        .slide_shares(0.5, 50.0)
        .about("Length of yarn over which the plies turn once."),
    row("ply_clockwise", "", "", Allowed::Flag).about("Whether the plies turn clockwise."),
    row("fiber_pitch_mm", "alpha", "mm", Allowed::Pitch(1e-3, 1e9))
        .of(WU)
        .slide_shares(0.2, 50.0)
        .about("Length of yarn over which a fiber turns once inside its ply."),
    row("fiber_clockwise", "", "", Allowed::Flag).about("Whether the fibers turn clockwise."),
    row("ellipse_short_mm", "e_N", "mm", Allowed::Number(1e-6, FAR))
        .of(WU)
        .slide_shares(0.01, 1.0)
        .about("Half-axis of a ply's cross-section toward the yarn's centre."),
    row("ellipse_long_mm", "e_B", "mm", Allowed::Number(1e-6, FAR))
        .of(WU)
        .slide_shares(0.01, 1.0)
        .about("Half-axis of a ply's cross-section around the yarn's centre."),
    row("density_beta", "beta", "", Allowed::Number(0.0, 20.0))
        .of(ZHAO)
        .slide(0.0, 5.0)
        .about("How much denser fibers lie inside a ply than at its surface: the exponent of their density."),
    row("density_epsilon", "epsilon", "", Allowed::Number(0.0, 0.5))
        .of(ZHAO)
        .slide(0.0, 0.5)
        .about("Floor of the fibers' density."),
    row("migration_min", "R_min", "", Allowed::Number(0.0, 1.0))
        .of(WU)
        .slide(0.0, 1.0)
        .about("Smallest share of its radius that a migrating fiber keeps."),
    row("migration_max", "R_max", "", Allowed::Number(0.0, 1.5))
        .of(WU)
        .slide(0.0, 1.5)
        .about("Largest share of its radius that a migrating fiber reaches; at least migration_min."),
    row("migration_rate", "s", "", Allowed::Number(0.0, 100.0))
        .of(WU)
        .slide(0.0, 5.0)
        .about("Migrations in and out for each turn of a fiber."),
    row("fiber_diameter_um", "", "micrometres", Allowed::Number(1e-3, FAR))
        .slide_shares(5.0, 100.0)
        .about("Diameter of one fiber."),
    row("loop_density_per_mm", "", "per mm and ply", Allowed::Number(0.0, 1000.0))
        .slide(0.0, 20.0)
        .about("Loops: fibers pulled out of the ply over one migration."),
    row("loop_radius_mm", "r_1", "mm", Allowed::Spread(0.0, FAR))
        .of(ZHAO)
        .slide(0.0, 1.0)
        .about("Farthest distance of a loop from its ply's centre."),
    row("hair_density_per_mm", "", "per mm and ply", Allowed::Number(0.0, 1000.0))
        .slide(0.0, 40.0)
        .about("Hairs: fibers with an open end."),
    row("hair_length_mm", "z_e", "mm", Allowed::Spread(-FAR, FAR))
        .of(ZHAO)
        .slide(-2.0, 20.0)
        .about("How far a hair runs along the yarn, from where it leaves the ply to its tip."),
    row("hair_radius_start_mm", "r_0", "mm", Allowed::Spread(0.0, FAR))
        .of(ZHAO)
        .slide(0.0, 1.0)
        .about("Distance from the ply's centre at which a hair leaves the ply."),
    row("hair_radius_gain_mm", "r_e", "mm", Allowed::Spread(0.0, FAR))
        .of(ZHAO)
        .slide(0.0, 5.0)
        .about("How much farther out a hair's tip is than its start."),
    row("hair_angle_rad", "p_e", "rad", Allowed::Spread(-1000.0, 1000.0))
        .of(ZHAO)
        .slide(-3.0, 3.0)
        .about("How far a hair turns around its ply from start to tip."),
    row("hair_pitch_mm", "alpha_hair", "mm", Allowed::Pitch(1e-3, 1e9))
        .of(WU)
        .slide_shares(0.5, 50.0)
        .about("Length over which a hair turns once around its ply, in place of hair_angle_rad."),
    row("hair_taper", "", "", Allowed::Number(0.0, 1.0))
        .slide(0.0, 1.0)
        .about("Share of a hair's length over which it thins out to its tip."),
];

const fn row(key: &'static str, symbol: &'static str, unit: &'static str, allowed: Allowed) -> Parameter {
    let (paper, usual, logarithmic, about) = ("", (0.0, 1.0), false, "");
    Parameter { key, symbol, unit, allowed, paper, usual, logarithmic, about }
}

impl Parameter {
    const fn of(self, paper: &'static str) -> Self {
        Self { paper, ..self }
    }

    const fn slide(self, low: f64, high: f64) -> Self {
        Self { usual: (low, high), ..self }
    }

    const fn slide_shares(self, low: f64, high: f64) -> Self {
        Self { usual: (low, high), logarithmic: true, ..self }
    }

    const fn about(self, about: &'static str) -> Self {
        Self { about, ..self }
    }
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
