//! From a scene's fiber tables to a fiber's look: the preset, then what the scene and the fabric say otherwise.

use super::file::SceneFile;
use super::keys::KeyError;
use super::parameters::{check_table, of_table};
use super::tables::{check_each, preset_named, unknown_key};
use crate::bsdf::params::FiberParams;
use crate::bsdf::presets;
use toml::{Table, Value};

/// The preset after the scene's and the fabric's overrides, checked.
///
/// # Errors
/// Unknown presets and keys, with the nearest known one; values of the wrong type or out of range.
pub fn resolve_fiber(scene: &Table, fabric: &Table) -> Result<FiberParams, KeyError> {
    let named = fabric.get("preset").or(scene.get("preset"));
    let preset =
        preset_named("fiber", named, presets::DEFAULT_FIBER, presets::fiber_names(), presets::fiber)?;
    let mut table = Table::try_from(&preset).map_err(|e| KeyError::new("fiber", format!(": {e}")))?;
    for (key, value) in scene.iter().chain(fabric).filter(|(key, _)| !OTHER_KEYS.contains(&key.as_str())) {
        if !keys().any(|known| known == key) {
            return Err(unknown_key("fiber", key, keys().chain(OTHER_KEYS)));
        }
        table.insert(key.clone(), value.clone());
    }
    let fiber: FiberParams = table.try_into().map_err(|e| {
        let error = KeyError::from_toml(&e);
        KeyError::new(&format!("fiber.{}", error.path), error.message)
    })?;
    let values = Table::try_from(&fiber).map_err(|e| KeyError::new("fiber", format!(": {e}")))?;
    check_table("fiber", "fiber", &values)?;
    match fabric.get("color").or(scene.get("color")) {
        None => Ok(fiber),
        Some(color) => dye(&fiber, color, scene.contains_key("c_tt") || fabric.contains_key("c_tt")),
    }
}

/// The fiber in a cloth of that colour. What dyes a fiber is its C_TT, so that cannot be stated as well; a
/// stated diffuse albedo stays.
fn dye(fiber: &FiberParams, color: &Value, has_c_tt: bool) -> Result<FiberParams, KeyError> {
    if has_c_tt {
        let message = format!(" = {color}: expected either color or c_tt, found both");
        return Err(KeyError::new("fiber.color", message));
    }
    let color: [f64; 3] = color.clone().try_into().map_err(|e: toml::de::Error| {
        KeyError::new("fiber.color", format!(": {}", KeyError::from_toml(&e).message))
    })?;
    let colors = Table::from_iter([("color".to_owned(), Value::from(color.to_vec()))]);
    check_table("fiber", "fiber", &colors)?;
    let dyed = fiber.dyed(color);
    let missed = dyed.diffuse().into_iter().zip(color).any(|(found, wanted)| (found - wanted).abs() > 0.01);
    if missed {
        // What its surface reflects no dye changes.
        let [low, high] = [0.0, 1.0].map(|c| fiber.dyed([c; 3]).diffuse().map(|d| (d * 1e3).round() / 1e3));
        let message = format!(" = {color:?}: allowed is {low:?} to {high:?} with this c_r");
        return Err(KeyError::new("fiber.color", message));
    }
    Ok(FiberParams { diffuse: fiber.diffuse, ..dyed })
}

/// Checks every fiber table of a scene.
///
/// # Errors
/// The first that is wrong, with the paths at which its key may stand, the likeliest first.
pub fn check_fibers(file: &SceneFile) -> Result<(), (KeyError, Vec<String>)> {
    check_each(file, "fiber", |fabric| &fabric.fiber, |fabric| resolve_fiber(&file.fiber, fabric).map(|_| ()))
}

/// What a fiber table may hold beside parameters: the preset, and the colour of the cloth to dye the fiber for.
const OTHER_KEYS: [&str; 2] = ["preset", "color"];

