//! The images a picture goes through.

use crate::vulkan::{Device, Image, ImageInfo, VulkanError, vk};
use std::sync::Arc;

/// Linear radiance of one frame.
pub const RADIANCE_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
/// Reversed Z wants a float.
pub const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// The images of one picture size.
pub struct Targets {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel of one frame.
    pub samples: vk::SampleCountFlags,
    /// Radiance per sample; absent when one sample goes straight to `frame`.
    pub multisampled: Option<Image>,
    /// Depth per sample.
    pub depth: Image,
    /// Radiance of one frame.
    pub frame: Image,
    /// Mean of all frames so far, f32.
    pub picture: Image,
    /// What a display shows, sRGB encoded.
    pub display: Image,
}

impl Targets {
    /// Makes the images for `size` pixels and 1 or 4 `samples` a frame.
    ///
    /// # Errors
    /// A size beyond the device's limits, or no memory for it.
    pub fn new(
        device: &Arc<Device>,
        size: [u32; 2],
        samples: vk::SampleCountFlags,
    ) -> Result<Self, VulkanError> {
        use vk::ImageUsageFlags as Usage;
        let image = |name, format, samples, usage| {
            Image::new(
                device,
                &ImageInfo {
                    name,
                    format,
                    extent: [size[0], size[1], 1],
                    samples,
                    usage,
                    ..Default::default()
                },
            )
        };
        let one = vk::SampleCountFlags::TYPE_1;
        let multisampled = (samples != one)
            .then(|| image("radiance samples", RADIANCE_FORMAT, samples, Usage::COLOR_ATTACHMENT))
            .transpose()?;
        let frame_usage = Usage::COLOR_ATTACHMENT | Usage::STORAGE;
        let read_back = Usage::STORAGE | Usage::TRANSFER_SRC;
        Ok(Self {
            size,
            samples,
            multisampled,
            depth: image("depth", DEPTH_FORMAT, samples, Usage::DEPTH_STENCIL_ATTACHMENT)?,
            frame: image("frame radiance", RADIANCE_FORMAT, one, frame_usage)?,
            picture: image("picture", vk::Format::R32G32B32A32_SFLOAT, one, read_back)?,
            display: image("display", vk::Format::R8G8B8A8_UNORM, one, read_back)?,
        })
    }
}

/// Work groups of 8 x 8 that cover `size` pixels.
pub fn groups(size: [u32; 2]) -> [u32; 3] {
    [size[0].div_ceil(8), size[1].div_ceil(8), 1]
}
