//! A piece of cloth made ready: file units and axes to mm with Y up, yarn parameters resolved.

use super::SceneError;
use super::file::{FabricTable, FiberTable, SceneFile};
use crate::io::curves::UpAxis;
use crate::io::repair::summarize_repairs;
use crate::io::yarn_file::{Loaded, load_yarn_file};
use crate::math::curve::Curve;
use crate::yarn::contact::estimate_contact_radius;
use crate::yarn::params::YarnParams;
use crate::yarn::presets;
use crate::yarn::strand::{Strands, strands};
use glam::DVec3;
use std::path::Path;
use toml::{Table, Value};

/// A loaded fabric.
#[derive(Clone, Debug)]
pub struct Fabric {
    /// The yarn file's name, for reports.
    pub name: String,
    /// Its yarn.
    pub yarn: YarnParams,
    /// Its fibers' look.
    pub fiber: FiberTable,
    /// Its centre lines in mm, world axes.
    pub strands: Strands,
    /// Millimetres per unit of the file.
    pub mm_per_unit: f64,
    /// What a user should know of how the file was read, one line each.
    pub notes: Vec<String>,
}

impl Fabric {
    /// Loads one fabric of a scene; `folder` is what its model's path is relative to and `scene` names
    /// the scene in errors.
    ///
    /// # Errors
    /// Bad yarn files, unknown presets or keys, values out of range.
    pub fn load(
        file: &SceneFile,
        table: &FabricTable,
        folder: &Path,
        scene: &str,
    ) -> Result<Self, SceneError> {
        if table.model.is_empty() {
            let message = "fabric.model: expected a yarn file, found none".to_owned();
            return Err(SceneError::Value { scene: scene.to_owned(), message });
        }
        Self::from_loaded(file, table, load_yarn_file(&folder.join(&table.model))?, scene)
    }

    /// The same for curves that are already there.
    ///
    /// # Errors
    /// Unknown presets or keys, values out of range.
    pub fn from_loaded(
        file: &SceneFile,
        table: &FabricTable,
        loaded: Loaded,
        scene: &str,
    ) -> Result<Self, SceneError> {
        let value = |message: String| SceneError::Value { scene: scene.to_owned(), message };
        let (preset, yarn) = resolve_yarn(&file.yarn, &table.yarn).map_err(value)?;
        yarn.validate().map_err(|error| SceneError::Param { scene: scene.to_owned(), error })?;
        let fiber = table.fiber.clone().unwrap_or_else(|| file.fiber.clone());

        let mut notes = loaded.notes.clone();
        notes.extend(summarize_repairs(&loaded.repairs));
        let mm_per_unit = match table.mm_per_unit {
            Some(given) => given,
            None => matched_scale(&loaded, &preset, &mut notes),
        };
        if !(1e-9..=1e9).contains(&mm_per_unit) {
            return Err(value(format!("fabric.mm_per_unit = {mm_per_unit}: allowed is 1e-9 to 1e9")));
        }
        let curves = world_curves(&loaded, mm_per_unit);
        let strands = strands(&curves, loaded.curves.basis, &yarn, file.seed);
        Ok(Self { name: table.model.clone(), yarn, fiber, strands, mm_per_unit, notes })
    }

    /// Positions that the picture must hold: the Bezier control points of every piece, in mm.
    pub fn hull_points(&self) -> impl Iterator<Item = DVec3> + Clone {
        self.strands.pieces.iter().flat_map(|piece| self.strands.bezier(piece))
    }

    /// A straight yarn in the default look.
    #[cfg(test)]
    pub fn for_tests() -> Self {
        let yarn = presets::yarn(presets::DEFAULT_YARN).unwrap();
        let points = (0..4).map(|i| DVec3::X * f64::from(i)).collect();
        let strands =
            strands(&[Curve { points, closed: false }], crate::math::curve::Basis::CatmullRom, &yarn, 0);
        let fiber = FiberTable::default();
        Self { name: "test".into(), yarn, fiber, strands, mm_per_unit: 1.0, notes: Vec::new() }
    }
}

