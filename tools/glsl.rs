//! Compiles GLSL to SPIR-V: for the build, and for tests that draw with shaders of their own.

use glslang::include::{IncludeHandler, IncludeResult, IncludeType};
use glslang::{
    Compiler, CompilerOptions, Shader, ShaderInput, ShaderSource, ShaderStage, SpirvVersion, Target,
    VulkanVersion,
};
use std::path::{Component, Path, PathBuf};

const NO_DEFINES: &[(&str, Option<&str>)] = &[];

/// The stage that a path's extension names; none for files that are only included.
pub fn stage_of(path: &str) -> Option<ShaderStage> {
    Some(match Path::new(path).extension()?.to_str()? {
        "vert" => ShaderStage::Vertex,
        "tesc" => ShaderStage::TesselationControl,
        "tese" => ShaderStage::TesselationEvaluation,
        "geom" => ShaderStage::Geometry,
        "frag" => ShaderStage::Fragment,
        "comp" => ShaderStage::Compute,
        _ => return None,
    })
}

/// The SPIR-V words of the shader at `path` under `glsl/`. `read` gives the text of a path there, with slashes.
///
/// # Errors
/// The compiler's complaint, behind the path.
pub fn compile(
    path: &str,
    stage: ShaderStage,
    read: &dyn Fn(&str) -> Option<String>,
) -> Result<Vec<u32>, String> {
    let failed = |error: &dyn std::fmt::Display| format!("{path}: {error}");
    let source = ShaderSource::from(read(path).ok_or_else(|| failed(&"cannot read"))?);
    let compiler = Compiler::acquire().ok_or_else(|| failed(&"the compiler does not start"))?;
    let options = CompilerOptions {
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version: SpirvVersion::SPIRV1_6 },
        ..Default::default()
    };
    let mut includes = Includes { read, main: path };
    ShaderInput::new(&source, stage, &options, Some(NO_DEFINES), Some(&mut includes))
        .and_then(|input| Shader::new(compiler, input).parse())
        .and_then(|shader| {
            let mut program = compiler.create_program();
            program.add_shader(&shader);
            program.compile(stage)
        })
        .map_err(|error| failed(&error))
}

/// Resolves `#include "..."` relative to the including file, as a C compiler would.
struct Includes<'a> {
    read: &'a dyn Fn(&str) -> Option<String>,
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
        let name = slashed(&path);
        let data = (self.read)(&name)?;
        Some(IncludeResult { name, data })
    }
}

/// A path with slashes, whatever the system's separator.
pub fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}
