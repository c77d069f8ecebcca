//! Samplers: how shaders read textures.

use std::sync::Arc;

use ash::vk;

use super::device::Device;
use super::error::VulkanError;
use super::memory::Ticket;

/// How texels between texel centres are read.
#[derive(Clone, Copy, Debug)]
pub struct SamplerInfo {
    /// Filter within and between mip levels: linear or nearest.
    pub filter: vk::Filter,
    /// What lies outside [0, 1], in x, y and z.
    pub address: [vk::SamplerAddressMode; 3],
    /// A comparison for shadow maps (`sampler2DShadow`), if any.
    pub compare: Option<vk::CompareOp>,
    /// Outside colour with `CLAMP_TO_BORDER`.
    pub border: vk::BorderColor,
}

impl Default for SamplerInfo {
    fn default() -> Self {
        Self {
            filter: vk::Filter::LINEAR,
            address: [vk::SamplerAddressMode::CLAMP_TO_EDGE; 3],
            compare: None,
            border: vk::BorderColor::FLOAT_OPAQUE_BLACK,
        }
    }
}

/// A sampler. Clones share it.
#[derive(Clone)]
pub struct Sampler {
    pub(crate) inner: Arc<SamplerInner>,
}

pub(crate) struct SamplerInner {
    raw: vk::Sampler,
    ticket: Ticket,
}

impl Drop for SamplerInner {
    fn drop(&mut self) {
        // SAFETY: descriptor sets hold the sampler, so nothing uses it any more.
        unsafe { self.ticket.device().raw().destroy_sampler(self.raw, None) };
    }
}

impl Sampler {
    /// Makes a sampler.
    ///
    /// # Errors
    /// [`VulkanError::OutOfMemory`] if the device has no more samplers.
    pub fn new(device: &Arc<Device>, name: &str, info: &SamplerInfo) -> Result<Self, VulkanError> {
        let linear = info.filter == vk::Filter::LINEAR;
        let create = vk::SamplerCreateInfo::default()
            .mag_filter(info.filter)
            .min_filter(info.filter)
            .mipmap_mode(if linear { vk::SamplerMipmapMode::LINEAR } else { vk::SamplerMipmapMode::NEAREST })
            .address_mode_u(info.address[0])
            .address_mode_v(info.address[1])
            .address_mode_w(info.address[2])
            .compare_enable(info.compare.is_some())
            .compare_op(info.compare.unwrap_or(vk::CompareOp::NEVER))
            .border_color(info.border)
            .max_lod(vk::LOD_CLAMP_NONE);
        // SAFETY: no optional feature (anisotropy, mirror clamp) is asked for.
        let raw = unsafe { device.raw().create_sampler(&create, None) }
            .map_err(|r| VulkanError::from_vk(format!("sampler `{name}`"), r))?;
        device.set_name(raw, name);
        Ok(Self { inner: Arc::new(SamplerInner { raw, ticket: Ticket::new(device, "sampler", name, 0) }) })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Sampler {
        self.inner.raw
    }
}
