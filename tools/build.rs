//! Compiles every shader under `glsl/` to SPIR-V and embeds the words: see `src/shaders.rs`. Hashes the code that bakes
//! tables: see `src/precompute/stored.rs`.

#[path = "../src/shaders/glsl.rs"]
mod glsl;

use std::collections::hash_map::DefaultHasher;
use std::fmt::Write;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

/// What decides the SPIR-V.
const OF_SHADERS: &[&str] = &["glsl", "tools/build.rs", "src/shaders/glsl.rs", "Cargo.lock"];
/// What decides baked tables: `precompute` and all it may import.
const OF_BAKERS: &[&str] = &["src/precompute", "src/bsdf", "src/io", "src/math", "src/yarn", "Cargo.lock"];

fn main() {
    for path in OF_SHADERS.iter().chain(OF_BAKERS) {
        println!("cargo::rerun-if-changed={path}");
    }
    let target = std::env::var("TARGET").expect("cargo sets TARGET");
    println!("cargo::rustc-env=WORSTED_BAKERS={:016x}-{target}", hash_of(OF_BAKERS));

    // Compiling takes longer than all else: only where something has changed.
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let (table, stamp) = (out.join("shaders.rs"), out.join("shaders.stamp"));
    let of_shaders = hash_of(OF_SHADERS).to_string();
    if !table.exists() || std::fs::read_to_string(&stamp).ok().as_ref() != Some(&of_shaders) {
        std::fs::write(table, shaders()).expect("OUT_DIR is writable");
        std::fs::write(stamp, of_shaders).expect("OUT_DIR is writable");
    }
}

/// Of all files at and below these paths, their names included.
fn hash_of(paths: &[&str]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for path in paths.iter().map(Path::new) {
        let mut files = Vec::new();
        if path.is_dir() {
            collect(path, &mut files);
        } else {
            files.push(path.to_owned());
        }
        files.sort();
        for file in files {
            // A file that is not there (a library has no lock file) is like an empty one.
            (glsl::slashed(&file), std::fs::read(&file).unwrap_or_default()).hash(&mut hasher);
        }
    }
    hasher.finish()
}

/// The text of the table of all shaders.
fn shaders() -> String {
    let root = PathBuf::from("glsl");
    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let mut table = String::from("/// Every compiled shader: path under `glsl/`, SPIR-V words.\n");
    table.push_str("pub(crate) static ALL: &[(&str, &[u32])] = &[\n");
    for file in &files {
        let name = glsl::slashed(file.strip_prefix(&root).expect("collected under the root"));
        let Some(stage) = glsl::stage_of(&name) else { continue };
        let words = glsl::compile(&name, stage, &|path| {
            std::fs::read_to_string(root.join(path)).map_err(|e| e.to_string())
        });
        let words = words.unwrap_or_else(|error| {
            eprintln!("glsl/{error}");
            std::process::exit(1);
        });
        writeln!(table, "    ({name:?}, &{words:?}),").expect("writing to a string");
    }
    table.push_str("];\n");
    table
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the folder is readable") {
        let path = entry.expect("the folder is readable").path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            files.push(path);
        }
    }
}
