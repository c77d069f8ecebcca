//! What differs from a scene file, as `--set` takes it.

use crate::scene::parameters::{Kind, find};
use toml::{Table, Value};

/// Assignments (`yarn.ply_count=2`) that make `typed` of `opened`, both a scene file's tables. `effective` says what a key
/// of `typed` comes to.
pub fn assignments(opened: &Table, typed: &Table, effective: &dyn Fn(&str) -> Option<Value>) -> Vec<String> {
    let mut found = Vec::new();
    compare("", opened, typed, &mut |path, value| found.push(assignment(path, value, effective)));
    found
}

/// The assignment that gives `opened` the key at `path` as `typed` has it; a light that `opened` has not is given with all
/// others.
pub fn assignment_of(
    path: &str,
    opened: &Table,
    typed: &Table,
    effective: &dyn Fn(&str) -> Option<Value>,
) -> String {
    let count = |table: &Table| table.get("light").and_then(Value::as_array).map(Vec::len);
    if path.starts_with("light.") && (count(opened).is_none() || count(opened) != count(typed)) {
        let lights = typed.get("light").cloned().unwrap_or_else(|| Value::Array(vec![Table::new().into()]));
        return format!("light={lights}");
    }
    assignment(&as_written(path, opened), effective(path).as_ref(), effective)
}

/// The path as an assignment to `opened` has it: one `[fabric]` has no number.
fn as_written(path: &str, opened: &Table) -> String {
    match path.strip_prefix("fabric.0.") {
        Some(rest) if !opened.get("fabric").is_some_and(Value::is_array) => format!("fabric.{rest}"),
        _ => path.to_owned(),
    }
}

fn assignment(path: &str, value: Option<&Value>, effective: &dyn Fn(&str) -> Option<Value>) -> String {
    // `null` unsets any other key, but untwists yarn.
    let pitch = find(path).is_some_and(|row| matches!(row.kind, Kind::Pitch(..)));
    let value = if pitch { value.cloned().or_else(|| effective(path)) } else { value.cloned() };
    match value {
        None => format!("{path}=null"),
        Some(Value::String(text)) if is_plain_word(&text) => format!("{path}={text}"),
        Some(value) => format!("{path}={value}"),
    }
}

/// Whether `--set` takes the text for a string without quotes.
fn is_plain_word(text: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '/')
        && text.chars().all(plain)
        && !["true", "false", "inf", "nan", "null"].contains(&text)
}

fn compare(path: &str, old: &Table, new: &Table, tell: &mut dyn FnMut(&str, Option<&Value>)) {
    let mut keys: Vec<&String> = old.keys().chain(new.keys().filter(|key| !old.contains_key(*key))).collect();
    keys.sort_unstable();
    for key in keys {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let none = Table::new();
        match (old.get(key), new.get(key)) {
            (Some(Value::Table(old)), Some(Value::Table(new))) => compare(&path, old, new, tell),
            (None, Some(Value::Table(new))) => compare(&path, &none, new, tell),
            (Some(Value::Table(old)), None) => compare(&path, old, &none, tell),
            (Some(Value::Array(old)), Some(Value::Array(new)))
                if old.len() == new.len() && old.iter().chain(new).all(Value::is_table) =>
            {
                for (index, pair) in old.iter().zip(new).enumerate() {
                    if let (Some(old), Some(new)) = (pair.0.as_table(), pair.1.as_table()) {
                        compare(&format!("{path}.{index}"), old, new, tell);
                    }
                }
            }
            (old, new) if old != new => tell(&path, new),
            _ => {}
        }
    }
}

/// `--set ASSIGNMENT` as a shell takes it.
pub fn set_line(assignment: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=,:+@".contains(c);
    if assignment.chars().all(plain) {
        return format!("--set {assignment}");
    }
    format!("--set '{}'", assignment.replace('\'', r"'\''"))
}
