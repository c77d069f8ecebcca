//! The stages of a graphics pipeline: trimmed to its features, and held to what is around them.

use super::pipelines::Builder;
use crate::vulkan::{
    DescriptorLayout, Interfaces, ShaderStage, SpecializationConstants, VulkanError, trimmed, vk,
};

/// A stage, and the shader's path under `glsl/`.
pub type Stage = (vk::ShaderStageFlags, &'static str);

/// Stages in order, as they go into one pipeline.
pub struct Stages<'a> {
    constants: &'a SpecializationConstants,
    trimmed: Vec<(vk::ShaderStageFlags, Vec<u32>)>,
}

impl<'a> Stages<'a> {
    /// Trims the shaders at these paths to what `constants` leave of them.
    ///
    /// # Errors
    /// What is left reads what no layout binds or what the stage before does not write; words that are no SPIR-V.
    pub fn new(
        builder: &Builder,
        stages: &[Stage],
        constants: &'a SpecializationConstants,
        layouts: &[&DescriptorLayout],
    ) -> Result<Self, VulkanError> {
        let mut before: Option<Interfaces> = None;
        let mut all = Vec::new();
        for (stage, path) in stages {
            let words = trimmed(builder.words(path)?, constants)?;
            let interfaces = Interfaces::of(&words);
            if let Some(why) = interfaces.lacks(layouts, before.as_ref()) {
                return Err(VulkanError::misuse(format!("{path}: {why}")));
            }
            before = Some(interfaces);
            all.push((*stage, words));
        }
        Ok(Self { constants, trimmed: all })
    }

    /// For a pipeline.
    pub fn infos(&self) -> Vec<ShaderStage<'_>> {
        let stages = self.trimmed.iter();
        stages.map(|(stage, spirv)| ShaderStage { stage: *stage, spirv, constants: self.constants }).collect()
    }
}
