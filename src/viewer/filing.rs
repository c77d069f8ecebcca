//! Files of a desk: opened, dropped on it, saved, and pictures that are written.

use super::desk::Desk;
use super::document::Document;
use super::playing::Playing;
use super::scripts::screenshot;
use std::path::{Path, PathBuf};

impl Desk {
    /// Writes the picture and its scene, once nothing better follows.
    pub(super) fn take_screenshot(&mut self, path: PathBuf) {
        self.say(format!("{} follows once the picture is settled", path.display()));
        self.screenshot = Some(path);
        self.write_screenshot();
    }

    pub(super) fn write_screenshot(&mut self) {
        let Some(path) = self.screenshot.take_if(|_| self.shown.as_ref().is_some_and(|shown| shown.settled))
        else {
            return;
        };
        let written = screenshot(self, &path);
        self.say(
            written.map_or_else(|e| e.to_string(), |()| format!("wrote {} and its scene", path.display())),
        );
    }

    /// Opens another document in place of this one.
    pub fn open(&mut self, path: &Path) {
        match Document::open(path) {
            Ok(document) => {
                self.recent.note(path);
                (self.document, self.camera) = (document, None);
                self.playing = Playing::new();
                self.said = None;
            }
            Err(error) => self.say(error.to_string()),
        }
    }

    /// Takes a file that was dropped on the window: a scene, a yarn, frames for it, or a picture to compare with.
    pub fn take_file(&mut self, path: &Path, context: &egui::Context) {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if extension == "exr" {
            if let Err(error) = self.canvas.compare_with(path, context) {
                self.say(error.to_string());
            }
        } else if extension == "f32" {
            let path = std::path::absolute(path).unwrap_or_else(|_| PathBuf::from(path));
            match self.document.set("fabric.0.motion", path.to_string_lossy().into_owned()) {
                Ok(()) => self.scrub(0.0),
                Err(why) => self.say(why),
            }
        } else {
            self.open(path);
        }
    }

    /// Puts the camera as it is into the document, which is about to be kept; not a step to undo.
    pub(super) fn keep_camera(&mut self) -> Result<(), String> {
        let Some(camera) = self.camera.clone() else { return Ok(()) };
        let number = |value: Option<f64>| value.map_or("null".to_owned(), |value| format!("{value:?}"));
        let target = camera.target_mm.map_or("null".to_owned(), |target| format!("{target:?}"));
        let assignments = [
            format!("camera.fit={}", if camera.fit { "true" } else { "null" }),
            format!("camera.yaw_deg={:?}", camera.yaw_deg),
            format!("camera.pitch_deg={}", number(camera.pitch_deg)),
            format!("camera.distance_mm={}", number(camera.distance_mm)),
            format!("camera.target_mm={target}"),
        ];
        assignments.iter().try_for_each(|assignment| self.document.assign(assignment))
    }

    /// Saves the scene, as it is looked at.
    pub fn save(&mut self, path: &Path) {
        let saved = self.keep_camera().and_then(|()| self.document.save(path).map_err(|e| e.to_string()));
        match saved {
            Ok(()) => {
                self.recent.note(path);
                self.say(format!("saved {}", path.display()));
            }
            Err(why) => self.say(why),
        }
    }
}
