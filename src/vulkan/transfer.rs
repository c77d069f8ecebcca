//! Between the host's memory and images.

use ash::vk;
use bytemuck::Pod;

use super::barriers::{Access, ImageState};
use super::buffer::Buffer;
use super::commands::Commands;
use super::error::VulkanError;
use super::image::Image;
use super::memory::MemoryKind;

/// Bytes per texel of the formats that are read and written from the host.
fn texel_bytes(format: vk::Format) -> Option<u64> {
    Some(match format {
        vk::Format::R8_UNORM | vk::Format::R8_UINT => 1,
        vk::Format::R16_SFLOAT | vk::Format::R16_UNORM | vk::Format::D16_UNORM | vk::Format::R8G8_UNORM => 2,
        vk::Format::R8G8B8A8_UNORM
        | vk::Format::R8G8B8A8_SRGB
        | vk::Format::B8G8R8A8_UNORM
        | vk::Format::B8G8R8A8_SRGB
        | vk::Format::R16G16_SFLOAT
        | vk::Format::R16G16_UNORM
        | vk::Format::R32_SFLOAT
        | vk::Format::R32_UINT
        | vk::Format::D32_SFLOAT => 4,
        vk::Format::R16G16B16A16_SFLOAT
        | vk::Format::R16G16B16A16_UNORM
        | vk::Format::R32G32_SFLOAT
        | vk::Format::R32G32_UINT => 8,
        vk::Format::R32G32B32A32_SFLOAT | vk::Format::R32G32B32A32_UINT => 16,
        _ => return None,
    })
}

impl Image {
    /// Bytes of mip level 0 over all layers, tightly packed.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] for a format without a known texel size, or several samples.
    pub fn host_bytes(&self) -> Result<u64, VulkanError> {
        self.host_bytes_of(0)
    }

    /// Width, height and depth of a mip level.
    fn extent_of(&self, mip_level: u32) -> [u32; 3] {
        self.extent().map(|side| (side >> mip_level).max(1))
    }

    fn host_bytes_of(&self, mip_level: u32) -> Result<u64, VulkanError> {
        let unknown =
            || VulkanError::misuse(format!("image `{}`: host copy of {:?}", self.name(), self.format()));
        let texel = texel_bytes(self.format()).ok_or_else(unknown)?;
        if self.samples() != vk::SampleCountFlags::TYPE_1 {
            return Err(VulkanError::misuse(format!(
                "image `{}`: host copy of a multisampled image",
                self.name()
            )));
        }
        let mut counts = self.extent_of(mip_level).into_iter().chain([self.layers()]).map(u64::from);
        counts.try_fold(texel, u64::checked_mul).ok_or_else(|| VulkanError::OutOfMemory {
            what: format!("host copy of image `{}`", self.name()),
            bytes: u64::MAX,
        })
    }

    fn copy_region(&self, mip_level: u32) -> vk::BufferImageCopy {
        let [width, height, depth] = self.extent_of(mip_level);
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(self.aspect())
            .mip_level(mip_level)
            .layer_count(self.layers());
        vk::BufferImageCopy::default().image_subresource(layers).image_extent(vk::Extent3D {
            width,
            height,
            depth,
        })
    }

    /// Replaces mip level 0 of every layer with tightly packed texels and leaves the whole image in
    /// `state`. The image needs `TRANSFER_DST` usage. Other mip levels are undefined afterwards.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if the data has another size; those of a submission.
    pub fn upload<T: Pod>(&self, texels: &[T], state: ImageState) -> Result<(), VulkanError> {
        self.upload_mips(&[texels], state)
    }

    /// The same for the first mip levels, the whole size first, each with all layers tightly packed.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if there are too many levels, or one has another size; those of a submission.
    pub fn upload_mips<T: Pod>(&self, levels: &[&[T]], state: ImageState) -> Result<(), VulkanError> {
        if levels.len() > self.mip_levels() as usize {
            let what = format!(
                "image `{}` has {} mip levels, {} given",
                self.name(),
                self.mip_levels(),
                levels.len()
            );
            return Err(VulkanError::misuse(what));
        }
        let name = format!("staging for {}", self.name());
        let mut staged = Vec::new();
        for (level, texels) in (0..).zip(levels) {
            let (expected, found) = (self.host_bytes_of(level)?, size_of_val(*texels));
            if u64::try_from(found) != Ok(expected) {
                let what =
                    format!("image `{}` takes {expected} bytes at level {level}, {found} given", self.name());
                return Err(VulkanError::misuse(what));
            }
            let usage = vk::BufferUsageFlags::empty();
            let staging = Buffer::new(self.device(), &name, expected, usage, MemoryKind::Upload)?;
            staging.write(0, texels)?;
            staged.push(staging);
        }
        self.device().run_once(&name, |cmd| {
            cmd.image_barrier(self, ImageState::UNDEFINED, ImageState::TRANSFER_DST);
            for (level, staging) in (0..).zip(&staged) {
                cmd.copy_buffer_to_image(staging, self, level);
            }
            cmd.image_barrier(self, ImageState::TRANSFER_DST, state);
            Ok(())
        })?;
        Ok(())
    }

    /// Reads mip level 0 of every layer, tightly packed. The image needs `TRANSFER_SRC` usage, is in
    /// `state`, and returns to it.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if a row of texels is not whole `T`s; those of a submission.
    pub fn read<T: Pod>(&self, state: ImageState) -> Result<Vec<T>, VulkanError> {
        let bytes = self.host_bytes()?;
        let whole = u64::try_from(size_of::<T>()).ok().and_then(|size| bytes.checked_rem(size)) == Some(0);
        if !whole {
            let what =
                format!("image `{}` of {bytes} bytes read in pieces of {}", self.name(), size_of::<T>());
            return Err(VulkanError::misuse(what));
        }
        let name = format!("readback of {}", self.name());
        let usage = vk::BufferUsageFlags::empty();
        let target = Buffer::new(self.device(), &name, bytes, usage, MemoryKind::Readback)?;
        self.device().run_once(&name, |cmd| {
            cmd.image_barrier(self, state, ImageState::TRANSFER_SRC);
            cmd.copy_image_to_buffer(self, &target);
            cmd.image_barrier(self, ImageState::TRANSFER_SRC, state);
            cmd.memory_barrier(Access::TRANSFER_WRITE, Access::HOST_READ);
            Ok(())
        })?;
        target.read()
    }
}

impl Commands<'_> {
    /// Copies tightly packed texels into a mip level of an image in layout `TRANSFER_DST_OPTIMAL`.
    pub fn copy_buffer_to_image(&self, from: &Buffer, to: &Image, mip_level: u32) {
        self.keep_buffer(from);
        self.keep(to.inner.clone());
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let region = [to.copy_region(mip_level)];
        // SAFETY: recording is open; buffer and image are kept until the fence.
        unsafe {
            self.device().raw().cmd_copy_buffer_to_image(self.raw(), from.raw(), to.raw(), layout, &region)
        };
    }

    /// Copies mip level 0 of an image in layout `TRANSFER_SRC_OPTIMAL`, tightly packed.
    pub fn copy_image_to_buffer(&self, from: &Image, to: &Buffer) {
        self.keep(from.inner.clone());
        self.keep_buffer(to);
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let region = [from.copy_region(0)];
        // SAFETY: recording is open; image and buffer are kept until the fence.
        unsafe {
            self.device().raw().cmd_copy_image_to_buffer(self.raw(), from.raw(), layout, to.raw(), &region)
        };
    }
}
