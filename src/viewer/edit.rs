//! Setting and removing keys of a scene file's text, which keeps its comments and order.

use toml::Table;
use toml_edit::{ArrayOfTables, DocumentMut, Item, TableLike};

/// The tables of a scene file's text.
///
/// # Errors
/// One line, about text that is not TOML.
pub fn table_of(typed: &DocumentMut) -> Result<Table, String> {
    toml::from_str(&typed.to_string())
        .map_err(|e| e.message().lines().next().unwrap_or("not TOML").to_owned())
}

/// What stands at a dotted path. A number names an element of an array of tables; where one table stands in the
/// array's place (`[fabric]`), it is that one.
pub fn get<'a>(typed: &'a DocumentMut, path: &str) -> Option<&'a Item> {
    let mut item = typed.as_item();
    for step in path.split('.') {
        item = match (step.parse::<usize>(), item) {
            (Ok(index), Item::ArrayOfTables(_) | Item::Value(toml_edit::Value::Array(_))) => {
                item.get(index)?
            }
            (Ok(0), Item::Table(_) | Item::Value(toml_edit::Value::InlineTable(_))) => item,
            _ => item.get(step)?,
        };
    }
    Some(item)
}

/// Sets the key at a dotted path; tables on the way, and the one light that a scene has by default, are made. A comment
/// behind the old value stays.
///
/// # Errors
/// One line, about a path that something else stands in the way of.
pub fn set(typed: &mut DocumentMut, path: &str, value: &toml::Value) -> Result<(), String> {
    let blocked = || format!("{path}: there is no such table in the scene file");
    let mut new: toml_edit::Value = value.to_string().parse().map_err(|_| blocked())?;
    let (parents, key) = split(path);
    let table = table_mut(typed, &parents, true).ok_or_else(blocked)?;
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *new.decor_mut() = old.decor().clone();
    }
    match table.get_mut(key) {
        Some(item) => *item = Item::Value(new),
        None => drop(table.insert(key, Item::Value(new))),
    }
    Ok(())
}

/// Removes the key at a dotted path, and its table where nothing is left in it: empty ones mean nothing, but for a light
/// and a fabric.
pub fn remove(typed: &mut DocumentMut, path: &str) {
    let (parents, key) = split(path);
    let Some(table) = table_mut(typed, &parents, false) else { return };
    table.remove(key);
    let counts = matches!(parents[..], [] | ["light" | "fabric"] | ["light" | "fabric", _]);
    if table.is_empty() && !counts && !has_comment(typed, &parents) {
        remove(typed, &parents.join("."));
    }
}

/// Whether a comment stands above the table's header or behind it.
fn has_comment(typed: &DocumentMut, steps: &[&str]) -> bool {
    let raw = |text: Option<&toml_edit::RawString>| {
        text.and_then(|text| text.as_str()).is_some_and(|text| text.contains('#'))
    };
    let decor = match get(typed, &steps.join(".")) {
        Some(Item::Table(table)) => table.decor(),
        _ => return false,
    };
    raw(decor.prefix()) || raw(decor.suffix())
}

/// Adds a light of these keys.
///
/// # Errors
/// One line, about a `light` that is no array of tables.
pub fn add_light(typed: &mut DocumentMut, keys: &Table) -> Result<(), String> {
    let wrong = || "light: expected an array of tables".to_owned();
    let keys: DocumentMut = keys.to_string().parse().map_err(|_| wrong())?;
    let empty = typed.get("light").and_then(Item::as_array).is_some_and(toml_edit::Array::is_empty);
    if empty {
        typed.remove("light");
    }
    let mut light = keys.as_table().clone();
    light.decor_mut().set_prefix("\n");
    match typed.entry("light").or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new())) {
        Item::ArrayOfTables(lights) => lights.push(light),
        Item::Value(toml_edit::Value::Array(lights)) => lights.push(light.into_inline_table()),
        _ => return Err(wrong()),
    }
    Ok(())
}

/// Takes a light away. Where none is left the scene says so: without the key it would have the default one.
pub fn remove_light(typed: &mut DocumentMut, index: usize) {
    let left = match typed.get_mut("light") {
        Some(Item::ArrayOfTables(lights)) if index < lights.len() => {
            lights.remove(index);
            lights.len()
        }
        Some(Item::Value(toml_edit::Value::Array(lights))) if index < lights.len() => {
            lights.remove(index);
            lights.len()
        }
        None => 0,
        Some(_) => return,
    };
    if left == 0 {
        typed.insert("light", Item::Value(toml_edit::Value::Array(toml_edit::Array::new())));
    }
}

fn split(path: &str) -> (Vec<&str>, &str) {
    let mut steps: Vec<&str> = path.split('.').collect();
    let key = steps.pop().unwrap_or_default();
    (steps, key)
}

fn table_mut<'a>(typed: &'a mut DocumentMut, steps: &[&str], create: bool) -> Option<&'a mut dyn TableLike> {
    let first_line = typed.as_table().is_empty();
    let mut table: &mut dyn TableLike = typed.as_table_mut();
    let mut rest = steps.iter().peekable();
    while let Some(step) = rest.next() {
        if !table.contains_key(step) {
            if !create {
                return None;
            }
            table.insert(step, new_table(step, first_line));
        }
        let index = rest.next_if(|next| next.parse::<usize>().is_ok());
        let index = index.and_then(|step| step.parse().ok()).unwrap_or(0);
        table = element(table.get_mut(step)?, index)?;
    }
    Some(table)
}

