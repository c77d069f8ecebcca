//! The SPIR-V of every shader under `glsl/`, compiled by `tools/build.rs` and embedded.

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The SPIR-V words of the shader at `path` under `glsl/` (`"passes/fibers.vert"`), or `None`.
pub fn get(path: &str) -> Option<&'static [u32]> {
    ALL.iter().find(|(name, _)| *name == path).map(|(_, words)| *words)
}

/// Every embedded shader: path under `glsl/` and SPIR-V words.
pub fn all() -> impl Iterator<Item = (&'static str, &'static [u32])> {
    ALL.iter().copied()
}
