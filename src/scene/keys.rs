//! Errors about a key of a scene: its path, its line, what it may have been meant to be.

use std::fmt;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Least likeness (Jaro-Winkler, 0 to 1) of a name that is suggested.
const LEAST_LIKENESS: f64 = 0.8;

/// What is wrong with one key of a scene, as one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyError {
    /// Dotted path of the key; empty where it is not known.
    pub path: String,
    /// What follows the key in the message: what was found and what is expected.
    pub message: String,
}

impl KeyError {
    /// `path = found: allowed is low to high`, or nothing if `value` lies between.
    ///
    /// # Errors
    /// Values outside, NaN among them.
    pub fn range(path: &str, value: f64, low: f64, high: f64) -> Result<(), Self> {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        Err(Self::new(path, format!(" = {value}: allowed is {low} to {high}")))
    }

    /// The same for linear RGB of 0 to `most` each.
    ///
    /// # Errors
    /// Values outside, NaN among them.
    pub fn rgb(path: &str, rgb: [f64; 3], most: f64) -> Result<(), Self> {
        if rgb.iter().all(|c| (0.0..=most).contains(c)) {
            return Ok(());
        }
        Err(Self::new(path, format!(" = {rgb:?}: allowed is 0 to {most} each")))
    }

    /// An error about the key at `path`.
    pub fn new(path: &str, message: String) -> Self {
        Self { path: path.to_owned(), message }
    }

    /// What serde says of a scene's types and keys, with the key's path where it is known and the
    /// nearest known name.
    pub fn from_toml(error: &toml::de::Error) -> Self {
        let mut message = error.message().lines().next().unwrap_or("not valid TOML").to_owned();
        if let Some(near) = nearest_quoted(&message) {
            message.push_str(&format!("; did you mean `{near}`?"));
        }
        // A value that was not read from text has no line; its path stands below the message instead.
        let text = error.to_string();
        let path = text.lines().rev().find_map(|line| line.strip_prefix("in `")?.strip_suffix('`'));
        match path {
            Some(path) => Self::new(path, format!(": {message}")),
            None => Self::new("", message),
        }
    }

    /// The line of the scene file on which the key stands, or nearest to it: the first of `paths` that
    /// the text has, counted from 1.
    pub fn line(text: &str, paths: &[String]) -> Option<u64> {
        let table = DeTable::parse(text).ok()?;
        let start = paths.iter().find_map(|path| {
            let steps: Vec<&str> = path.split('.').collect();
            key_start(table.get_ref(), &steps)
        })?;
        Some(line_at(text, start))
    }
}

impl fmt::Display for KeyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.path, self.message)
    }
}

/// The line, counted from 1, of the byte at `offset`.
pub fn line_at(text: &str, offset: usize) -> u64 {
    let before = &text.as_bytes()[..offset.min(text.len())];
    1 + before.iter().filter(|&&b| b == b'\n').count() as u64
}

/// Byte at which the key at the end of `steps` starts. A number names an element of an array of tables;
/// without one, the first element that has the key is taken.
fn key_start(table: &DeTable<'_>, steps: &[&str]) -> Option<usize> {
    let (first, rest) = steps.split_first()?;
    let (key, value) = table.iter().find(|(key, _)| key.get_ref() == *first)?;
    if rest.is_empty() { Some(key.span().start) } else { start_inside(value, rest) }
}

fn start_inside(value: &Spanned<DeValue<'_>>, steps: &[&str]) -> Option<usize> {
    match value.get_ref() {
        DeValue::Table(table) => key_start(table, steps),
        DeValue::Array(items) => match steps.split_first()? {
            (index, rest) if index.parse::<usize>().is_ok() => {
                let item = items.get(index.parse::<usize>().ok()?)?;
                if rest.is_empty() { Some(item.span().start) } else { start_inside(item, rest) }
            }
            _ => items.iter().find_map(|item| start_inside(item, steps)),
        },
        _ => None,
    }
}

/// Of the names that serde lists after an unknown one, the nearest.
fn nearest_quoted(message: &str) -> Option<String> {
    if !message.starts_with("unknown field") && !message.starts_with("unknown variant") {
        return None;
    }
    let mut quoted = message.split('`').skip(1).step_by(2);
    let given = quoted.next()?;
    nearest(given, quoted).map(str::to_owned)
}

/// What follows an unknown name: the one that was probably meant, if any.
pub fn suggestion(near: Option<&str>) -> String {
    near.map_or(String::new(), |near| format!("; did you mean `{near}`?"))
}

/// The known name that `given` was probably meant to be: one that holds it, or one spelled nearly so.
pub fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let given = given.to_lowercase();
    let likeness = |name: &str| {
        let alike = strsim::jaro_winkler(&given, name);
        if given.len() >= 4 && name.contains(&given) { alike.max(0.95) } else { alike }
    };
    let scored = known.into_iter().map(|name| (likeness(name), name));
    let best = scored.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 >= LEAST_LIKENESS).then_some(best.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_what_is_near_and_nothing_else() {
        let known = ["ply_count", "ply_pitch_mm", "fibers_per_ply", "density_beta", "worsted_3ply"];
        for (given, expected) in [
            ("ply_cuont", Some("ply_count")),
            ("plycount", Some("ply_count")),
            ("Ply_Count", Some("ply_count")),
            ("fiber_per_plie", Some("fibers_per_ply")),
            ("beta", Some("density_beta")),
            ("worsted", Some("worsted_3ply")),
            ("pitch_mm", Some("ply_pitch_mm")),
            ("cashmere", None),
            ("x", None),
            ("", None),
        ] {
            assert_eq!(nearest(given, known), expected, "{given}");
        }
        assert_eq!(nearest("anything", []), None);
    }

    #[test]
    fn finds_the_line_of_a_key_however_it_is_written() {
        let text = "seed = 1\n[yarn]\npreset = 'a'\n  ply_count = 3\n\n[[fabric]]\nmodel = 'x'\n[fabric.yarn]\n\
                    ply_count = 2\n[[fabric]]\nyarn.ply_count = 1\nyarn.hair_taper = 2\n[[light]]\n";
        let line = |path: &str| KeyError::line(text, &[path.to_owned()]);
        assert_eq!(line("seed"), Some(1));
        assert_eq!(line("yarn.ply_count"), Some(4));
        assert_eq!(line("fabric.0.yarn.ply_count"), Some(9));
        assert_eq!(line("fabric.1.yarn.ply_count"), Some(11));
        assert_eq!(line("fabric.yarn.hair_taper"), Some(12), "the first fabric that has it");
        assert_eq!(line("light.0"), Some(13));
        assert_eq!(line("yarn.none"), None);
        assert_eq!(line("seed.none"), None);
        assert_eq!(line("fabric.7.yarn"), None);
        assert_eq!(KeyError::line(text, &["yarn.none".into(), "yarn".into()]), Some(2));
        assert_eq!(KeyError::line("not toml", &["a".into()]), None);
    }
}
