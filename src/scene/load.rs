//! From a path to a scene.

use super::fabric::one_line;
use super::file::{FabricTable, LightTable, SceneFile};
use super::{Fabric, Scene, SceneError, overrides};
use crate::io::error::{FileError, Place};
use crate::io::yarn_file::Loaded;
use crate::knit::stockinette::{StockinetteParams, stockinette};
use glam::DVec3;
use std::path::Path;
use toml::Table;

/// Largest scene file read.
const MAX_SCENE_BYTES: u64 = 1 << 20;

impl SceneFile {
    /// The scene's lights: its own, or the default one when the key is absent.
    pub fn light(&self) -> Vec<LightTable> {
        self.light.clone().unwrap_or_else(|| vec![LightTable::default()])
    }

    /// Checks what the types cannot.
    fn validate(&self) -> Result<(), String> {
        let lights = self.light();
        if lights.len() > 1 {
            return Err(format!("light: expected at most 1 [[light]], found {}", lights.len()));
        }
        let rgb = |key: &str, rgb: [f64; 3], most: f64| {
            let good = rgb.iter().all(|c| (0.0..=most).contains(c));
            good.then_some(()).ok_or_else(|| format!("{key} = {rgb:?}: allowed is 0 to {most} each"))
        };
        let range = |key: &str, value: f64, low: f64, high: f64| {
            let good = (low..=high).contains(&value);
            good.then_some(()).ok_or_else(|| format!("{key} = {value}: allowed is {low} to {high}"))
        };
        for light in &lights {
            rgb("light.irradiance", light.irradiance, 1e6)?;
            let direction = DVec3::from_array(light.direction);
            if !direction.is_finite() || direction.length() < 1e-9 {
                return Err(format!("light.direction = {:?}: allowed is any vector but 0", light.direction));
            }
        }
        for fiber in self.fabric.iter().filter_map(|f| f.fiber.as_ref()).chain([&self.fiber]) {
            rgb("fiber.diffuse", fiber.diffuse, 1.0)?;
            rgb("fiber.specular", fiber.specular, 1e3)?;
            range("fiber.specular_width_deg", fiber.specular_width_deg, 0.5, 90.0)?;
        }
        rgb("ambient.radiance", self.ambient.radiance, 1e6)?;
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
        range("quality.max_subdivisions", f64::from(self.quality.max_subdivisions), 1.0, 64.0)?;
        range("quality.patches_per_draw", f64::from(self.quality.patches_per_draw.unwrap_or(1)), 1.0, 1e9)
    }
}

impl Scene {
    /// Loads a scene file (`.toml`) or a bare yarn file, with `--set` assignments applied.
    ///
    /// # Errors
    /// One line that names the file, the place, what was expected and found.
    pub fn load(path: &Path, assignments: &[String]) -> Result<Self, SceneError> {
        let name = path.display().to_string();
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
        let mut file: SceneFile = table.try_into().map_err(|e| value(one_line(&e)))?;
        if !is_scene {
            let model = path.to_str().ok_or_else(|| value("expected a UTF-8 path".into()))?.to_owned();
            match file.fabric.first_mut() {
                Some(fabric) => fabric.model = model,
                None => file.fabric.push(FabricTable { model, ..Default::default() }),
            }
        }
        file.validate().map_err(value)?;
        if file.fabric.is_empty() {
            return Err(value("expected a [fabric] with a model, found none".into()));
        }
        let fabrics = file
            .fabric
            .iter()
            .map(|table| Fabric::load(&file, table, &folder, &name))
            .collect::<Result<Vec<_>, _>>()?;
        let origin_mm = center(&fabrics);
        Ok(Self { file, fabrics, origin_mm })
    }

