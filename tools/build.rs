//! Compiles every shader under `glsl/` to SPIR-V and embeds the words: see `src/shaders.rs`.

mod glsl;

use std::fmt::Write;
use std::path::{Path, PathBuf};

fn main() {
    let root = PathBuf::from("glsl");
    println!("cargo::rerun-if-changed=glsl");
    println!("cargo::rerun-if-changed=tools/build.rs");
    println!("cargo::rerun-if-changed=tools/glsl.rs");

    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let mut table = String::from("/// Every compiled shader: path under `glsl/`, SPIR-V words.\n");
    table.push_str("pub(crate) static ALL: &[(&str, &[u32])] = &[\n");
    for file in &files {
        let name = glsl::slashed(file.strip_prefix(&root).expect("collected under the root"));
        let Some(stage) = glsl::stage_of(&name) else { continue };
        let words = glsl::compile(&name, stage, &|path| std::fs::read_to_string(root.join(path)).ok());
        let words = words.unwrap_or_else(|error| {
            eprintln!("glsl/{error}");
            std::process::exit(1);
        });
        writeln!(table, "    ({name:?}, &{words:?}),").expect("writing to a string");
    }
    table.push_str("];\n");
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    std::fs::write(out.join("shaders.rs"), table).expect("OUT_DIR is writable");
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("glsl/ is readable") {
        let path = entry.expect("glsl/ is readable").path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            files.push(path);
        }
    }
}
