//! What a scene file comes to: every key with its value, presets and defaults filled in.

use super::SceneFile;
use super::fiber_table::resolve_fiber;
use super::keys::KeyError;
use super::light::{LightKind, LightTable};
use super::parameters::{Kind, of_table};
use super::yarn_table::resolve_yarn;
use crate::bsdf::presets::DEFAULT_FIBER;
use crate::yarn::presets::DEFAULT_YARN;
use serde::Serialize;
use toml::{Table, Value};

impl SceneFile {
    /// Every key with its value, in the tables of a scene file; `light` and `fabric` are arrays. Keys that are
    /// absent are those whose absence means something: that it is found out, or does not apply. Pitches are
    /// `"untwisted"` then. A seed beyond what TOML holds is the largest that it does.
    ///
    /// # Errors
    /// Scene files that no check has passed.
    pub fn effective(&self) -> Result<Table, KeyError> {
        let seed = self.seed.min(i64::MAX as u64);
        let mut all = table(&Self { seed, fabric: Vec::new(), ..self.clone() })?;
        all.insert("yarn".into(), effective_yarn(&self.yarn, &Table::new())?.into());
        all.insert("fiber".into(), effective_fiber(&self.fiber, &Table::new())?.into());
        let mut fabrics = Vec::new();
        for fabric in &self.fabric {
            let mut values = table(fabric)?;
            values.insert("yarn".into(), effective_yarn(&self.yarn, &fabric.yarn)?.into());
            values.insert("fiber".into(), effective_fiber(&self.fiber, &fabric.fiber)?.into());
            fabrics.push(Value::Table(values));
        }
        all.insert("fabric".into(), Value::Array(fabrics));
        let lights = self.light().into_iter().map(|light| table(&light.filled()).map(Value::Table));
        all.insert("light".into(), Value::Array(lights.collect::<Result<_, _>>()?));
        let mut ambient = self.ambient.clone();
        if ambient.environment.is_none() {
            ambient.radiance = Some(ambient.radiance().to_array());
        }
        all.insert("ambient".into(), table(&ambient)?.into());
        Ok(all)
    }
}

impl LightTable {
    /// The same light with every key that its kind has.
    pub fn filled(&self) -> Self {
        let has = |key: &str| self.kind.keys().contains(&key);
        let [inner, outer] = self.angles_deg();
        let strength = self.strength().to_array();
        let spot = self.kind == LightKind::Spot;
        Self {
            direction: has("direction").then_some(self.direction().to_array()),
            irradiance: has("irradiance").then_some(strength),
            intensity: has("intensity").then_some(strength),
            inner_angle_deg: spot.then_some(inner),
            outer_angle_deg: spot.then_some(outer),
            ..self.clone()
        }
    }
}

fn table(of: &impl Serialize) -> Result<Table, KeyError> {
    Table::try_from(of).map_err(|e| KeyError::new("scene", format!(": {e}")))
}

/// What is typed where the scene's own table cannot be without what a fabric says as well.
fn typed(scene: &Table, fabric: &Table) -> Table {
    scene.iter().chain(fabric).map(|(key, value)| (key.clone(), value.clone())).collect()
}

fn effective_yarn(scene: &Table, fabric: &Table) -> Result<Table, KeyError> {
    let Ok((_, yarn)) = resolve_yarn(scene, fabric) else { return Ok(typed(scene, fabric)) };
    let mut values = table(&yarn)?;
    for row in of_table("yarn").filter(|row| matches!(row.kind, Kind::Pitch(..))) {
        values.entry(row.key).or_insert_with(|| Value::String("untwisted".into()));
    }
    let preset = fabric.get("preset").or(scene.get("preset"));
    values.insert("preset".into(), preset.cloned().unwrap_or_else(|| Value::String(DEFAULT_YARN.into())));
    Ok(values)
}

fn effective_fiber(scene: &Table, fabric: &Table) -> Result<Table, KeyError> {
    let Ok(fiber) = resolve_fiber(scene, fabric) else { return Ok(typed(scene, fabric)) };
    let mut values = table(&fiber)?;
    let preset = fabric.get("preset").or(scene.get("preset"));
    values.insert("preset".into(), preset.cloned().unwrap_or_else(|| Value::String(DEFAULT_FIBER.into())));
    if let Some(color) = fabric.get("color").or(scene.get("color")) {
        let color = color.clone().try_into::<[f64; 3]>().map(|color| Value::from(color.to_vec()));
        values.insert("color".into(), color.map_err(|e| KeyError::from_toml(&e))?);
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn effective(text: &str) -> Table {
        SceneFile::from_table(toml::from_str(text).unwrap()).unwrap().effective().unwrap()
    }

    #[test]
    fn every_parameter_that_is_not_optional_has_a_value() {
        let all = effective("[fabric]\nmodel = 'a'\n");
        for row in
            super::super::parameters::parameters().iter().filter(|row| !row.optional && !row.table.is_empty())
        {
            let values = match &all[row.table] {
                Value::Array(items) => items[0].as_table().unwrap(),
                other => other.as_table().unwrap(),
            };
            assert!(values.contains_key(row.key), "{}", row.path());
        }
        assert_eq!(all["yarn"]["hair_pitch_mm"].as_str(), Some("untwisted"));
        assert_eq!(all["yarn"]["preset"].as_str(), Some(DEFAULT_YARN));
        assert!(all["light"][0].get("intensity").is_none() && all["ambient"].get("radiance").is_some());
    }

    #[test]
    fn what_a_fabric_says_is_apart_from_what_the_scene_does() {
        let all = effective(
            "[yarn]\nply_count = 2\n[fiber]\ncolor = [0.3, 0, 0]\n[[fabric]]\n[[fabric]]\nyarn = {ply_count = 4}\n\
             fiber = {preset = 'silk', color = [0.5, 0.5, 0.5], c_r = [0, 0, 0]}\n[ambient]\nenvironment = 'a.exr'\n",
        );
        assert_eq!(all["yarn"]["ply_count"].as_integer(), Some(2));
        assert_eq!(all["fabric"][0]["yarn"]["ply_count"].as_integer(), Some(2));
        assert_eq!(all["fabric"][1]["yarn"]["ply_count"].as_integer(), Some(4));
        assert_eq!(all["fabric"][0]["fiber"]["color"][0].as_float(), Some(0.3));
        assert!(all["ambient"].get("radiance").is_none());
    }

    #[test]
    fn a_scene_that_only_its_fabrics_make_whole_is_shown_as_typed() {
        let all = effective("[yarn]\nmigration_max = 0\n[fabric.yarn]\nmigration_min = 0\n");
        assert_eq!(all["yarn"]["migration_max"].as_integer(), Some(0));
        assert_eq!(all["fabric"][0]["yarn"]["migration_max"].as_float(), Some(0.0));
    }
}
