//! From a path to a scene.

use super::fiber_table::check_fibers;
use super::file::{CameraTable, FabricTable, SceneFile};
use super::keys::{KeyError, line_at};
use super::light::check_lights;
use super::models::Models;
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
use toml::Table;

/// Largest scene file read.
const MAX_SCENE_BYTES: u64 = 1 << 20;

impl SceneFile {
    /// Checks what the types cannot, but for yarn tables.
    fn validate(&self) -> Result<(), KeyError> {
        let (rgb, range) = (KeyError::rgb, KeyError::range);
        check_lights(&self.light())?;
        self.ambient.check()?;
        self.animation.check()?;
        for fabric in &self.fabric {
            range("fabric.mm_per_unit", fabric.mm_per_unit.unwrap_or(1.0), 1e-9, 1e9)?;
        }
        rgb("display.background", self.display.background, 1e6)?;
        range("display.exposure_stops", self.display.exposure_stops, -30.0, 30.0)?;
        range("camera.yaw_deg", self.camera.yaw_deg, -1e6, 1e6)?;
        range("camera.pitch_deg", self.camera.pitch_deg.unwrap_or(0.0), -90.0, 90.0)?;
        range("camera.fov_y_deg", self.camera.fov_y_deg, 1.0, 170.0)?;
        range("camera.distance_mm", self.camera.distance_mm.unwrap_or(1.0), 1e-3, 1e9)?;
        for c in self.camera.target_mm.unwrap_or_default() {
            range("camera.target_mm", c, -1e9, 1e9)?;
        }
        range("quality.subdivision_tolerance_px", self.quality.subdivision_tolerance_px, 1e-3, 100.0)?;
        range("quality.lod_threshold_samples", self.quality.lod_threshold_samples, 0.01, 1e4)?;
        range("quality.thin_fiber_samples", self.quality.thin_fiber_samples, 0.01, 10.0)?;
        range("quality.vertex_shaded_samples", self.quality.vertex_shaded_samples, 0.0, 1e3)?;
        range("quality.core_visible_share", self.quality.core_visible_share, 0.0, 1.0)?;
        let rows = self.quality.core_texture_rows;
        if !(8..=512).contains(&rows) || !rows.is_power_of_two() {
            let message = format!(" = {rows}: allowed is a power of two from 8 to 512");
            return Err(KeyError::new("quality.core_texture_rows", message));
        }
        range("quality.scattering_entries", f64::from(self.quality.scattering_entries), 4.0, 1024.0)?;
        range(
            "quality.self_shadow_texels",
            f64::from(self.quality.self_shadow_texels.unwrap_or(8)),
            8.0,
            512.0,
        )?;
        range(
            "quality.occlusion_texels",
            f64::from(self.quality.occlusion_texels.unwrap_or(8)),
            8.0,
            1024.0,
        )?;
        range("shading.extinction_scale", self.shading.extinction_scale, 0.0, 1e3)?;
        self.shadow.check()?;
        range("quality.max_subdivisions", f64::from(self.quality.max_subdivisions), 1.0, 64.0)?;
        // 16 bytes each: below 128 MiB.
        range("quality.points_per_buffer", f64::from(self.quality.points_per_buffer), 4.0, 8e6)?;
        range("quality.patches_per_draw", f64::from(self.quality.patches_per_draw.unwrap_or(1)), 1.0, 1e9)
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
        let mut file: SceneFile = table.try_into().map_err(|e| value(KeyError::from_toml(&e).to_string()))?;
        if !is_scene {
            let model = path.to_str().ok_or_else(|| value("expected a UTF-8 path".into()))?.to_owned();
            match file.fabric.first_mut() {
                Some(fabric) => fabric.model = model,
                None => file.fabric.push(FabricTable { model, ..Default::default() }),
            }
        }
        Self::of_file(file, &folder, &name, &mut Models::default())
    }

    /// The scene that a file says, which may never have been written: `folder` is what its paths are relative to, `name` is
    /// what errors call it. What `models` has read before is not read again.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn of_file(
        file: SceneFile,
        folder: &Path,
        name: &str,
        models: &mut Models,
    ) -> Result<Self, SceneError> {
        let value = |message: String| SceneError::Value { scene: name.to_owned(), message };
        file.check().map_err(|(error, _)| value(error.to_string()))?;
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

/// Reads a scene file and checks it as it stands, so that an error has its line.
fn read_table(path: &Path) -> Result<Table, SceneError> {
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
    Ok(toml::from_str::<Table>(&text).map_err(at_line)?)
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
