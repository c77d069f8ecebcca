//! From a scene's yarn tables to a yarn: the preset, then what the scene and the fabric say otherwise.

use super::file::SceneFile;
use super::keys::KeyError;
use super::tables::{check_each, preset_named, unknown_key};
use crate::yarn::params::YarnParams;
use crate::yarn::presets;
use crate::yarn::ranges::{PARAMETERS, ParamError, find};
use toml::Table;

/// The preset and the parameters after the scene's and the fabric's overrides, checked.
///
/// # Errors
/// Unknown presets and keys, with the nearest known one; values of the wrong type or out of range.
pub fn resolve_yarn(scene: &Table, fabric: &Table) -> Result<(YarnParams, YarnParams), KeyError> {
    let named = fabric.get("preset").or(scene.get("preset"));
    let preset = preset_named("yarn", named, presets::DEFAULT_YARN, presets::yarn_names(), presets::yarn)?;
    let known = PARAMETERS.iter().map(|parameter| parameter.key).chain(["preset"]);
    let mut table = Table::try_from(&preset).map_err(|e| KeyError::new("yarn", format!(": {e}")))?;
    let mut radius_stated = false;
    for (key, value) in scene.iter().chain(fabric).filter(|(key, _)| *key != "preset") {
        let parameter = find(key).ok_or_else(|| unknown_key("yarn", key, known.clone()))?;
        parameter.check(value).map_err(at_key)?;
        radius_stated |= key == "yarn_radius_mm";
        // TOML has no null: an untwisted pitch is one that is absent.
        if value.as_str() == Some("untwisted") {
            table.remove(key);
        } else {
            table.insert(key.clone(), value.clone());
        }
    }
    let mut yarn: YarnParams =
        table.try_into().map_err(|e| KeyError::new("yarn", format!(": {}", KeyError::from_toml(&e))))?;
    // The radius of a preset with several plies means nothing to a single one.
    if yarn.ply_count == 1 && preset.ply_count > 1 && !radius_stated {
        yarn.yarn_radius_mm = 0.0;
    }
    yarn.validate().map_err(at_key)?;
    Ok((preset, yarn))
}

/// Checks every yarn table of a scene.
///
/// # Errors
/// The first that is wrong, with the paths at which its key may stand, the likeliest first.
pub fn check_yarns(file: &SceneFile) -> Result<(), (KeyError, Vec<String>)> {
    check_each(file, "yarn", |fabric| &fabric.yarn, |fabric| resolve_yarn(&file.yarn, fabric).map(|_| ()))
}

fn at_key(error: ParamError) -> KeyError {
    KeyError::new(&format!("yarn.{}", error.key), format!(" = {}: {}", error.found, error.rule))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Table {
        toml::from_str(text).unwrap()
    }

    fn error(scene: &str) -> String {
        resolve_yarn(&table(scene), &Table::new()).unwrap_err().to_string()
    }

    #[test]
    fn overrides_apply_in_order_and_a_pitch_can_be_taken_away() {
        let scene = table("ply_pitch_mm = 4.0\nfibers_per_ply = 10");
        let fabric = table("fibers_per_ply = 20\nfiber_pitch_mm = 'untwisted'\nhair_length_mm = [2, 0.5]");
        let (preset, yarn) = resolve_yarn(&scene, &fabric).unwrap();
        assert_eq!((yarn.ply_pitch_mm, yarn.fibers_per_ply, yarn.fiber_pitch_mm), (Some(4.0), 20, None));
        assert_eq!((yarn.hair_length_mm.mean, yarn.hair_length_mm.deviation), (2.0, 0.5));
        assert_eq!(preset, presets::yarn(presets::DEFAULT_YARN).unwrap());
        let (preset, _) = resolve_yarn(&table("preset = 'silk1'"), &table("preset = 'silk2'")).unwrap();
        assert_eq!(preset, presets::yarn("silk2").unwrap());
    }

    #[test]
    fn a_single_ply_lies_on_the_centre_line_unless_told_otherwise() {
        let radius =
            |scene: &str, fabric: &str| resolve_yarn(&table(scene), &table(fabric)).unwrap().1.yarn_radius_mm;
        assert_eq!(radius("ply_count = 1", ""), 0.0);
        assert_eq!(radius("", "ply_count = 1"), 0.0);
        assert_eq!(radius("ply_count = 1\nyarn_radius_mm = 0.3", ""), 0.3);
        assert_eq!(radius("yarn_radius_mm = 0.3", "ply_count = 1"), 0.3);
        let preset = presets::yarn(presets::DEFAULT_YARN).unwrap().yarn_radius_mm;
        assert_eq!(radius("ply_count = 2", ""), preset);
        assert_eq!(radius("ply_count = 1", "ply_count = 3"), preset);
    }

    #[test]
    fn every_error_is_one_line_that_names_the_key_and_what_is_allowed() {
        for (scene, expected) in [
            ("ply_cuont = 3", "yarn.ply_cuont: unknown key; did you mean `ply_count`?"),
            ("fiber_per_plie = 3", "yarn.fiber_per_plie: unknown key; did you mean `fibers_per_ply`?"),
            ("perset = 'silk1'", "yarn.perset: unknown key; did you mean `preset`?"),
            ("preset = 3", "yarn.preset = 3: expected a name"),
            ("ply_count = 0", "yarn.ply_count = 0: allowed is 1 to 8"),
            ("ply_count = '3'", "yarn.ply_count = \"3\": expected a whole number, allowed is 1 to 8"),
            ("ellipse_long_mm = -0.1", "yarn.ellipse_long_mm = -0.1: allowed is 0.000001 to 1000000 mm"),
            ("density_beta = -1", "yarn.density_beta = -1: allowed is 0 to 20"),
            ("hair_taper = nan", "yarn.hair_taper = NaN: allowed is 0 to 1"),
            (
                "migration_min = 1\nmigration_max = 0.5",
                "yarn.migration_max = 0.5: allowed is at least migration_min = 1",
            ),
        ] {
            assert_eq!(error(scene), expected);
        }
        let message = error("preset = 'worsted_3py'");
        assert!(
            message
                .starts_with("yarn.preset = \"worsted_3py\": no such preset; did you mean `worsted_3ply`?")
        );
        for (scene, holds) in [
            ("preset = 'cashmere'", "expected one of worsted_3ply"),
            ("preset = \"a\\nb\"", "a\\nb"),
            ("\"a\\nb\" = 1", "yarn.a\\nb: unknown key; expected one of ply_count"),
            ("zebra = 1", "unknown key; expected one of ply_count"),
            ("yarn_radius_mm = 'untwisted'", "expected a number"),
        ] {
            let message = error(scene);
            assert!(message.contains(holds) && !message.contains('\n'), "{message}");
        }
    }
}
