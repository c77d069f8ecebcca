//! `--set` for a document.

use super::{Document, Good, edit, one_line, value_at};
use crate::scene::overrides;
use toml::Value;
use toml_edit::DocumentMut;

impl Document {
    /// Does what `--set` with this assignment does; not a step to undo.
    ///
    /// # Errors
    /// One line, as of `--set`.
    pub fn assign(&mut self, assignment: &str) -> Result<(), String> {
        let mut table = edit::table_of(&self.typed)?;
        overrides::apply(&mut table, assignment)?;
        let candidate = self.with_value_of(&table, assignment);
        // A table that is left empty means as much as none.
        let as_good = |typed: &DocumentMut| {
            edit::table_of(typed)
                .is_ok_and(|found| found == table || without_empty(&found) == without_empty(&table))
        };
        let candidate = match candidate.filter(as_good) {
            Some(candidate) => candidate,
            // Comments are lost where a whole table is set.
            None => {
                let text = toml::to_string(&table).map_err(|e| e.to_string())?;
                text.parse::<DocumentMut>().map_err(|e| one_line(e.message()))?
            }
        };
        self.good = Good::of(&candidate)?;
        self.typed = candidate;
        self.touched();
        Ok(())
    }

    /// The text with the value that the assignment gave its key, where that is a single one.
    fn with_value_of(&self, table: &toml::Table, assignment: &str) -> Option<DocumentMut> {
        let path = assignment.split_once('=')?.0.trim();
        let mut typed = self.typed.clone();
        match value_at(table, path) {
            Some(value) => edit::set(&mut typed, path, value).ok()?,
            None => edit::remove(&mut typed, path),
        }
        Some(typed)
    }
}

/// The same without tables that hold nothing.
fn without_empty(table: &toml::Table) -> toml::Table {
    let holds = |(_, value): &(&String, &Value)| value.as_table().is_none_or(|inner| !inner.is_empty());
    table.iter().filter(holds).map(|(key, value)| (key.clone(), value.clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assignments_keep_comments_where_they_can_and_never_the_wrong_value() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        std::fs::write(&path, "[fabric]\nmodel = 'a.bcc' # mine\n[yarn]\nply_pitch_mm = 4.0\n").unwrap();
        let mut document = Document::open(&path).unwrap();
        document.assign("yarn.ply_pitch_mm=5").unwrap();
        document.assign("camera.target_mm=[1, 2, 3]").unwrap();
        document.assign("camera.fit=null").unwrap();
        document.assign("camera.target_mm=null").unwrap();
        document.assign("camera.target_mm=[1, 2, 3]").unwrap();
        assert!(document.text().contains("# mine"), "{}", document.text());
        document.assign("yarn.ply_pitch_mm=null").unwrap();
        document.assign("light=[{angular_size_deg = 2}]").unwrap();
        let file = document.scene_file();
        assert_eq!(file.yarn["ply_pitch_mm"].as_str(), Some("untwisted"));
        assert_eq!(file.light()[0].angular_size_deg, 2.0);
        assert_eq!(file.camera.target_mm, Some([1.0, 2.0, 3.0]));
        let before = document.text();
        for wrong in ["yarn.ply_count=900", "nothing", "yarn.no_such=1"] {
            assert!(document.assign(wrong).is_err_and(|why| !why.contains('\n')), "{wrong}");
        }
        assert_eq!(document.text(), before);
        assert_eq!(document.can_undo_redo(), [false, false]);
    }
}
