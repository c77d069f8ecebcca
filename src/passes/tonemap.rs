//! From linear radiance to what a display shows.

use super::image_kernel::ImageKernel;
use super::pipelines::Builder;
use super::targets::Targets;
use crate::graph::{Pass, Use};
use crate::scene::file::DisplayTable;
use crate::vulkan::{ImageState, SpecializationConstants, VulkanError};
use bytemuck::{Pod, Zeroable};

/// Push constants of `glsl/passes/tonemap.comp`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Constants {
    background: [f32; 3],
    exposure_scale: f32,
}

/// The pass, bound to one set of targets.
pub struct TonemapPass {
    kernel: ImageKernel,
    constants: Constants,
}

impl TonemapPass {
    /// Builds the pass.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(builder: &Builder, targets: &Targets, display: &DisplayTable) -> Result<Self, VulkanError> {
        let images = [&targets.picture, &targets.display];
        let shader = "passes/tonemap.comp";
        let special = SpecializationConstants::new().u32(0, display.tone as u32).bool(1, display.transparent);
        let kernel = ImageKernel::new(builder, "tonemap", shader, &special, images, size_of::<Constants>())?;
        let constants = Constants {
            background: display.background.map(|c| c as f32),
            exposure_scale: display.exposure_stops.exp2() as f32,
        };
        Ok(Self { kernel, constants })
    }

    /// Fills the display image from the picture.
    pub fn pass<'a>(&'a self, targets: &'a Targets) -> Pass<'a> {
        Pass {
            name: "tonemap",
            uses: vec![
                Use::Image(&targets.picture, ImageState::STORAGE_COMPUTE),
                Use::Discard(&targets.display, ImageState::STORAGE_COMPUTE),
            ],
            record: Box::new(|commands| self.kernel.record(commands, &self.constants)),
        }
    }
}
