//! The scene that is edited: its file's text as typed, what it comes to, and the way back.

mod assign;
mod files;
mod start;

use super::changes::Changes;
use super::history::History;
use super::{edit, lights, lines};
use crate::scene::SceneFile;
use crate::scene::parameters::{Parameter, find};
use glam::DVec3;
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use toml::{Table, Value};
use toml_edit::DocumentMut;

/// A scene file, or a bare yarn file, that is edited key by key. Keys have dotted paths, as in `--set`; lights and
/// fabrics are numbered (`light.0.direction`, `fabric.1.yarn.ply_count`).
pub struct Document {
    path: PathBuf,
    /// The file is a yarn file, not a scene.
    bare: bool,
    typed: DocumentMut,
    /// The same as the file has it.
    opened: DocumentMut,
    good: Good,
    history: History<DocumentMut>,
    revision: u64,
    rejected: Option<Rejected>,
    automatic: HashMap<String, Value>,
    center_mm: DVec3,
    resets: RefCell<HashMap<String, Result<Option<Value>, String>>>,
}

/// A value that was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rejected {
    /// The key's path.
    pub path: String,
    /// What was found and what is allowed, in one line.
    pub message: String,
}

/// What a text comes to.
struct Good {
    file: SceneFile,
    values: Table,
}

impl Good {
    fn of(typed: &DocumentMut) -> Result<Self, String> {
        let file = SceneFile::from_table(edit::table_of(typed)?).map_err(|e| e.to_string())?;
        let values = file.effective().map_err(|e| e.to_string())?;
        Ok(Self { file, values })
    }

    fn get(&self, path: &str) -> Option<&Value> {
        value_at(&self.values, path)
    }
}

impl Document {
    /// The file that is edited; see [`Document::is_bare`].
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What paths in the scene are relative to.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// Whether the file is a yarn file without a scene: it is never written to.
    pub fn is_bare(&self) -> bool {
        self.bare
    }

    /// Whether anything differs from the file.
    pub fn is_unsaved(&self) -> bool {
        self.typed.to_string() != self.opened.to_string()
    }

    /// The scene file's text as it would be saved here.
    pub fn text(&self) -> String {
        self.typed.to_string()
    }

    /// The scene, checked. Load it with [`crate::scene::Scene::from_file`] and [`Document::folder`].
    pub fn scene_file(&self) -> &SceneFile {
        &self.good.file
    }

    /// What differs from a scene of before.
    pub fn changes_since(&self, before: &SceneFile) -> Changes {
        Changes::between(before, &self.good.file)
    }

    /// A number that is another one after every change.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The value that was refused last, until something is changed.
    pub fn rejected(&self) -> Option<&Rejected> {
        self.rejected.as_ref()
    }

    /// What a key comes to, presets and defaults included. `None` is an optional one that is found out from the rest, or
    /// that does not apply.
    pub fn get(&self, path: &str) -> Option<Value> {
        self.good.get(path).cloned()
    }

    /// Whether the key stands in the scene file.
    pub fn is_typed(&self, path: &str) -> bool {
        edit::get(&self.typed, path).is_some()
    }

    /// What [`Document::get`] would say after [`Document::reset`].
    ///
    /// # Errors
    /// One line on why the key cannot be taken away.
    pub fn reset_value(&self, path: &str) -> Result<Option<Value>, String> {
        if !self.is_typed(path) {
            return Ok(self.get(path));
        }
        let work_out = || {
            let mut candidate = self.typed.clone();
            self.take_away(&mut candidate, path)?;
            Ok(Good::of(&candidate)?.get(path).cloned())
        };
        self.resets.borrow_mut().entry(path.to_owned()).or_insert_with(work_out).clone()
    }

    /// Whether the key is as the preset, the default or, of a fabric, the scene has it.
    pub fn is_default(&self, path: &str) -> bool {
        !self.is_typed(path) || self.reset_value(path).is_ok_and(|value| value == self.get(path))
    }

    /// Sets a key. Keys that cannot stand beside it (`fiber.c_tt` and `fiber.color`; those of another kind of light) make
    /// room. Values that follow one another without [`Document::end_gesture`] are one step to undo.
    ///
    /// # Errors
    /// One line: what was found and what is allowed. The scene stays as it was.
    pub fn set(&mut self, path: &str, value: impl Into<Value>) -> Result<(), String> {
        let value = value.into();
        self.change(path, true, |document, typed| match (find(path), split_light(path)) {
            (None, _) => Err(format!("{path}: no such key")),
            (_, Some((index, "kind"))) => document.set_kind(typed, index, &value),
            (Some(row), _) => {
                if let Some(other) = excluded(row) {
                    edit::remove(typed, &sibling(path, other));
                }
                edit::set(typed, path, &value)
            }
        })
    }

