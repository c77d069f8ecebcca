//! Compiles GLSL to SPIR-V: for the build, for shaders that are edited, and for tests that draw with shaders of their own.

use glslang::error::GlslangError;
use glslang::include::{IncludeHandler, IncludeResult, IncludeType};
use glslang::{
    Compiler, CompilerOptions, Shader, ShaderInput, ShaderSource, ShaderStage, SpirvVersion, Target,
    VulkanVersion,
};
use std::path::{Component, Path, PathBuf};

const NO_DEFINES: &[(&str, Option<&str>)] = &[];
/// The compiler follows includes without end: how deep they may go, and how many one shader may have.
const DEEPEST_INCLUDE: usize = 32;
const MOST_INCLUDES: usize = 2000;

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

/// The SPIR-V words of the shader at `path` under `glsl/`. `read` gives the text of a path there, with slashes, or says
/// why there is none.
///
/// # Errors
/// All that the compiler complains of, each in a line of its own: `file:line: what is wrong`.
pub fn compile(
    path: &str,
    stage: ShaderStage,
    read: &dyn Fn(&str) -> Result<String, String>,
) -> Result<Vec<u32>, String> {
    let at_path = |why: String| format!("{path}: {why}");
    let text = read(path).and_then(without_nul).map_err(at_path)?;
    if text.lines().find(|line| !line.trim().is_empty()).is_some_and(|line| !line.is_ascii()) {
        // The crate cuts it where a character may go on.
        return Err(format!("{path}:1: expected ASCII in the first line, found other characters"));
    }
    let source = ShaderSource::from(text);
    let compiler = Compiler::acquire().ok_or_else(|| at_path("the compiler does not start".into()))?;
    let options = CompilerOptions {
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version: SpirvVersion::SPIRV1_6 },
        ..Default::default()
    };
    let mut includes = Includes { read, main: path, taken: 0, trouble: None };
    let words = ShaderInput::new(&source, stage, &options, Some(NO_DEFINES), Some(&mut includes))
        .and_then(|input| Shader::new(compiler, input).parse())
        .and_then(|shader| {
            let mut program = compiler.create_program();
            program.add_shader(&shader);
            program.compile(stage)
        });
    words.map_err(|error| {
        let complaints = complaints(path, error);
        includes.trouble.into_iter().chain(complaints).collect::<Vec<_>>().join("\n")
    })
}

/// The compiler takes a text for over where it has a zero.
fn without_nul(text: String) -> Result<String, String> {
    if text.contains('\0') { Err("expected text, found a zero byte".to_owned()) } else { Ok(text) }
}

/// What the compiler says, without what it says of itself.
fn complaints(path: &str, error: GlslangError) -> Vec<String> {
    let log = match error {
        GlslangError::PreprocessError(log)
        | GlslangError::ParseError(log)
        | GlslangError::MapIoError(log)
        | GlslangError::LinkError(log) => log.log,
        other => return vec![format!("{path}: {other}")],
    };
    let of_itself = |line: &str| {
        line.is_empty() || line.ends_with("generated.") || line.ends_with(": compilation terminated")
    };
    let told = log.lines().map(str::trim).filter(|line| !of_itself(line));
    let told: Vec<String> = told.map(|line| placed(path, line)).collect();
    if told.is_empty() { vec![format!("{path}: refused without a reason")] } else { told }
}

/// `ERROR: 0:7: what` or `ERROR: lib/a.glsl:7: what` as `file:7: what`.
fn placed(path: &str, line: &str) -> String {
    let line = ["ERROR: ", "WARNING: "].iter().find_map(|kind| line.strip_prefix(kind)).unwrap_or(line);
    let of_file = |(file, rest): (&str, &str)| -> Option<String> {
        let (number, _) = rest.split_once(':')?;
        number.parse::<u32>().ok()?;
        Some(format!("{}:{rest}", if file == "0" { path } else { file }))
    };
    line.split_once(':').and_then(of_file).unwrap_or_else(|| format!("{path}: {line}"))
}

/// Resolves `#include "..."` relative to the including file, as a C compiler would.
struct Includes<'a> {
    read: &'a dyn Fn(&str) -> Result<String, String>,
    main: &'a str,
    /// Files that were included so far.
    taken: usize,
    /// Why the first one that could not be had could not. Nothing is included after it, or what includes itself twice
    /// would be looked for as often as there are ways down to it.
    trouble: Option<String>,
}

impl IncludeHandler for Includes<'_> {
    fn include(
        &mut self,
        _: IncludeType,
        header: &str,
        includer: &str,
        depth: usize,
    ) -> Option<IncludeResult> {
        if self.trouble.is_some() {
            return None;
        }
        match self.found(header, includer, depth) {
            Ok(result) => Some(result),
            Err(why) => {
                self.trouble = Some(why);
                None
            }
        }
    }
}

impl Includes<'_> {
    fn found(&mut self, header: &str, includer: &str, depth: usize) -> Result<IncludeResult, String> {
        // glslang names the main file with an empty string.
        let includer = if includer.is_empty() { self.main } else { includer };
        let at = |why: String| format!("{includer}: `#include \"{header}\"`: {why}");
        self.taken += 1;
        if depth > DEEPEST_INCLUDE || self.taken > MOST_INCLUDES {
            return Err(at(format!(
                "expected includes that go at most {DEEPEST_INCLUDE} deep and are at most {MOST_INCLUDES}, found more: \
                 does a file include itself?"
            )));
        }
        let mut path = PathBuf::new();
        for component in Path::new(includer).parent().unwrap_or(Path::new("")).join(header).components() {
            match component {
                Component::ParentDir => {
                    path.pop();
                }
                Component::Normal(name) => path.push(name),
                Component::CurDir => (),
                Component::RootDir | Component::Prefix(_) => {
                    return Err(at("expected a path relative to the including file".to_owned()));
                }
            }
        }
        let name = slashed(&path);
        let data = (self.read)(&name).and_then(without_nul).map_err(at)?;
        Ok(IncludeResult { name, data })
    }
}

/// A path with slashes, whatever the system's separator.
pub fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}
