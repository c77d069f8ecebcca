//! The SPIR-V of every shader under `glsl/`, compiled by `tools/build.rs` and embedded.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The SPIR-V words of the shader at `path` under `glsl/` (`"passes/fibers.vert"`), or `None`.
pub fn get(path: &str) -> Option<&'static [u32]> {
    ALL.iter().find(|(name, _)| *name == path).map(|(_, words)| *words)
}

/// Every embedded shader: path under `glsl/` and SPIR-V words.
pub fn all() -> impl Iterator<Item = (&'static str, &'static [u32])> {
    ALL.iter().copied()
}

/// The shaders that yarn becomes fibers by: the embedded ones, with others in place of some.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct ShaderSet {
    replaced: BTreeMap<String, Vec<u32>>,
}

impl ShaderSet {
    /// Tests draw with shaders that are wrong, to see whether anybody notices: path under `glsl/` and SPIR-V words.
    #[doc(hidden)]
    pub fn replacing(replaced: BTreeMap<String, Vec<u32>>) -> Self {
        Self { replaced }
    }

    /// A number that differs for sets that differ, in this run of the program.
    pub fn digest(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.hash(&mut hasher);
        hasher.finish()
    }

    /// The SPIR-V words of the shader at `path` under `glsl/`, or `None`.
    pub fn get(&self, path: &str) -> Option<&[u32]> {
        self.replaced.get(path).map(Vec::as_slice).or_else(|| get(path))
    }
}
