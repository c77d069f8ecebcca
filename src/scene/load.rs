//! From a path to a scene.

use super::fiber_table::check_fibers;
use super::file::{CameraTable, FabricTable, SceneFile};
use super::keys::{KeyError, line_at};
use super::light::check_lights;
use super::models::Models;
use super::parameters::{Group, check_table};
use super::yarn_table::check_yarns;
use super::{Fabric, Scene, SceneError, overrides};
use crate::io::curves::CurveSet;
use crate::io::error::{FileError, Place, shown};
use crate::io::yarn_file::Loaded;
use crate::knit::params::KnitParams;
use crate::knit::stockinette::stockinette;
use crate::math::bounds::bounds;
use glam::DVec3;
use std::path::Path;
use toml::{Table, Value};

/// Largest scene file read.
const MAX_SCENE_BYTES: u64 = 1 << 20;

impl SceneFile {
    /// Checks what the types cannot, but for the tables of yarn and fiber, which presets are part of.
    fn validate(&self) -> Result<(), KeyError> {
        check_lights(&self.light())?;
        self.ambient.check()?;
        const CHECKED_APART: [Group; 4] = [Group::Yarn, Group::Fiber, Group::Light, Group::Ambient];
        // The seed may be any, also one that TOML has no room for.
        let all = Self { seed: 0, ..self.clone() };
        let all = Table::try_from(&all).map_err(|e| KeyError::new("scene", format!(": {e}")))?;
        for (key, value) in &all {
            let tables: Vec<&Table> = match value {
                Value::Table(table) => vec![table],
                Value::Array(items) => items.iter().filter_map(Value::as_table).collect(),
                _ => Vec::new(),
            };
            let group = Group::ALL.into_iter().find(|group| group.table() == key);
            if let Some(group) = group.filter(|group| !CHECKED_APART.contains(group)) {
                tables.into_iter().try_for_each(|table| check_table(group.table(), key, table))?;
            }
        }
        Ok(())
    }

    /// The scene file of these tables, checked but for what its yarn files hold.
    ///
    /// # Errors
    /// Unknown keys, values of the wrong type or out of range: the first of them.
    pub fn from_table(table: Table) -> Result<Self, KeyError> {
        let file: Self = table.try_into().map_err(|e| KeyError::from_toml(&e))?;
        file.check().map_err(|(error, _)| error)?;
        Ok(file)
    }

    /// Checks everything that does not need the yarn files. The error comes with the paths at which its
    /// key may stand, the likeliest first.
    fn check(&self) -> Result<(), (KeyError, Vec<String>)> {
        self.validate().map_err(|error| {
            // A key that is missed stands in its table.
            let table = error.path.rsplit_once('.').map_or("", |(table, _)| table).to_owned();
            let paths = vec![error.path.clone(), table];
            (error, paths)
        })?;
        check_fibers(self)?;
        check_yarns(self)
    }
}

impl Scene {
    /// Loads a scene file (`.toml`) or a bare yarn file, with `--set` assignments applied.
    ///
    /// # Errors
    /// One line that names the file, the place, what was expected and found.
    pub fn load(path: &Path, assignments: &[String]) -> Result<Self, SceneError> {
        let name = shown(path);
        let value = |message: String| SceneError::Value { scene: name.clone(), message };
        let is_scene = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
        let (mut table, folder) = if is_scene {
            (read_table(path)?, path.parent().unwrap_or(Path::new("")).to_owned())
        } else {
            (Table::new(), std::path::PathBuf::new())
        };
        for assignment in assignments {
            overrides::apply(&mut table, assignment).map_err(value)?;
        }
        let mut file = SceneFile::from_table(table).map_err(|error| value(error.to_string()))?;
        if !is_scene {
            let model = path.to_str().ok_or_else(|| value("expected a UTF-8 path".into()))?.to_owned();
            match file.fabric.first_mut() {
                Some(fabric) => fabric.model = model,
                None => file.fabric.push(FabricTable { model, ..Default::default() }),
            }
        }
        Self::from_file(file, &folder, &name)
    }

    /// Loads what a checked scene file speaks of; `folder` is what its paths are relative to, and `name` names the scene
    /// in errors.
    ///
    /// # Errors
    /// One line that names the file, the place, what was expected and found.
    pub fn from_file(file: SceneFile, folder: &Path, name: &str) -> Result<Self, SceneError> {
        Self::of_file(file, folder, name, &mut Models::default())
    }