fn new_table(name: &str, first_line: bool) -> Item {
    let mut table = toml_edit::Table::new();
    table.decor_mut().set_prefix(if first_line { "" } else { "\n" });
    match name {
        "light" => Item::ArrayOfTables(std::iter::once(table).collect()),
        _ => Item::Table(table),
    }
}

fn element(item: &mut Item, index: usize) -> Option<&mut dyn TableLike> {
    match item {
        Item::ArrayOfTables(tables) => tables.get_mut(index).map(|table| table as &mut dyn TableLike),
        Item::Value(toml_edit::Value::Array(items)) => items
            .get_mut(index)
            .and_then(toml_edit::Value::as_inline_table_mut)
            .map(|table| table as &mut dyn TableLike),
        one if index == 0 => one.as_table_like_mut(),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::Value;

    const TYPED: &str =
        "# A sweater.\nseed = 7\n\n[yarn] # the yarn\nply_count = 3 # plies\n\n[fabric]\nmodel = 'a.bcc'\n";

    fn document(text: &str) -> DocumentMut {
        text.parse().unwrap()
    }

    #[test]
    fn comments_and_order_stay() {
        let mut typed = document(TYPED);
        set(&mut typed, "yarn.ply_count", &Value::Integer(2)).unwrap();
        assert_eq!(typed.to_string(), TYPED.replace("= 3", "= 2"));
        set(&mut typed, "camera.yaw_deg", &Value::Float(30.0)).unwrap();
        assert_eq!(typed.to_string(), TYPED.replace("= 3", "= 2") + "\n[camera]\nyaw_deg = 30.0\n");
        remove(&mut typed, "camera.yaw_deg");
        set(&mut typed, "yarn.ply_count", &Value::Integer(3)).unwrap();
        assert_eq!(typed.to_string(), TYPED);
        remove(&mut typed, "yarn.ply_count");
        assert!(typed.to_string().contains("[yarn] # the yarn\n"), "{typed}");
        remove(&mut typed, "none.of.these");
    }

    #[test]
    fn fabrics_and_lights_are_found_however_they_are_written() {
        for (text, path) in [
            ("[fabric]\nmodel = 'a'\n", "fabric.0.mm_per_unit"),
            ("[[fabric]]\nmodel = 'a'\n", "fabric.0.mm_per_unit"),
            ("fabric = {model = 'a'}\n", "fabric.0.mm_per_unit"),
            ("fabric = [{model = 'a'}]\n", "fabric.0.mm_per_unit"),
            ("[fabric]\nmodel = 'a'\n", "fabric.0.yarn.ply_count"),
            ("[[fabric]]\n[[fabric]]\n[fabric.yarn]\n", "fabric.1.yarn.ply_count"),
            ("fabric = [{}, {model = 'a'}]\n", "fabric.1.yarn.ply_count"),
            ("yarn.ply_pitch_mm = 3\n", "yarn.ply_count"),
            ("", "light.0.angular_size_deg"),
            ("[[light]]\n[[light]]\n", "light.1.angular_size_deg"),
            ("light = [{}, {}]\n", "light.1.angular_size_deg"),
        ] {
            let mut typed = document(text);
            set(&mut typed, path, &Value::Integer(2)).unwrap();
            let found = get(&typed, path).and_then(Item::as_integer);
            assert_eq!(found, Some(2), "{text}{path}: {typed}");
            let again: Table = toml::from_str(&typed.to_string()).unwrap();
            assert_eq!(again, table_of(&typed).unwrap());
            remove(&mut typed, path);
            assert!(get(&typed, path).is_none(), "{typed}");
        }
        assert!(set(&mut document("yarn = 3"), "yarn.ply_count", &Value::Integer(1)).is_err());
        assert!(set(&mut document("[[light]]"), "light.7.kind", &Value::Integer(1)).is_err());
    }

    #[test]
    fn lights_come_and_go() {
        let mut typed = document("[camera]\nyaw_deg = 3\n");
        let kind: Table = toml::from_str("kind = 'point'\nposition_mm = [1, 2, 3]").unwrap();
        add_light(&mut typed, &Table::new()).unwrap();
        add_light(&mut typed, &kind).unwrap();
        assert_eq!(table_of(&typed).unwrap()["light"].as_array().unwrap().len(), 2);
        remove_light(&mut typed, 0);
        assert_eq!(get(&typed, "light.0.kind").and_then(Item::as_str), Some("point"));
        remove_light(&mut typed, 0);
        assert_eq!(table_of(&typed).unwrap()["light"], Value::Array(Vec::new()));
        add_light(&mut typed, &kind).unwrap();
        assert!(typed.to_string().contains("[[light]]"), "{typed}");
        let mut inline = document("light = [{}]\n");
        add_light(&mut inline, &kind).unwrap();
        remove_light(&mut inline, 0);
        remove_light(&mut inline, 9);
        assert_eq!(get(&inline, "light.0.kind").and_then(Item::as_str), Some("point"));
    }
}
