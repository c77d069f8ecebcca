//! Files written whole or not at all.

use super::error::FileError;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes a file under a temporary name in the same folder, then renames it.
///
/// # Errors
/// What the file system says, about `path`.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), FileError> {
    let failed = |e: &std::io::Error| FileError::io(path, "write", &without_path(e));
    let folder = folder_of(path);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".worsted-").suffix(".part");
    // A temporary file is private by default; the result gets what the user's umask grants any new file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(|e| failed(&e))?;
    let mut out = BufWriter::new(file.as_file_mut());
    write(&mut out).and_then(|()| out.flush()).map_err(|e| failed(&e))?;
    drop(out);
    file.persist(path).map_err(|e| failed(&e.error))?;
    Ok(())
}

/// Whether a file can be written at `path`, before any work is done for it.
///
/// # Errors
/// A folder that does not exist, or a path that is one.
pub fn check_target(path: &Path) -> Result<(), FileError> {
    let folder = folder_of(path);
    if !folder.is_dir() {
        let error =
            std::io::Error::new(std::io::ErrorKind::NotFound, format!("no folder {}", folder.display()));
        return Err(FileError::io(path, "write", &error));
    }
    if path.is_dir() {
        let error = std::io::Error::new(std::io::ErrorKind::IsADirectory, "it is a folder");
        return Err(FileError::io(path, "write", &error));
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The error without the temporary file's name, which would only confuse.
fn without_path(error: &std::io::Error) -> std::io::Error {
    match error.raw_os_error() {
        Some(code) => std::io::Error::from_raw_os_error(code),
        None => std::io::Error::from(error.kind()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writes_all_or_nothing_and_names_only_the_target() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_whole(&path, |out| out.write_all(b"whole")).unwrap();
        let failing = |out: &mut dyn Write| {
            out.write_all(b"half")?;
            Err(std::io::Error::from(std::io::ErrorKind::StorageFull))
        };
        let error = write_whole(&path, failing).unwrap_err().to_string();
        assert!(error.contains("a.txt") && !error.contains(".part"), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), b"whole");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing left behind");
    }

    #[test]
    fn impossible_targets_are_found_before_any_work() {
        let folder = tempfile::tempdir().unwrap();
        assert!(check_target(&folder.path().join("a.txt")).is_ok());
        let error = check_target(&folder.path().join("away/a.txt")).unwrap_err().to_string();
        assert!(error.contains("away"), "{error}");
        assert!(check_target(folder.path()).is_err());
        let error = write_whole(&folder.path().join("away/a.txt"), |_| Ok(())).unwrap_err().to_string();
        assert!(error.contains("away/a.txt") && !error.contains(".part"), "{error}");
    }
}
