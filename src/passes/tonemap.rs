//! From linear radiance to what a display shows.

use super::spirv;
use super::targets::Targets;
use crate::graph::{Pass, Use};
use crate::scene::file::DisplayTable;
use crate::vulkan::{
    Binding, ComputePipelineInfo, DescriptorLayout, DescriptorSet, Device, ImageState, Pipeline, Resource,
    SpecializationConstants, VulkanError, vk,
};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// Push constants of `glsl/passes/tonemap.comp`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Constants {
    background: [f32; 3],
    exposure_scale: f32,
}

/// The pass's pipeline, bound to one set of targets.
pub struct TonemapPass {
    pipeline: Pipeline,
    set: DescriptorSet,
    constants: Constants,
}

impl TonemapPass {
    /// Builds the pass.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Arc<Device>, targets: &Targets, display: &DisplayTable) -> Result<Self, VulkanError> {
        let image = |binding| Binding {
            binding,
            kind: vk::DescriptorType::STORAGE_IMAGE,
            stages: vk::ShaderStageFlags::COMPUTE,
        };
        let layout = DescriptorLayout::new(device, "tonemap", &[image(0), image(1)])?;
        let info = ComputePipelineInfo {
            name: "tonemap",
            spirv: spirv("passes/tonemap.comp")?,
            constants: &SpecializationConstants::new(),
            set_layouts: &[&layout],
            push_constant_bytes: size_of::<Constants>() as u32,
            cache: None,
        };
        let pipeline = Pipeline::compute(device, &info)?;
        let resources = [
            (0, Resource::StorageImage(targets.picture.view())),
            (1, Resource::StorageImage(targets.display.view())),
        ];
        let set = DescriptorSet::new(&layout, "tonemap", &resources)?;
        let constants = Constants {
            background: display.background.map(|c| c as f32),
            exposure_scale: display.exposure_stops.exp2() as f32,
        };
        Ok(Self { pipeline, set, constants })
    }

    /// Fills the display image from the picture.
    pub fn pass<'a>(&'a self, targets: &'a Targets) -> Pass<'a> {
        Pass {
            name: "tonemap",
            uses: vec![
                Use::Image(&targets.picture, ImageState::STORAGE_COMPUTE),
                Use::Discard(&targets.display, ImageState::STORAGE_COMPUTE),
            ],
            record: Box::new(|commands| {
                commands.bind_pipeline(&self.pipeline);
                commands.bind_sets(&self.pipeline, &[&self.set]);
                commands.push_constants(&self.pipeline, &self.constants)?;
                commands.dispatch(targets.groups());
                Ok(())
            }),
        }
    }
}
