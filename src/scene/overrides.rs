//! `--set yarn.ply_pitch_mm=4`: any scene key by its path.

use crate::yarn::ranges;
use toml::{Table, Value};

/// Sets the key at the dotted `path` of a scene table, creating tables on the way. A number names an
/// element of an array (`light.0.irradiance`); without one, an array of tables is taken at its first.
/// `null` removes the key; a yarn's pitch becomes `"untwisted"`.
///
/// # Errors
/// One line that names the path and what stands in its way.
pub fn apply(scene: &mut Table, assignment: &str) -> Result<(), String> {
    let (path, text) = assignment
        .split_once('=')
        .ok_or_else(|| format!("--set {assignment}: expected key=value, found no `=`"))?;
    let path = path.trim();
    let keys: Vec<&str> = path.split('.').collect();
    if keys.iter().any(|key| key.is_empty()) {
        return Err(format!("--set {assignment}: expected a dotted key before `=`, found `{path}`"));
    }
    let mut table = scene;
    let (last, parents) = keys.split_last().ok_or_else(|| format!("--set {assignment}: no key"))?;
    let mut rest = parents.iter().peekable();
    while let Some(key) = rest.next() {
        let entry = table.entry(key.to_string()).or_insert_with(|| Value::Table(Table::new()));
        table = match entry {
            Value::Table(inner) => inner,
            Value::Array(items) => {
                let index = rest.next_if(|k| k.parse::<usize>().is_ok());
                let index = index.and_then(|k| k.parse().ok()).unwrap_or(0);
                let count = items.len();
                items.get_mut(index).and_then(Value::as_table_mut).ok_or_else(|| {
                    format!("--set {assignment}: `{key}` has {count} tables, none numbered {index}")
                })?
            }
            other => {
                return Err(format!("--set {assignment}: `{key}` is a {}, not a table", other.type_str()));
            }
        };
    }
    match parse_value(text.trim()) {
        Some(value) => table.insert(last.to_string(), value),
        None if is_pitch(&keys) => table.insert(last.to_string(), Value::String("untwisted".into())),
        None => table.remove(*last),
    };
    Ok(())
}

/// Whether the path ends in a pitch of a yarn table: removed, it would be the preset's again.
fn is_pitch(keys: &[&str]) -> bool {
    let pitch = |key| ranges::find(key).is_some_and(|p| matches!(p.allowed, ranges::Allowed::Pitch(..)));
    matches!(keys, [.., "yarn", key] if pitch(key))
}

/// A TOML value; anything that is none is taken as a string; `null` is none at all.
fn parse_value(text: &str) -> Option<Value> {
    if text == "null" {
        return None;
    }
    let parsed = toml::from_str::<Table>(&format!("value = {text}")).ok();
    Some(parsed.and_then(|mut table| table.remove("value")).unwrap_or_else(|| Value::String(text.to_owned())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(start: &str, assignment: &str) -> Result<String, String> {
        let mut table: Table = toml::from_str(start).unwrap();
        apply(&mut table, assignment).map(|()| toml::to_string(&table).unwrap())
    }

    #[test]
    fn sets_creates_replaces_and_removes() {
        assert_eq!(set("", "yarn.ply_pitch_mm=4").unwrap(), "[yarn]\nply_pitch_mm = 4\n");
        assert_eq!(set("[yarn]\npreset = 'a'", "yarn.preset=b c").unwrap(), "[yarn]\npreset = \"b c\"\n");
        assert_eq!(set("[yarn]\na = 1", "yarn.a=null").unwrap(), "[yarn]\n");
        assert_eq!(set("", "camera.target_mm=[1, 2, 3]").unwrap(), "[camera]\ntarget_mm = [1, 2, 3]\n");
        let untwisted = "[yarn]\nply_pitch_mm = \"untwisted\"\n";
        assert_eq!(set("", "yarn.ply_pitch_mm=null").unwrap(), untwisted);
        assert_eq!(set("ply_pitch_mm = 1", "ply_pitch_mm=null").unwrap(), "");
        let lights = "[[light]]\nkind = 'x'\n[[light]]\nkind = 'y'";
        assert!(set(lights, "light.1.kind=z").unwrap().contains("\"z\""));
        assert!(set(lights, "light.kind=z").unwrap().starts_with("[[light]]\nkind = \"z\""));
    }

    #[test]
    fn refuses_in_one_line() {
        for (start, assignment) in [
            ("", "no_equals"),
            ("", "=4"),
            ("", "a..b=4"),
            ("a = 1", "a.b=4"),
            ("[[light]]", "light.7.kind=z"),
        ] {
            let error = set(start, assignment).unwrap_err();
            assert!(error.contains(assignment) && !error.contains('\n'), "{error}");
        }
    }

    #[test]
    fn a_value_cannot_smuggle_in_other_keys() {
        // Text that is no single TOML value is a string, not more scene.
        let table = set("", "a=1\nb = 2").unwrap();
        assert!(!table.contains("\nb = 2\n"), "{table}");
    }
}