    /// A scene around generated stockinette, whatever fabric the file names; 1 unit is 1 mm.
    ///
    /// # Errors
    /// Values out of range; fabric that cannot be knitted.
    pub fn stockinette(mut file: SceneFile, knit: &StockinetteParams) -> Result<Self, SceneError> {
        let name = "generated stockinette";
        file.validate().map_err(|message| SceneError::Value { scene: name.to_owned(), message })?;
        let curves = stockinette(knit)?;
        let loaded =
            Loaded { curves, repairs: Vec::new(), notes: Vec::new(), format: "knit", kept_points: None };
        let table = FabricTable { model: name.to_owned(), mm_per_unit: Some(1.0), ..Default::default() };
        let fabric = Fabric::from_loaded(&file, &table, loaded, name)?;
        file.fabric = vec![table];
        let fabrics = vec![fabric];
        let origin_mm = center(&fabrics);
        Ok(Self { file, fabrics, origin_mm })
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
        let before = error.span().map_or(0, |span| span.start.min(text.len()));
        let line = 1 + text.as_bytes()[..before].iter().filter(|&&b| b == b'\n').count() as u64;
        FileError::new(path, Place::Line(line), one_line(&error))
    };
    toml::from_str::<SceneFile>(&text).map_err(at_line)?;
    Ok(toml::from_str::<Table>(&text).map_err(at_line)?)
}

/// Centre of the box around all fabrics.
fn center(fabrics: &[Fabric]) -> DVec3 {
    let (low, high) = fabrics
        .iter()
        .flat_map(Fabric::hull_points)
        .fold((DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY)), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    if low.is_finite() && high.is_finite() { 0.5 * (low + high) } else { DVec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(text: &str, sets: &[&str]) -> Result<Scene, SceneError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).unwrap();
        std::fs::write(folder.path().join("yarn.obj"), "v 0 0 0\nv 1 0 0\nv 2 1 0\nl 1 2 3\n").unwrap();
        Scene::load(&path, &sets.iter().map(|s| s.to_string()).collect::<Vec<_>>())
    }

    const GOOD: &str = "[fabric]\nmodel = 'yarn.obj'\nmm_per_unit = 10.0\n";

    #[test]
    fn loads_with_defaults_and_overrides() {
        let scene =
            load(GOOD, &["yarn.fibers_per_ply=7", "camera.yaw_deg=30", "ambient.radiance=[0,0,0]"]).unwrap();
        assert_eq!(scene.fabrics[0].yarn.fibers_per_ply, 7);
        assert_eq!((scene.file.camera.yaw_deg, scene.file.camera.fov_y_deg), (30.0, 35.0));
        assert_eq!(scene.fabrics[0].strands.pieces.len(), 2);
    }

    #[test]
    fn several_fabrics_and_one_are_both_understood() {
        let two =
            "[[fabric]]\nmodel = 'yarn.obj'\n[[fabric]]\nmodel = 'yarn.obj'\n[fabric.yarn]\nply_count = 2\n";
        let scene = load(two, &[]).unwrap();
        assert_eq!(scene.fabrics.iter().map(|f| f.yarn.ply_count).collect::<Vec<_>>(), [3, 2]);
    }

    #[test]
    fn bad_scenes_are_one_line_that_names_file_and_place() {
        for (text, sets, expected) in [
            ("[fabric\n", &[][..], "line 1"),
            ("[fabric]\nmodel = 'yarn.obj'\n[camera]\nyaw = 3\n", &[], "line 4: unknown field `yaw`"),
            ("[fabric]\nmodel = 'none.bcc'\n", &[], "none.bcc"),
            ("", &[], "expected a [fabric]"),
            (GOOD, &["camera.fov_y_deg=500"], "camera.fov_y_deg = 500: allowed is 1 to 170"),
            (GOOD, &["yarn.density_beta=-1"], "yarn.density_beta = -1"),
            (GOOD, &["yarn.preset=wool"], "worsted_3ply"),
            (GOOD, &["light=[{direction=[0,0,0]}]"], "light.direction"),
            (GOOD, &["fiber.diffuse=[nan,0,0]"], "fiber.diffuse"),
            (GOOD, &["fabric.mm_per_unit=0"], "mm_per_unit"),
        ] {
            let error = load(text, sets).unwrap_err().to_string();
            let named = error.contains("scene.toml") || error.contains("none.bcc");
            assert!(named && error.contains(expected) && !error.contains('\n'), "{error}");
        }
    }
}