    /// As [`Self::from_file`]; what `models` has read before is not read again.
    ///
    /// # Errors
    /// As [`Self::from_file`].
    pub fn of_file(
        file: SceneFile,
        folder: &Path,
        name: &str,
        models: &mut Models,
    ) -> Result<Self, SceneError> {
        let value = |message: String| SceneError::Value { scene: name.to_owned(), message };
        if file.fabric.is_empty() {
            return Err(value("expected a [fabric] with a model, found none".into()));
        }
        let fabrics = file
            .fabric
            .iter()
            .map(|table| Fabric::load(&file, table, folder, name, models))
            .collect::<Result<Vec<_>, _>>()?;
        if file.animation.frame.is_some() && fabrics.iter().all(|fabric| fabric.motion.is_none()) {
            return Err(value("animation.frame: expected a fabric with a motion, found none".into()));
        }
        let origin_mm = origin(&file.camera, &fabrics);
        let environment = models.environment(&file.ambient, folder)?;
        Ok(Self { file, fabrics, origin_mm, environment })
    }

    /// A scene around generated stockinette, whatever fabric the file names; 1 unit is 1 mm. An environment's
    /// path is relative to the working folder.
    ///
    /// # Errors
    /// Values out of range; fabric that cannot be knitted.
    pub fn stockinette(file: SceneFile, knit: &KnitParams) -> Result<Self, SceneError> {
        Self::of_curves(file, stockinette(knit)?, "generated stockinette")
    }

    /// A scene around curves as they stand, in place of whatever fabric the file names; 1 unit is 1 mm. An
    /// environment's path is relative to the working folder.
    ///
    /// # Errors
    /// Values out of range.
    pub fn of_curves(mut file: SceneFile, curves: CurveSet, name: &str) -> Result<Self, SceneError> {
        let value = |(error, _): (KeyError, _)| SceneError::Value {
            scene: name.to_owned(),
            message: error.to_string(),
        };
        file.check().map_err(value)?;
        let loaded = Loaded::of_curves(curves, "curves");
        let table = FabricTable { model: name.to_owned(), mm_per_unit: Some(1.0), ..Default::default() };
        let fabric = Fabric::from_loaded(&file, &table, &loaded, name)?;
        file.fabric = vec![table];
        Self::of_fabrics(file, vec![fabric])
    }

    /// A scene of fabrics that are made ready. An environment's path is relative to the working folder.
    ///
    /// # Errors
    /// An environment that cannot be read.
    pub fn of_fabrics(file: SceneFile, fabrics: Vec<Fabric>) -> Result<Self, SceneError> {
        let origin_mm = origin(&file.camera, &fabrics);
        let environment = Models::default().environment(&file.ambient, Path::new(""))?;
        Ok(Self { file, fabrics, origin_mm, environment })
    }
}

/// Reads a scene file's text and checks it as it stands, so that an error has its line.
///
/// # Errors
/// Files that cannot be read, are too large, or are wrong.
pub fn read_scene(path: &Path) -> Result<String, SceneError> {
    let size = std::fs::metadata(path).map_err(|e| FileError::io(path, "read", &e))?.len();
    if size > MAX_SCENE_BYTES {
        let message = format!("expected a scene file of at most {MAX_SCENE_BYTES} bytes, found {size}");
        return Err(FileError::new(path, Place::File, message).into());
    }
    let text = std::fs::read_to_string(path).map_err(|e| FileError::io(path, "read", &e))?;
    let at_line = |error: toml::de::Error| {
        let line = line_at(&text, error.span().map_or(0, |span| span.start));
        FileError::new(path, Place::Line(line), KeyError::from_toml(&error).to_string())
    };
    let file = toml::from_str::<SceneFile>(&text).map_err(at_line)?;
    file.check().map_err(|(error, paths)| {
        let place = KeyError::line(&text, &paths).map_or(Place::File, Place::Line);
        FileError::new(path, place, error.to_string())
    })?;
    Ok(text)
}

fn read_table(path: &Path) -> Result<Table, SceneError> {
    let wrong = |e: toml::de::Error| FileError::new(path, Place::File, KeyError::from_toml(&e).to_string());
    Ok(toml::from_str(&read_scene(path)?).map_err(wrong)?)
}

/// Half the diagonal of the box around all fabrics, in mm, up to which f32 places fibers around its centre to a
/// thousandth of a millimetre.
pub const NEAR_TOGETHER_MM: f64 = 1e4;

/// What positions are relative to: the centre of the box around all fabrics, or where these lie too far apart for f32,
/// what the camera looks at.
fn origin(camera: &CameraTable, fabrics: &[Fabric]) -> DVec3 {
    let (low, high) = bounds(fabrics.iter().flat_map(Fabric::hull_points));
    if !(low.is_finite() && high.is_finite()) {
        return DVec3::ZERO;
    }
    let near_together = 0.5 * (high - low).length() <= NEAR_TOGETHER_MM;
    match camera.target_mm.filter(|_| !camera.fit && !near_together) {
        Some(target_mm) => DVec3::from_array(target_mm),
        None => 0.5 * (low + high),
    }
}

#[cfg(test)]
#[path = "load_tests.rs"]
mod tests;
