//! Opening and saving the scene that is edited.

use super::{Document, Good, one_line};
use crate::io::whole::{check_target, write_whole};
use crate::scene::SceneError;
use crate::scene::load::read_scene;
use crate::viewer::history::History;
use crate::viewer::save::move_paths;
use glam::DVec3;
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::Path;
use toml::Value;
use toml_edit::DocumentMut;

impl Document {
    /// Opens a scene file (`.toml`) or a bare yarn file. What its yarn files hold is not looked at.
    ///
    /// # Errors
    /// As [`crate::scene::Scene::load`].
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let failed = |message: String| SceneError::Value { scene: path.display().to_string(), message };
        let bare = !is_scene(path);
        let text = if bare { bare_scene(path).map_err(failed)? } else { read_scene(path)? };
        let typed: DocumentMut =
            text.parse().map_err(|e: toml_edit::TomlError| failed(one_line(e.message())))?;
        Ok(Self {
            path: path.to_owned(),
            bare,
            good: Good::of(&typed).map_err(failed)?,
            opened: typed.clone(),
            typed,
            history: History::new(),
            revision: 0,
            rejected: None,
            automatic: HashMap::new(),
            center_mm: DVec3::ZERO,
            resets: RefCell::default(),
        })
    }

    /// Writes the scene file, whole or not at all, and goes on with that one. Its paths lead to the same files from
    /// there. Comments and order are as they were.
    ///
    /// # Errors
    /// A name that is no scene file's; what the file system says.
    pub fn save(&mut self, path: &Path) -> Result<(), SceneError> {
        let failed = |message: String| SceneError::Value { scene: path.display().to_string(), message };
        if !is_scene(path) {
            return Err(failed("expected a scene file, whose name ends in .toml".into()));
        }
        check_target(path)?;
        let (from, to) = (self.folder().to_owned(), path.parent().unwrap_or(Path::new("")).to_owned());
        let mut moved = self.typed.clone();
        move_paths(&mut moved, &from, &to).map_err(failed)?;
        let mut history = self.history.clone();
        history.versions().try_for_each(|typed| move_paths(typed, &from, &to)).map_err(failed)?;
        let good = Good::of(&moved).map_err(failed)?;
        let text = moved.to_string();
        write_whole(path, |out| out.write_all(text.as_bytes()))?;
        self.opened = moved.clone();
        (self.path, self.bare) = (path.to_owned(), false);
        let differs = text != self.typed.to_string();
        (self.typed, self.good, self.history) = (moved, good, history);
        if differs {
            self.touched();
        }
        self.end_gesture();
        Ok(())
    }
}

fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// The scene around a yarn file.
fn bare_scene(path: &Path) -> Result<String, String> {
    std::fs::metadata(path).map_err(|e| format!("cannot read: {e}"))?;
    let name = path.file_name().and_then(|name| name.to_str()).ok_or("expected a UTF-8 path")?;
    Ok(format!("[fabric]\nmodel = {}\n", Value::String(name.to_owned())))
}
