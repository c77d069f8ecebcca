//! Compiles every shader under `glsl/` to SPIR-V and embeds the words: see `src/shaders.rs`.

use glslang::include::{IncludeHandler, IncludeResult, IncludeType};
use glslang::{
    Compiler, CompilerOptions, Shader, ShaderInput, ShaderSource, ShaderStage, SpirvVersion, Target,
    VulkanVersion,
};
use std::fmt::Write;
use std::path::{Component, Path, PathBuf};

fn main() {
    let root = PathBuf::from("glsl");
    println!("cargo::rerun-if-changed=glsl");
    println!("cargo::rerun-if-changed=tools/build.rs");

    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let mut table = String::from("/// Every compiled shader: path under `glsl/`, SPIR-V words.\n");
    table.push_str("pub(crate) static ALL: &[(&str, &[u32])] = &[\n");
    for file in &files {
        let Some(stage) = stage_of(file) else { continue };
        let name = slashed(file.strip_prefix(&root).expect("collected under the root"));
        let words = compile(file, &name, stage, &root);
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

/// The stage a file's extension names; none for files that are only included.
fn stage_of(file: &Path) -> Option<ShaderStage> {
    Some(match file.extension()?.to_str()? {
        "vert" => ShaderStage::Vertex,
        "tesc" => ShaderStage::TesselationControl,
        "tese" => ShaderStage::TesselationEvaluation,
        "geom" => ShaderStage::Geometry,
        "frag" => ShaderStage::Fragment,
        "comp" => ShaderStage::Compute,
        _ => return None,
    })
}

fn compile(file: &Path, name: &str, stage: ShaderStage, root: &Path) -> Vec<u32> {
    let source = std::fs::read_to_string(file).expect("glsl/ is readable");
    let mut includes = Includes { root, main: name };
    let compiler = Compiler::acquire().expect("glslang initialises");
    let options = CompilerOptions {
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version: SpirvVersion::SPIRV1_6 },
        ..Default::default()
    };
    let shader_source = ShaderSource::from(source);
    let words = ShaderInput::new(&shader_source, stage, &options, Some(NO_DEFINES), Some(&mut includes))
        .and_then(|input| Shader::new(compiler, input).parse())
        .and_then(|shader| {
            let mut program = compiler.create_program();
            program.add_shader(&shader);
            program.compile(stage)
        });
    match words {
        Ok(words) => words,
        Err(error) => {
            eprintln!("glsl/{name}: {error}");
            std::process::exit(1);
        }
    }
}

const NO_DEFINES: &[(&str, Option<&str>)] = &[];

/// Resolves `#include "..."` relative to the including file, as a C compiler would.
struct Includes<'a> {
    root: &'a Path,
    main: &'a str,
}

impl IncludeHandler for Includes<'_> {
    fn include(&mut self, _: IncludeType, header: &str, includer: &str, _: usize) -> Option<IncludeResult> {
        // glslang names the main file with an empty string.
        let from = Path::new(if includer.is_empty() { self.main } else { includer });
        let mut path = PathBuf::new();
        for component in from.parent()?.join(header).components() {
            match component {
                Component::ParentDir => {
                    path.pop();
                }
                other => path.push(other),
            }
        }
        let data = std::fs::read_to_string(self.root.join(&path)).ok()?;
        Some(IncludeResult { name: slashed(&path), data })
    }
}

fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}