    /// Ends a run of values that are one step to undo: the slider was let go.
    pub fn end_gesture(&mut self) {
        self.history.end_gesture();
    }

    /// Takes a key out of the scene file: it is as the preset, the default or, of a fabric, the scene has it.
    ///
    /// # Errors
    /// One line on why it cannot be taken away. The scene stays as it was.
    pub fn reset(&mut self, path: &str) -> Result<(), String> {
        self.change(path, false, |document, typed| document.take_away(typed, path))
    }

    /// Gives a table (`yarn`, `fiber`, `fabric.0.yarn`) a preset and takes everything else out of it.
    ///
    /// # Errors
    /// One line, about a preset that is not known. The scene stays as it was.
    pub fn choose_preset(&mut self, table: &str, name: &str) -> Result<(), String> {
        let path = format!("{table}.preset");
        self.change(&path, false, |_, typed| {
            let keys = match edit::get(typed, table).and_then(toml_edit::Item::as_table_like) {
                Some(keys) => keys.iter().map(|(key, _)| key.to_owned()).collect(),
                None => Vec::new(),
            };
            edit::set(typed, &path, &Value::String(name.to_owned()))?;
            keys.iter().filter(|key| *key != "preset").for_each(|key| {
                edit::remove(typed, &format!("{table}.{key}"));
            });
            Ok(())
        })
    }

    /// Adds a light of that kind, which shines on the center; its number is that of lights before.
    ///
    /// # Errors
    /// One line, about a kind that is not known, or too many lights.
    pub fn add_light(&mut self, kind: &str) -> Result<(), String> {
        self.change("light", false, |document, typed| {
            let known =
                lights::kind_named(kind).ok_or_else(|| format!("light.kind = {kind:?}: no such kind"))?;
            let mut keys =
                Table::try_from(lights::added(known, document.center_mm)).map_err(|e| e.to_string())?;
            keys.retain(|key, value| key != "angular_size_deg" || value.as_float() != Some(0.0));
            if typed.get("light").is_none() {
                edit::add_light(typed, &Table::new())?;
            }
            edit::add_light(typed, &keys)
        })
    }

    /// Takes a light away.
    ///
    /// # Errors
    /// One line, where there is no light of that number.
    pub fn remove_light(&mut self, index: usize) -> Result<(), String> {
        let count = self.light_count();
        self.change("light", false, |_, typed| {
            if index >= count {
                return Err(format!("light.{index}: there are {count} lights"));
            }
            edit::remove_light(typed, index);
            Ok(())
        })
    }

    /// Lights of the scene, the default one among them.
    pub fn light_count(&self) -> usize {
        self.good.values["light"].as_array().map_or(0, Vec::len)
    }

    /// Whether there is a step to undo, and one to do again.
    pub fn can_undo_redo(&self) -> [bool; 2] {
        self.history.possible()
    }

    /// Takes the last step back; says whether there was one.
    pub fn undo(&mut self) -> bool {
        self.exchange(History::undo)
    }

    /// Takes the last [`Document::undo`] back; says whether there was one.
    pub fn redo(&mut self) -> bool {
        self.exchange(History::redo)
    }

    /// `--set PATH=VALUE` that makes the file's scene have this key as it is now.
    pub fn set_line(&self, path: &str) -> String {
        lines::set_line(&self.assignment(path))
    }

    /// The same without `--set` and quotes.
    pub fn assignment(&self, path: &str) -> String {
        let [opened, typed] = self.tables();
        lines::assignment_of(path, &opened, &typed, &|path| self.get(path))
    }

    /// One `--set` for each key in which the scene differs from the file.
    pub fn set_lines(&self) -> Vec<String> {
        self.assignments().iter().map(|assignment| lines::set_line(assignment)).collect()
    }

    /// The same without `--set` and quotes, as [`crate::scene::Scene::load`] takes them.
    pub fn assignments(&self) -> Vec<String> {
        let [opened, typed] = self.tables();
        lines::assignments(&opened, &typed, &|path| self.get(path))
    }

