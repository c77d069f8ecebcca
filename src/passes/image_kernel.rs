//! A compute pass from one image to another, pixel by pixel.

use super::pipelines::Builder;
use super::targets::groups;
use crate::vulkan::{
    Binding, Commands, ComputePipelineInfo, DescriptorLayout, DescriptorSet, Image, Pipeline, Resource,
    SpecializationConstants, VulkanError, vk,
};
use bytemuck::Pod;

/// A kernel with two storage images (bindings 0 and 1 of set 0), push constants, and work groups of
/// 8 x 8 pixels.
pub struct ImageKernel {
    pipeline: Pipeline,
    set: DescriptorSet,
    groups: [u32; 3],
}

impl ImageKernel {
    /// Builds the kernel `shader` (a path under `glsl/`), specialised by `constants`, over two images of one size.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(
        builder: &Builder,
        name: &str,
        shader: &str,
        constants: &SpecializationConstants,
        images: [&Image; 2],
        push_constant_bytes: usize,
    ) -> Result<Self, VulkanError> {
        let binding = |binding| Binding {
            binding,
            kind: vk::DescriptorType::STORAGE_IMAGE,
            stages: vk::ShaderStageFlags::COMPUTE,
        };
        let layout = DescriptorLayout::new(builder.device(), name, &[binding(0), binding(1)])?;
        let what = format!("{shader} {constants:?} {push_constant_bytes}");
        let pipeline = builder.get(&what, &[shader], |cache| {
            let info = ComputePipelineInfo {
                name,
                spirv: builder.words(shader)?,
                constants,
                set_layouts: &[&layout],
                push_constant_bytes: push_constant_bytes as u32,
                cache,
            };
            Pipeline::compute(builder.device(), &info)
        })?;
        let [a, b] = images.map(|image| Resource::StorageImage(image.view()));
        let set = DescriptorSet::new(&layout, name, &[(0, a), (1, b)])?;
        let [width, height, _] = images[0].extent();
        Ok(Self { pipeline, set, groups: groups([width, height]) })
    }

    /// Records the kernel over all pixels.
    ///
    /// # Errors
    /// Constants of another size than the kernel was built for.
    pub fn record<T: Pod>(&self, commands: &Commands<'_>, constants: &T) -> Result<(), VulkanError> {
        commands.bind_pipeline(&self.pipeline);
        commands.bind_sets(&self.pipeline, &[&self.set]);
        commands.push_constants(&self.pipeline, constants)?;
        commands.dispatch(self.groups);
        Ok(())
    }
}