/// Every parameter of a fiber, by its name in [`FiberParams`].
fn keys() -> impl Iterator<Item = &'static str> + Clone {
    of_table("fiber").map(|parameter| parameter.key).filter(|key| !OTHER_KEYS.contains(key))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolve(scene: &str, fabric: &str) -> Result<FiberParams, KeyError> {
        resolve_fiber(&toml::from_str(scene).unwrap(), &toml::from_str(fabric).unwrap())
    }

    #[test]
    fn the_keys_are_those_of_the_struct() {
        let mut fiber = presets::fiber("silk").unwrap();
        fiber.diffuse = Some([0.1; 3]);
        fiber.specular = Some([0.1; 3]);
        fiber.specular_width_deg = Some(9.0);
        let table = Table::try_from(&fiber).unwrap();
        let mut keys: Vec<_> = keys().collect();
        keys.sort_unstable();
        assert_eq!(table.keys().map(String::as_str).collect::<Vec<_>>(), keys);
    }

    #[test]
    fn a_fabric_overrides_the_scene_and_both_the_preset() {
        let fiber =
            resolve("preset = 'silk'\nbeta_r_deg = 3\nc_r = [0.1, 0.2, 0.3]", "beta_r_deg = 4.5").unwrap();
        assert_eq!((fiber.beta_r_deg, fiber.c_r), (4.5, [0.1, 0.2, 0.3]));
        assert_eq!(fiber.c_tt, presets::fiber("silk").unwrap().c_tt);
        let fiber = resolve("preset = 'silk'", "preset = 'cotton'").unwrap();
        assert_eq!(fiber, presets::fiber("cotton").unwrap());
    }

    #[test]
    fn a_color_dyes_the_fiber_unless_its_dye_is_stated() {
        let fiber = resolve("preset = 'fleece'\ncolor = [0.4, 0.1, 0.05]", "").unwrap();
        assert!((fiber.diffuse()[0] - 0.4).abs() < 1e-9 && fiber.beta_r_deg == 7.238);
        let fiber = resolve("color = [0.4, 0.1, 0.05]\ndiffuse = [0, 0, 0]", "color = [0, 0.2, 0]").unwrap();
        assert!(fiber.diffuse() == [0.0; 3] && fiber.c_tt[1] > fiber.c_tt[0]);
    }

    #[test]
    fn every_error_is_one_line_that_names_the_key_and_what_is_allowed() {
        for (scene, expected) in [
            ("beta_r = 3", "fiber.beta_r: unknown key; did you mean `beta_r_deg`?"),
            ("preset = 'silck'", "fiber.preset = \"silck\": no such preset; did you mean `silk`?"),
            ("preset = 3", "fiber.preset = 3: expected a name"),
            ("diffuse = [2, 0, 0]", "fiber.diffuse = [2.0, 0.0, 0.0]: allowed is 0 to 1 each"),
            ("c_tt = [nan, 0, 0]", "fiber.c_tt = [NaN, 0.0, 0.0]: allowed is 0 to 1 each"),
            ("beta_r_deg = 0.1", "fiber.beta_r_deg = 0.1: allowed is 0.5 to 60"),
            ("gamma_tt_deg = 61", "fiber.gamma_tt_deg = 61: allowed is 0.5 to 60"),
            ("specular_width_deg = inf", "fiber.specular_width_deg = inf: allowed is 0.5 to 90"),
            ("c_r = 'red'", "fiber.c_r: invalid type"),
            ("c_r = [1, 2]", "fiber.c_r: invalid length"),
            ("color = [0, 0, 0]\nc_tt = [0, 0, 0]", "fiber.color = [0, 0, 0]: expected either color or c_tt"),
            ("color = 'red'", "fiber.color: invalid type"),
            ("preset = 'cotton'\ncolor = [0.1, 0.1, 0.1]", "fiber.color = [0.1, 0.1, 0.1]: allowed is [0."),
            ("color = [0, 0, 2]", "fiber.color = [0.0, 0.0, 2.0]: allowed is 0 to 1 each"),
            ("zebra = 1", "fiber.zebra: unknown key; expected one of c_r"),
        ] {
            let message = resolve(scene, "").unwrap_err().to_string();
            assert!(message.starts_with(expected) && !message.contains('\n'), "{message}");
        }
    }
}
