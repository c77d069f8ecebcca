//! From a path to a scene.

use super::file::{FabricTable, LightTable, SceneFile};
use super::keys::{KeyError, line_at};
use super::yarn_table::check_yarns;
use super::{Fabric, Scene, SceneError, overrides};
use crate::io::error::{FileError, Place};
use crate::io::yarn_file::Loaded;
use crate::knit::params::KnitParams;
use crate::knit::stockinette::stockinette;
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

    /// Checks what the types cannot, but for yarn tables.
    fn validate(&self) -> Result<(), KeyError> {
        let lights = self.light();
        if lights.len() > 1 {
            return Err(KeyError::new(
                "light",
                format!(": expected at most 1 [[light]], found {}", lights.len()),
            ));
        }
        let rgb = |key: &str, rgb: [f64; 3], most: f64| {
            let good = rgb.iter().all(|c| (0.0..=most).contains(c));
            good.then_some(())
                .ok_or_else(|| KeyError::new(key, format!(" = {rgb:?}: allowed is 0 to {most} each")))
        };
        let range = KeyError::range;
        for light in &lights {
            rgb("light.irradiance", light.irradiance, 1e6)?;
            let direction = DVec3::from_array(light.direction);
            if !direction.is_finite() || direction.length() < 1e-9 {
                let message = format!(" = {:?}: allowed is any vector but 0", light.direction);
                return Err(KeyError::new("light.direction", message));
            }
        }
        for fabric in &self.fabric {
            range("fabric.mm_per_unit", fabric.mm_per_unit.unwrap_or(1.0), 1e-9, 1e9)?;
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
        range("quality.lod_threshold_samples", self.quality.lod_threshold_samples, 0.01, 1e4)?;
        range("quality.thin_fiber_samples", self.quality.thin_fiber_samples, 0.01, 10.0)?;
        range("quality.core_visible_share", self.quality.core_visible_share, 0.0, 1.0)?;
        let rows = self.quality.core_texture_rows;
        if !(8..=512).contains(&rows) || !rows.is_power_of_two() {
            let message = format!(" = {rows}: allowed is a power of two from 8 to 512");
            return Err(KeyError::new("quality.core_texture_rows", message));
        }
        range("quality.max_subdivisions", f64::from(self.quality.max_subdivisions), 1.0, 64.0)?;
        range("quality.patches_per_draw", f64::from(self.quality.patches_per_draw.unwrap_or(1)), 1.0, 1e9)
    }

    /// Checks everything that does not need the yarn files. The error comes with the paths at which its
    /// key may stand, the likeliest first.
    fn check(&self) -> Result<(), (KeyError, Vec<String>)> {
        self.validate().map_err(|error| {
            // A fiber's look may stand in the scene or in a fabric.
            let paths = vec![error.path.clone(), format!("fabric.{}", error.path)];
            (error, paths)
        })?;
        check_yarns(self)
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
        let mut file: SceneFile = table.try_into().map_err(|e| value(KeyError::from_toml(&e).to_string()))?;
        if !is_scene {
            let model = path.to_str().ok_or_else(|| value("expected a UTF-8 path".into()))?.to_owned();
            match file.fabric.first_mut() {
                Some(fabric) => fabric.model = model,
                None => file.fabric.push(FabricTable { model, ..Default::default() }),
            }
        }
        file.check().map_err(|(error, _)| value(error.to_string()))?;
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
    pub fn stockinette(mut file: SceneFile, knit: &KnitParams) -> Result<Self, SceneError> {
        let name = "generated stockinette";
        let value = |(error, _): (KeyError, _)| SceneError::Value {
            scene: name.to_owned(),
            message: error.to_string(),
        };
        file.check().map_err(value)?;
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
            ("[camera]\nyaw_dge = 3\n", &[], "line 2: unknown field `yaw_dge`, expected one of `yaw_deg`"),
            ("[camera]\nyaw_dge = 3\n", &[], "; did you mean `yaw_deg`?"),
            ("[camera]\n\nfov_y_deg = 500\n", &[], "line 3: camera.fov_y_deg = 500: allowed is 1 to 170"),
            ("[fabric.fiber]\ndiffuse = [2, 0, 0]\n", &[], "line 2: fiber.diffuse = [2.0, 0.0, 0.0]"),
            ("[camera]\nyaw_deg = '3'\n", &[], "line 2: invalid type"),
            (
                "[yarn]\npreset = 'silk1'\nply_cuont = 3\n",
                &[],
                "line 3: yarn.ply_cuont: unknown key; did you mean `ply_count`?",
            ),
            (
                "[yarn]\npreset = 'silk_1'\n",
                &[],
                "line 2: yarn.preset = \"silk_1\": no such preset; did you mean `silk1`?",
            ),
            ("[yarn]\nply_count = 'two'\n", &[], "line 2: yarn.ply_count = \"two\": expected a whole number"),
            ("[yarn]\nmigration_min = 1\nmigration_max = 0.5\n", &[], "line 3: yarn.migration_max = 0.5"),
            (
                "[yarn]\nmigration_max = 0.1\n",
                &[],
                "line 2: yarn.migration_max = 0.1: allowed is at least migration_min",
            ),
            (
                "seed = 1\n[yarn]\nfibers_per_ply = 2000\n[fabric]\n[fabric.yarn]\nply_count = 0\n",
                &[],
                "line 6: yarn.ply_count = 0",
            ),
            (
                "[[fabric]]\n[[fabric]]\nyarn = {hair_tapir = 1}\n",
                &[],
                "line 3: yarn.hair_tapir: unknown key; did you mean `hair_taper`?",
            ),
            ("yarn = 3\n", &[], "line 1: invalid type"),
            ("[fabric]\nmodel = 'none.bcc'\n", &[], "none.bcc"),
            ("", &[], "expected a [fabric]"),
            (GOOD, &["camera.fov_y_deg=500"], "camera.fov_y_deg = 500: allowed is 1 to 170"),
            (GOOD, &["yarn.density_beta=-1"], "yarn.density_beta = -1"),
            (GOOD, &["yarn.preset=wool"], "worsted_3ply"),
            (GOOD, &["yarn.ply_cuont=2"], "yarn.ply_cuont: unknown key; did you mean `ply_count`?"),
            (
                GOOD,
                &["fabric.yarn.ply_count=nan"],
                "yarn.ply_count = NaN: expected a whole number, allowed is 1 to 8",
            ),
            (GOOD, &["yarn=3"], "yarn: invalid type: integer `3`"),
            (GOOD, &["camera.yaw_deg=left"], "camera.yaw_deg: invalid type: string \"left\""),
            (GOOD, &["camera.yaw_dge=1"], "did you mean `yaw_deg`?"),
            (GOOD, &["shading.model=simpel"], "did you mean `simple`?"),
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
