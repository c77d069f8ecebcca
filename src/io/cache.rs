//! The folder in which what took long is kept from one run to the next.

use super::error::FileError;
use etcetera::BaseStrategy;
use std::path::{Path, PathBuf};

/// Names the folder where no option does.
pub const CACHE_VARIABLE: &str = "WORSTED_CACHE";

/// The cache's folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// The folder given, or that of `WORSTED_CACHE`, or `worsted` in the user's cache folder.
    ///
    /// # Errors
    /// A user without a home.
    pub fn new(given: Option<&Path>) -> Result<Self, String> {
        let variable = || std::env::var_os(CACHE_VARIABLE).filter(|value| !value.is_empty());
        if let Some(folder) = given.map(Path::to_owned).or_else(|| variable().map(PathBuf::from)) {
            return Ok(Self { folder });
        }
        let strategy = etcetera::choose_base_strategy()
            .map_err(|e| format!("no cache folder ({e}): name one with --cache or {CACHE_VARIABLE}"))?;
        Ok(Self { folder: strategy.cache_dir().join("worsted") })
    }

    /// Where the file of this name in this part of the cache is; the folder is made.
    ///
    /// # Errors
    /// What the file system says.
    pub fn file(&self, part: &str, name: &str) -> Result<PathBuf, FileError> {
        let folder = self.folder.join(part);
        std::fs::create_dir_all(&folder).map_err(|e| FileError::io(&folder, "make", &e))?;
        Ok(folder.join(name))
    }

    /// The same without making anything.
    pub fn path(&self, part: &str, name: &str) -> PathBuf {
        self.folder.join(part).join(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_given_is_used_and_made_only_to_write() {
        let home = tempfile::tempdir().unwrap();
        let cache = Cache::new(Some(&home.path().join("deep/cache"))).unwrap();
        let path = cache.path("references", "a.exr");
        assert!(path.starts_with(home.path()) && !home.path().join("deep").exists());
        assert_eq!(cache.file("references", "a.exr").unwrap(), path);
        assert!(path.parent().is_some_and(Path::is_dir));
    }
}
