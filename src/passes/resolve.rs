//! Adds a jittered frame to the picture.

use super::spirv;
use super::targets::Targets;
use crate::graph::{Pass, Use};
use crate::vulkan::{
    Binding, ComputePipelineInfo, DescriptorLayout, DescriptorSet, Device, ImageState, Pipeline, Resource,
    SpecializationConstants, VulkanError, vk,
};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// Push constants of `glsl/passes/resolve.comp`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Constants {
    weight: f32,
    first: u32,
}

/// The pass's pipeline, bound to one set of targets.
pub struct ResolvePass {
    pipeline: Pipeline,
    set: DescriptorSet,
}

impl ResolvePass {
    /// Builds the pass.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Arc<Device>, targets: &Targets) -> Result<Self, VulkanError> {
        let image = |binding| Binding {
            binding,
            kind: vk::DescriptorType::STORAGE_IMAGE,
            stages: vk::ShaderStageFlags::COMPUTE,
        };
        let layout = DescriptorLayout::new(device, "resolve", &[image(0), image(1)])?;
        let info = ComputePipelineInfo {
            name: "resolve",
            spirv: spirv("passes/resolve.comp")?,
            constants: &SpecializationConstants::new(),
            set_layouts: &[&layout],
            push_constant_bytes: size_of::<Constants>() as u32,
            cache: None,
        };
        let pipeline = Pipeline::compute(device, &info)?;
        let resources =
            [(0, Resource::StorageImage(targets.frame.view())), (1, Resource::StorageImage(targets.picture.view()))];
        let set = DescriptorSet::new(&layout, "resolve", &resources)?;
        Ok(Self { pipeline, set })
    }

    /// Adds frame `index` of `count` equally weighted ones; the first replaces what was there.
    pub fn pass<'a>(&'a self, targets: &'a Targets, index: usize, count: usize) -> Pass<'a> {
        let constants = Constants { weight: 1.0 / count as f32, first: (index == 0).into() };
        Pass {
            name: "resolve",
            uses: vec![
                Use::Image(&targets.frame, ImageState::STORAGE_COMPUTE),
                Use::Image(&targets.picture, ImageState::STORAGE_COMPUTE),
            ],
            record: Box::new(move |commands| {
                commands.bind_pipeline(&self.pipeline);
                commands.bind_sets(&self.pipeline, &[&self.set]);
                commands.push_constants(&self.pipeline, &constants)?;
                commands.dispatch(targets.groups());
                Ok(())
            }),
        }
    }
}
