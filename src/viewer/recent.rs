//! The files that were opened last.

use crate::io::whole::write_whole;
use etcetera::BaseStrategy;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Most files that are remembered.
const MOST_FILES: usize = 10;

/// A list of files, kept in the user's folder of settings. What cannot be read or written is done without: the list is
/// a comfort.
#[derive(Clone, Debug)]
pub struct Recent {
    kept_in: Option<PathBuf>,
    files: Vec<PathBuf>,
}

#[derive(Default, Serialize, Deserialize)]
struct List {
    files: Vec<PathBuf>,
}

impl Recent {
    /// The user's list: `worsted/recent.toml` in the folder of settings.
    pub fn of_user() -> Self {
        let strategy = etcetera::choose_base_strategy().ok();
        match strategy.map(|strategy| strategy.config_dir().join("worsted").join("recent.toml")) {
            Some(path) => Self::kept_in(&path),
            None => Self { kept_in: None, files: Vec::new() },
        }
    }

    /// A list that is kept nowhere.
    pub fn nowhere() -> Self {
        Self { kept_in: None, files: Vec::new() }
    }

    /// The list in that file; empty where there is none.
    pub fn kept_in(path: &Path) -> Self {
        let list = std::fs::read_to_string(path).ok().and_then(|text| toml::from_str::<List>(&text).ok());
        Self { kept_in: Some(path.to_owned()), files: list.unwrap_or_default().files }
    }

    /// Files that are still there, the last opened first.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(PathBuf::as_path).filter(|path| path.is_file())
    }

    /// Puts a file in front, and keeps the list of those that are still there. Lists of other windows that were written
    /// meanwhile are not lost.
    pub fn note(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        if let Some(kept_in) = &self.kept_in {
            self.files = Self::kept_in(kept_in).files;
        }
        let others = self.files.drain(..).filter(|other| *other != path && other.is_file());
        self.files = std::iter::once(path.clone()).chain(others).take(MOST_FILES).collect();
        if let Err(error) = self.keep() {
            tracing::warn!("recent files are not kept: {error}");
        }
    }

    fn keep(&self) -> Result<(), String> {
        let Some(kept_in) = &self.kept_in else { return Ok(()) };
        let text = toml::to_string(&List { files: self.files.clone() }).map_err(|e| e.to_string())?;
        if let Some(folder) = kept_in.parent() {
            std::fs::create_dir_all(folder).map_err(|e| e.to_string())?;
        }
        write_whole(kept_in, |out| out.write_all(text.as_bytes())).map_err(|e| e.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_ten_that_are_still_there_are_kept() {
        let home = tempfile::tempdir().unwrap();
        let kept = home.path().join("settings/recent.toml");
        let file = |i: usize| home.path().join(format!("{i}.toml"));
        let mut recent = Recent::kept_in(&kept);
        assert_eq!(recent.files().count(), 0);
        for i in 0..12 {
            std::fs::write(file(i), "").unwrap();
            recent.note(&file(i));
        }
        recent.note(&file(5));
        std::fs::remove_file(file(11)).unwrap();
        let expected: Vec<_> = [5, 10, 9, 8, 7, 6, 4, 3, 2].map(file).to_vec();
        assert_eq!(recent.files().collect::<Vec<_>>(), expected);
        let mut other = Recent::kept_in(&kept);
        assert_eq!(other.files().collect::<Vec<_>>(), expected);
        other.note(&file(0));
        recent.note(&file(1));
        assert_eq!(recent.files().take(3).collect::<Vec<_>>(), [1, 0, 5].map(file));
        assert!(!std::fs::read_to_string(&kept).unwrap().contains("11.toml"), "a missing one is dropped");
        std::fs::write(&kept, "not a list").unwrap();
        assert_eq!(Recent::kept_in(&kept).files().count(), 0);
    }
}
