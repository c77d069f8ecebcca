//! Compiled pipelines kept between runs.

use std::sync::Arc;

use ash::vk;

use super::device::Device;
use super::error::{VkContext, VulkanError};
use super::memory::Ticket;

/// Bytes of `VkPipelineCacheHeaderVersionOne`.
const HEADER_BYTES: usize = 16 + vk::UUID_SIZE;

/// A driver's cache of compiled pipelines.
pub struct PipelineCache {
    raw: vk::PipelineCache,
    ticket: Ticket,
}

impl Drop for PipelineCache {
    fn drop(&mut self) {
        // SAFETY: the cache is used only during pipeline creation, which borrows it.
        unsafe { self.ticket.device().raw().destroy_pipeline_cache(self.raw, None) };
    }
}

impl PipelineCache {
    /// Starts from the bytes of an earlier [`Self::data`], or empty where they come from another
    /// device or driver version. Only the header is checked: the caller must make sure that the
    /// bytes are whole (a hash beside them), for drivers trust what follows the header.
    ///
    /// # Errors
    /// Out of memory.
    pub fn new(device: &Arc<Device>, earlier: &[u8]) -> Result<Self, VulkanError> {
        let fits = Maker::of(device).made(earlier);
        if !fits && !earlier.is_empty() {
            tracing::debug!("the pipeline cache is of another device or driver: starting empty");
        }
        let info = vk::PipelineCacheCreateInfo::default().initial_data(if fits { earlier } else { &[] });
        // SAFETY: the data is empty or carries this device's own header.
        let raw = unsafe { device.raw().create_pipeline_cache(&info, None) }.during("the pipeline cache")?;
        device.set_name(raw, "pipeline cache");
        Ok(Self { raw, ticket: Ticket::new(device, "pipeline cache", "pipeline cache", 0) })
    }

    /// What to keep for the next run.
    ///
    /// # Errors
    /// Out of memory.
    pub fn data(&self) -> Result<Vec<u8>, VulkanError> {
        // SAFETY: the cache is alive.
        unsafe { self.ticket.device().raw().get_pipeline_cache_data(self.raw) }
            .during("reading the pipeline cache")
    }

    pub(crate) fn raw(&self) -> vk::PipelineCache {
        self.raw
    }
}

/// Who a cache's header says it was made by.
struct Maker {
    vendor_id: u32,
    device_id: u32,
    uuid: [u8; vk::UUID_SIZE],
}

impl Maker {
    fn of(device: &Device) -> Self {
        let candidate = device.candidate();
        let (vendor_id, device_id) = (candidate.vendor_id, candidate.device_id);
        Self { vendor_id, device_id, uuid: candidate.pipeline_cache_uuid }
    }

    /// Whether the header is whole and names this maker.
    fn made(&self, bytes: &[u8]) -> bool {
        let Some((header, _)) = bytes.split_at_checked(HEADER_BYTES) else { return false };
        let (words, uuid) = header.split_at(16);
        let mut found = words.chunks_exact(4).map(|w| u32::from_ne_bytes([w[0], w[1], w[2], w[3]]));
        let version = u32::try_from(vk::PipelineCacheHeaderVersion::ONE.as_raw()).unwrap_or(1);
        let length = found.next().and_then(|l| usize::try_from(l).ok());
        length.is_some_and(|l| (HEADER_BYTES..=bytes.len()).contains(&l))
            && found.eq([version, self.vendor_id, self.device_id])
            && uuid == self.uuid
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_of_the_header_counts() {
        let maker = Maker { vendor_id: 0x10005, device_id: 7, uuid: *b"0123456789abcdef" };
        let words = [32_u32, 1, 0x10005, 7].map(u32::to_ne_bytes).concat();
        let good = [&words[..], &maker.uuid, b"body"].concat();
        assert!(maker.made(&good) && maker.made(&good[..32]));
        for wrong_byte in 0..HEADER_BYTES {
            let mut wrong = good.clone();
            wrong[wrong_byte] ^= 0x40;
            assert!(!maker.made(&wrong), "byte {wrong_byte}");
        }
        assert!(!maker.made(&good[..31]) && !maker.made(&[]));
    }
}