/// The preset and the parameters after the scene's and the fabric's overrides.
fn resolve_yarn(scene: &Table, fabric: &Table) -> Result<(YarnParams, YarnParams), String> {
    let name = match fabric.get("preset").or(scene.get("preset")) {
        None => presets::DEFAULT_YARN,
        Some(Value::String(name)) => name,
        Some(other) => return Err(format!("yarn.preset: expected a name, found {other}")),
    };
    let preset = presets::yarn(name).ok_or_else(|| {
        let known: Vec<_> = presets::yarn_names().collect();
        format!("yarn.preset = \"{name}\": expected one of {}", known.join(", "))
    })?;
    let mut table = Table::try_from(&preset).map_err(|e| format!("yarn: {e}"))?;
    for (key, value) in scene.iter().chain(fabric).filter(|(key, _)| *key != "preset") {
        // TOML has no null; a pitch may be written as "untwisted".
        if value.as_str() == Some("untwisted") {
            table.remove(key);
        } else {
            table.insert(key.clone(), value.clone());
        }
    }
    let yarn = table.try_into().map_err(|e| format!("yarn: {}", one_line(&e)))?;
    Ok((preset, yarn))
}

/// The first line of a TOML error's own message.
pub fn one_line(error: &toml::de::Error) -> String {
    error.message().lines().next().unwrap_or("not valid TOML").to_owned()
}

/// Millimetres per unit so that the file's yarns touch at the preset's outer radius. The preset's, not
/// the overridden one: sweeping a radius must not rescale the model.
fn matched_scale(loaded: &Loaded, preset: &YarnParams, notes: &mut Vec<String>) -> f64 {
    let outer_mm = preset.outer_radius_mm();
    match estimate_contact_radius(&loaded.curves.curves, loaded.curves.basis) {
        Some(radius) => {
            let scale = outer_mm / radius;
            notes.push(format!(
                "no mm_per_unit: yarns touch at radius {radius:.4} units, matched to the preset's outer \
                 radius {outer_mm:.3} mm: {scale:.4} mm per unit"
            ));
            scale
        }
        None => {
            notes.push("no mm_per_unit and no yarns that touch: 1 unit is taken as 1 mm".into());
            1.0
        }
    }
}

/// The curves in mm with Y up.
fn world_curves(loaded: &Loaded, mm_per_unit: f64) -> Vec<Curve> {
    let up = loaded.curves.up_axis.unwrap_or(UpAxis::Y);
    let turn = |p: DVec3| match up {
        UpAxis::X => DVec3::new(-p.y, p.x, p.z),
        UpAxis::Y => p,
        UpAxis::Z => DVec3::new(p.x, p.z, -p.y),
    };
    let place = |curve: &Curve| Curve {
        points: curve.points.iter().map(|&p| turn(p) * mm_per_unit).collect(),
        closed: curve.closed,
    };
    loaded.curves.curves.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overrides_apply_in_order_and_a_pitch_can_be_taken_away() {
        let scene: Table = toml::from_str("ply_pitch_mm = 4.0\nfibers_per_ply = 10").unwrap();
        let fabric: Table = toml::from_str("fibers_per_ply = 20\nfiber_pitch_mm = 'untwisted'").unwrap();
        let (preset, yarn) = resolve_yarn(&scene, &fabric).unwrap();
        assert_eq!((yarn.ply_pitch_mm, yarn.fibers_per_ply, yarn.fiber_pitch_mm), (Some(4.0), 20, None));
        assert_eq!(preset, presets::yarn(presets::DEFAULT_YARN).unwrap());
    }

    #[test]
    fn unknown_names_are_errors_that_name_what_is_known() {
        let table = |text: &str| toml::from_str::<Table>(text).unwrap();
        let error = resolve_yarn(&table("preset = 'cashmere'"), &Table::new()).unwrap_err();
        assert!(error.contains("cashmere") && error.contains("worsted_3ply"), "{error}");
        let error = resolve_yarn(&table("ply_cuont = 3"), &Table::new()).unwrap_err();
        assert!(
            error.contains("ply_cuont") && error.contains("ply_count") && !error.contains('\n'),
            "{error}"
        );
    }
}
