//! One file per pass.

pub mod draw_plan;
pub mod fiber_sets;
pub mod fibers;
mod image_kernel;
pub mod layers;
pub mod pipelines;
pub mod resolve;
pub mod shadow_map;
pub mod strand_pipeline;
pub mod targets;
pub mod tonemap;

use crate::vulkan::VulkanError;

/// The SPIR-V of a shader that the build embeds.
fn spirv(path: &str) -> Result<&'static [u32], VulkanError> {
    found(path, crate::shaders::get(path))
}

/// The words that were looked up for `path`, if there are any.
fn found<'a>(path: &str, words: Option<&'a [u32]>) -> Result<&'a [u32], VulkanError> {
    words.ok_or_else(|| VulkanError::Misuse { what: format!("no embedded shader `{path}`") })
}
