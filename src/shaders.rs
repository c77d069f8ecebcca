//! The SPIR-V of every shader under `glsl/`, compiled by `tools/build.rs` and embedded.

#[cfg(feature = "hot-reload")]
pub mod folder;
#[cfg(feature = "hot-reload")]
mod glsl;
#[cfg(feature = "hot-reload")]
mod interface;
#[cfg(feature = "hot-reload")]
mod order;

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The SPIR-V words of the shader at `path` under `glsl/` (`"passes/fibers.vert"`), or `None`.
pub fn get(path: &str) -> Option<&'static [u32]> {
    ALL.iter().find(|(name, _)| *name == path).map(|(_, words)| *words)
}

/// Every embedded shader: path under `glsl/` and SPIR-V words.
pub fn all() -> impl Iterator<Item = (&'static str, &'static [u32])> {
    ALL.iter().copied()
}

/// The shaders that pictures are drawn with: the embedded ones, with others in place of some. Clones share them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShaderSet {
    replaced: Arc<BTreeMap<String, Vec<u32>>>,
}

impl ShaderSet {
    /// The embedded shaders with these instead: path under `glsl/` and SPIR-V words. Their interfaces must be those of
    /// the shaders that they replace.
    #[doc(hidden)]
    pub fn replacing(replaced: BTreeMap<String, Vec<u32>>) -> Self {
        Self { replaced: Arc::new(replaced) }
    }

    /// Whether all are embedded.
    pub fn is_embedded(&self) -> bool {
        self.replaced.is_empty()
    }

    /// A number that differs where those of these paths that are replaced differ, in this run of the program; none where
    /// none of them is.
    pub fn digest(&self, paths: &[&str]) -> Option<u64> {
        let replaced: Vec<_> = paths.iter().filter_map(|path| self.replaced.get_key_value(*path)).collect();
        let mut hasher = DefaultHasher::new();
        replaced.hash(&mut hasher);
        (!replaced.is_empty()).then(|| hasher.finish())
    }

    /// The paths of those that are not embedded.
    pub fn replaced(&self) -> impl Iterator<Item = &str> {
        self.replaced.keys().map(String::as_str)
    }

    /// The SPIR-V words of the shader at `path` under `glsl/`, or `None`.
    pub fn get(&self, path: &str) -> Option<&[u32]> {
        self.replaced.get(path).map(Vec::as_slice).or_else(|| get(path))
    }
}
