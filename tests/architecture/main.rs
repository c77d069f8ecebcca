//! House rules that the compiler does not check.

mod files;
mod imports;

use std::path::{Path, PathBuf};

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// What cargo-fuzz leaves in its folder, which git ignores.
const LEFT_BY_FUZZING: [&str; 4] =
    ["tools/fuzz/target", "tools/fuzz/corpus", "tools/fuzz/artifacts", "tools/fuzz/Cargo.lock"];

/// The text files below a folder, with their paths from the repository's root; files that are not UTF-8 and
/// folders that do not exist hold none.
fn texts_below(folder: &str) -> Vec<(String, String)> {
    let mut folders = vec![repository().join(folder)];
    let mut texts = Vec::new();
    while let Some(folder) = folders.pop() {
        for path in entries(&folder) {
            if LEFT_BY_FUZZING.iter().any(|left| path == repository().join(left)) {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if let Ok(text) = std::fs::read_to_string(&path) {
                let relative = path.strip_prefix(repository()).expect("the walk began in the repository");
                texts.push((relative.to_string_lossy().into_owned(), text));
            }
        }
    }
    texts.sort();
    texts
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
}
