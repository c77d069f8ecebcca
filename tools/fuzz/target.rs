//! What every target does: one reader over the fuzzer's bytes, which aborts where the reader breaks its word.

#[path = "readers.rs"]
pub mod readers;

use readers::{READERS, Scratch};
use std::sync::OnceLock;

/// A yarn file for scenes to name.
const YARN: &[u8] = b"v 0 0 0\nv 1 0 0\nv 2 1 0\nl 1 2 3\n";

/// Reads the bytes.
pub fn read(name: &str, bytes: &[u8]) {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(folder.path().join("yarn.obj"), YARN).expect("the temporary folder is ours");
        folder
    });
    let (_, read) = READERS.into_iter().find(|(reader, _)| *reader == name).expect("a reader of this name");
    if let Err(broken) = read(bytes, &Scratch(folder.path().to_owned())) {
        panic!("{name}: {broken}");
    }
}
