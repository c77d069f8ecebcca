//! The measured front of a device, kept for `worsted render --max-error` and `--max-ms`: one file in the cache.

use super::report::{Cell, Report};
use super::settings::Setting;
use crate::error::Error;
use crate::io::cache::Cache;
use crate::io::error::{FileError, Place};
use crate::io::whole::write_whole;
use crate::math::digest::Digest;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};

/// The cache's part for fronts.
const PART: &str = "fronts";

/// What was measured on one device.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fronts {
    /// Device name.
    pub device: String,
    /// Driver and version.
    pub driver: String,
    /// Every way that was measured, of every scene.
    pub entries: Vec<Entry>,
}

/// One picture of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// What the scene looks like, as [`look`] says, in hexadecimal.
    pub look: String,
    /// What a reader knows the scene by.
    pub model: String,
    /// The view's name.
    pub view: String,
    /// Width in pixels of a fiber at what the camera looks at.
    pub fiber_px: f64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The way it was drawn.
    pub setting: Setting,
    /// Mean FLIP over covered pixels.
    pub flip: f64,
    /// Mean FLIP by noise alone of a perfect picture of as many samples.
    pub floor_flip: Option<f64>,
    /// Longest wall time, ms.
    pub wall_ms: f64,
    /// [`super::work::work`] of the scene.
    pub work: f64,
    /// When it was measured, UTC.
    pub date: String,
}

/// What a scene's error depends on, apart from where it is looked at from: yarn, fibers, light and shading.
pub fn look(scene: &Scene) -> String {
    let mut digest = Digest(4);
    let file = &scene.file;
    for fabric in &scene.fabrics {
        digest.text(&format!("{:?} {:?}", fabric.yarn, fabric.fiber));
    }
    digest.text(&format!("{:?} {:?} {:?}", file.light(), file.ambient, file.shading));
    format!("{:016x}", digest.0)
}

impl Fronts {
    /// What was measured on this device; nothing where no file is there.
    ///
    /// # Errors
    /// A file that cannot be read or is none.
    pub fn read(cache: &Cache, device: &str, driver: &str) -> Result<Self, Error> {
        let path = cache.path(PART, &name(device, driver));
        let bytes = match std::fs::read(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self { device: device.into(), driver: driver.into(), entries: Vec::new() });
            }
            read => read.map_err(|e| FileError::io(&path, "read", &e))?,
        };
        let found: Self = serde_json::from_slice(&bytes).map_err(|e| {
            let message = format!("expected what `worsted bench` keeps of a device: {e}; remove it");
            FileError::new(&path, Place::File, message.replace('\n', " "))
        })?;
        Ok(found)
    }

    /// Takes in a report of the scene that looks like `look`, in place of what was measured of the same before.
    pub fn add(&mut self, report: &Report, look: &str) {
        let size = report.head.size;
        self.entries.retain(|old| {
            let again = report.cells.iter().any(|cell| cell.view == old.view && cell.setting == old.setting);
            !(again && old.look == look && old.model == report.head.model && old.size == size)
        });
        let entry = |cell: &Cell| {
            let view = report.views.iter().find(|view| view.name == cell.view)?;
            Some(Entry {
                look: look.to_owned(),
                model: report.head.model.clone(),
                view: cell.view.clone(),
                fiber_px: view.fiber_px,
                size,
                setting: cell.setting.clone(),
                flip: cell.flip,
                floor_flip: cell.floor_flip,
                wall_ms: cell.wall_ms.max,
                work: cell.work,
                date: report.head.date.clone(),
            })
        };
        self.entries.extend(report.cells.iter().filter_map(entry));
    }

    /// Writes it, all or nothing.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&self, cache: &Cache) -> Result<(), Error> {
        let text = serde_json::to_string_pretty(self).map_err(|e| Error::Failed(format!("front: {e}")))?;
        let path = cache.file(PART, &name(&self.device, &self.driver))?;
        Ok(write_whole(&path, |out| writeln!(out, "{text}"))?)
    }
}

fn name(device: &str, driver: &str) -> String {
    let mut digest = Digest(5);
    digest.text(device);
    digest.text(driver);
    format!("{:016x}.json", digest.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::cloth::{Cloth, Model};
    use crate::bench::report::sample;

    #[test]
    fn what_is_measured_again_takes_the_old_ones_place() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(Some(folder.path())).unwrap();
        let mut fronts = Fronts::read(&cache, "a device", "a driver").unwrap();
        assert!(fronts.entries.is_empty());
        let mut report = sample();
        fronts.add(&report, "look");
        report.cells[0].flip = 0.7;
        fronts.add(&report, "look");
        assert_eq!(fronts.entries.len(), 3);
        assert!(fronts.entries.iter().any(|entry| entry.flip == 0.7 && entry.wall_ms == 105.0));
        fronts.add(&report, "another");
        assert_eq!(fronts.entries.len(), 6);
        fronts.write(&cache).unwrap();
        assert_eq!(Fronts::read(&cache, "a device", "a driver").unwrap(), fronts);
        assert!(Fronts::read(&cache, "a device", "a newer driver").unwrap().entries.is_empty());
        std::fs::write(cache.path(PART, &name("a device", "a driver")), "{").unwrap();
        let error = Fronts::read(&cache, "a device", "a driver").unwrap_err();
        assert!(error.exit_code() == 2 && !error.to_string().contains('\n'), "{error}");
    }

    #[test]
    fn yarn_light_and_shading_make_the_look_and_the_camera_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let cloth = Cloth::Stockinette { wales: 2, courses: 2 };
        let model = Model::write(folder.path(), "worsted_3ply", cloth, Default::default()).unwrap();
        let of = |set: &str| look(&Scene::load(&model.path, &[set.to_owned()]).unwrap());
        let usual = of("seed=0");
        for set in ["camera.yaw_deg=7", "quality.culling=false", "shadow.map=false", "seed=3"] {
            assert_eq!(of(set), usual, "{set}");
        }
        for set in ["yarn.preset=rayon1", "fiber.c_r=[0.2, 0.2, 0.2]", "light=[]", "shading.diffuse=false"] {
            assert_ne!(of(set), usual, "{set}");
        }
    }
}
