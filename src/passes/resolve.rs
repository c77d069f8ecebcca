//! Adds a jittered frame to the picture.

use super::image_kernel::ImageKernel;
use super::pipelines::Builder;
use super::targets::Targets;
use crate::graph::{Pass, Use};
use crate::vulkan::{ImageState, SpecializationConstants, VulkanError};
use bytemuck::{Pod, Zeroable};

/// Push constants of `glsl/passes/resolve.comp`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Constants {
    weight: f32,
    light_weight: f32,
    first: u32,
}

/// The pass, bound to one set of targets.
pub struct ResolvePass {
    kernel: ImageKernel,
}

impl ResolvePass {
    /// Builds the pass.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(builder: &Builder, targets: &Targets) -> Result<Self, VulkanError> {
        let images = [&targets.frame, &targets.picture];
        let (shader, none) = ("passes/resolve.comp", SpecializationConstants::new());
        let kernel = ImageKernel::new(builder, "resolve", shader, &none, images, size_of::<Constants>())?;
        Ok(Self { kernel })
    }

    /// Adds frame `index` of `count` equally weighted ones, whose light is `light_scale` times as strong as it
    /// should be; the first replaces what was there.
    pub fn pass<'a>(
        &'a self,
        targets: &'a Targets,
        (index, count): (usize, usize),
        light_scale: f64,
    ) -> Pass<'a> {
        let weight = 1.0 / count as f32;
        let light_weight = weight / light_scale as f32;
        let constants = Constants { weight, light_weight, first: (index == 0).into() };
        Pass {
            name: "resolve",
            uses: vec![
                Use::Image(&targets.frame, ImageState::STORAGE_COMPUTE),
                Use::Image(&targets.picture, ImageState::STORAGE_COMPUTE),
            ],
            record: Box::new(move |commands| self.kernel.record(commands, &constants)),
        }
    }
}