    /// Says what a key that is absent came to (the camera's distance), for whoever sets it next.
    pub fn note_automatic(&mut self, path: &str, value: impl Into<Value>) {
        self.automatic.insert(path.to_owned(), value.into());
    }

    /// Says around what lights are placed, in mm as `camera.target_mm`.
    pub fn note_center_mm(&mut self, center_mm: DVec3) {
        self.center_mm = center_mm;
    }

    fn tables(&self) -> [Table; 2] {
        // Both were read before.
        [&self.opened, &self.typed].map(|text| edit::table_of(text).unwrap_or_default())
    }

    fn change(
        &mut self,
        path: &str,
        goes_on: bool,
        edit: impl FnOnce(&Self, &mut DocumentMut) -> Result<(), String>,
    ) -> Result<(), String> {
        let mut candidate = self.typed.clone();
        match edit(self, &mut candidate).and_then(|()| Good::of(&candidate)) {
            Ok(good) => {
                self.rejected = None;
                if candidate.to_string() != self.typed.to_string() {
                    let before = std::mem::replace(&mut self.typed, candidate);
                    self.history.record(before, goes_on.then_some(path));
                    self.good = good;
                    self.touched();
                }
                Ok(())
            }
            Err(message) => {
                let message = one_line(&message);
                self.rejected = Some(Rejected { path: path.to_owned(), message: message.clone() });
                Err(message)
            }
        }
    }

    fn exchange(
        &mut self,
        step: fn(&mut History<DocumentMut>, DocumentMut) -> Result<DocumentMut, DocumentMut>,
    ) -> bool {
        self.rejected = None;
        let Ok(then) = step(&mut self.history, self.typed.clone()) else { return false };
        // Every version that is kept was good when it was made.
        let Ok(good) = Good::of(&then) else { return false };
        (self.typed, self.good) = (then, good);
        self.touched();
        true
    }

    fn touched(&mut self) {
        self.revision += 1;
        self.resets.borrow_mut().clear();
    }

    fn take_away(&self, typed: &mut DocumentMut, path: &str) -> Result<(), String> {
        match split_light(path) {
            Some((index, "kind")) => self.set_kind(typed, index, &Value::String("directional".into()))?,
            _ => edit::remove(typed, path),
        }
        Ok(())
    }

    /// Gives a light a kind, and the keys that this one needs.
    fn set_kind(&self, typed: &mut DocumentMut, index: usize, kind: &Value) -> Result<(), String> {
        let path = |key: &str| format!("light.{index}.{key}");
        let old = self
            .good
            .file
            .light()
            .get(index)
            .cloned()
            .ok_or_else(|| format!("light.{index}: no such light"))?;
        let known = kind.as_str().and_then(lights::kind_named);
        // An unknown name is refused by who checks the scene.
        let Some(known) = known.filter(|known| *known != old.kind) else {
            return edit::set(typed, &path("kind"), kind);
        };
        let new = lights::as_kind(&old, known, self.center_mm);
        let [old, new] = [old, new].map(Table::try_from).map(Result::unwrap_or_default);
        for key in old.keys().filter(|key| !new.contains_key(*key)) {
            edit::remove(typed, &path(key));
        }
        for (key, value) in new.iter().filter(|(key, value)| old.get(*key) != Some(*value)) {
            edit::set(typed, &path(key), value)?;
        }
        Ok(())
    }
}

/// What stands at a dotted path; a number names an element of an array.
fn value_at<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    let mut steps = path.split('.');
    let first = table.get(steps.next()?);
    steps.fold(first, |value, step| match value? {
        Value::Array(items) => items.get(step.parse::<usize>().ok()?),
        value => value.get(step),
    })
}

/// The number and the key of `light.0.kind`.
fn split_light(path: &str) -> Option<(usize, &str)> {
    let (index, key) = path.strip_prefix("light.")?.split_once('.')?;
    Some((index.parse().ok()?, key))
}

/// The key that cannot stand beside this one.
fn excluded(row: &Parameter) -> Option<&'static str> {
    match (row.table, row.key) {
        ("fiber", "color") => Some("c_tt"),
        ("fiber", "c_tt") => Some("color"),
        ("ambient", "environment") => Some("radiance"),
        ("ambient", "radiance") => Some("environment"),
        _ => None,
    }
}

/// Another key of the same table.
fn sibling(path: &str, key: &str) -> String {
    path.rsplit_once('.').map_or_else(|| key.to_owned(), |(table, _)| format!("{table}.{key}"))
}

fn one_line(message: &str) -> String {
    message.lines().next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests;
