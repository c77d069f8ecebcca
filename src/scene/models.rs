//! Files that scenes name, read once for as many scenes as name them: what is edited is not read again.

use super::light::AmbientTable;
use crate::io::environment::read_environment;
use crate::io::error::FileError;
use crate::io::picture::LinearImage;
use crate::io::yarn_file::{Loaded, load_yarn_file};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

/// What was read of a file that was last changed then, where the system says it.
type Read<T> = HashMap<PathBuf, (Option<SystemTime>, Arc<T>)>;

/// Yarns and environments that were read.
#[derive(Debug, Default)]
pub struct Models {
    yarns: Read<Loaded>,
    environments: Read<LinearImage>,
}

impl Models {
    /// The yarn file at `path`.
    ///
    /// # Errors
    /// As [`load_yarn_file`].
    pub fn yarns(&mut self, path: &Path) -> Result<Arc<Loaded>, FileError> {
        read_once(&mut self.yarns, path, load_yarn_file)
    }

    /// The picture of the light from everywhere, where one gives light; `folder` is what its path is relative to.
    ///
    /// # Errors
    /// As [`read_environment`].
    pub fn environment(
        &mut self,
        ambient: &AmbientTable,
        folder: &Path,
    ) -> Result<Option<Arc<LinearImage>>, FileError> {
        let of = |picture: &str| read_once(&mut self.environments, &folder.join(picture), read_environment);
        ambient.picture().map(of).transpose()
    }
}

/// What `read` makes of the file, unless it was read before and has not changed since.
fn read_once<T>(
    files: &mut Read<T>,
    path: &Path,
    read: impl Fn(&Path) -> Result<T, FileError>,
) -> Result<Arc<T>, FileError> {
    let changed = std::fs::metadata(path).and_then(|data| data.modified()).ok();
    if let Some((when, found)) = files.get(path)
        && changed.is_some()
        && *when == changed
    {
        return Ok(found.clone());
    }
    let found = Arc::new(read(path)?);
    files.insert(path.to_owned(), (changed, found.clone()));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_file_is_read_again_only_where_it_changed() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let mut files = Read::<String>::new();
        let text = |path: &Path| Ok(std::fs::read_to_string(path).unwrap());
        let mut now = |written: Option<&str>| {
            if let Some(written) = written {
                std::fs::write(file.path(), written).unwrap();
                // Faster than some systems' clocks for files.
                let later = SystemTime::now() + Duration::from_secs(written.len() as u64);
                file.as_file().set_modified(later).unwrap();
            }
            read_once(&mut files, file.path(), text).unwrap()
        };
        let first = now(Some("one"));
        assert!(Arc::ptr_eq(&first, &now(None)));
        assert_eq!((first.as_str(), now(Some("three")).as_str()), ("one", "three"));
        let gone = Path::new("/nowhere/at/all");
        let missing = |path: &Path| load_yarn_file(path).map(|_| String::new());
        assert!(read_once(&mut files, gone, missing).is_err());
    }
}
