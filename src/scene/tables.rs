//! What the tables of yarn and fiber parameters have in common: presets by name, unknown keys, one table for the scene
//! and one for each fabric.

use super::file::{FabricTable, SceneFile};
use super::keys::{KeyError, nearest, suggestion};
use crate::yarn::ranges::shown;
use toml::{Table, Value};

/// The preset that `[table] preset` names, or the one called `default`.
///
/// # Errors
/// What is no name; a name that is not among `names`, with the nearest one.
pub fn preset_named<T>(
    table: &str,
    named: Option<&Value>,
    default: &str,
    names: impl Iterator<Item = &'static str>,
    preset: impl Fn(&str) -> Option<T>,
) -> Result<T, KeyError> {
    let path = format!("{table}.preset");
    let name = match named {
        None => default,
        Some(Value::String(name)) => name,
        Some(other) => return Err(KeyError::new(&path, format!(" = {}: expected a name", shown(other)))),
    };
    preset(name).ok_or_else(|| {
        let known: Vec<_> = names.collect();
        let hint = suggestion(nearest(name, known.iter().copied()));
        let message = format!(" = {name:?}: no such preset{hint}; expected one of {}", known.join(", "));
        KeyError::new(&path, message)
    })
}

/// That `[table]` has no `key`, with the nearest of those it has.
pub fn unknown_key<'a>(table: &str, key: &str, known: impl Iterator<Item = &'a str> + Clone) -> KeyError {
    let message = match nearest(key, known.clone()) {
        near @ Some(_) => format!(": unknown key{}", suggestion(near)),
        None => format!(": unknown key; expected one of {}", known.collect::<Vec<_>>().join(", ")),
    };
    KeyError::new(&format!("{table}.{}", key.escape_debug()), message)
}

/// Checks the fabrics' tables of that name one by one, or an empty one where a scene has no fabric yet.
///
/// # Errors
/// The first that is wrong, with the paths at which its key may stand, the likeliest first.
pub fn check_each(
    file: &SceneFile,
    name: &str,
    table: impl Fn(&FabricTable) -> &Table,
    check: impl Fn(&Table) -> Result<(), KeyError>,
) -> Result<(), (KeyError, Vec<String>)> {
    let none = Table::new();
    let bare = file.fabric.is_empty().then_some(&none);
    for (i, fabric) in file.fabric.iter().map(table).chain(bare).enumerate() {
        check(fabric).map_err(|error| {
            // `[fabric]` is a table of its own, `[[fabric]]` an array of them.
            let tables = [format!("fabric.{i}."), "fabric.".into(), String::new()];
            let keys = tables.iter().map(|table| format!("{table}{}", error.path));
            let whole = tables.iter().map(|table| format!("{table}{name}"));
            let paths = keys.chain(whole).collect();
            (error, paths)
        })?;
    }
    Ok(())
}
