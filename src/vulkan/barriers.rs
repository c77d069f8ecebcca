//! Who wrote, who reads next: the two halves of every barrier.

use ash::vk;

use super::commands::Commands;
use super::image::Image;

/// Pipeline stages and what they do to memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// The stages.
    pub stage: vk::PipelineStageFlags2,
    /// Their reads and writes.
    pub access: vk::AccessFlags2,
}

const fn access(stage: vk::PipelineStageFlags2, access: vk::AccessFlags2) -> Access {
    Access { stage, access }
}

const fn both(a: vk::PipelineStageFlags2, b: vk::PipelineStageFlags2) -> vk::PipelineStageFlags2 {
    vk::PipelineStageFlags2::from_raw(a.as_raw() | b.as_raw())
}

const fn rw(a: vk::AccessFlags2, b: vk::AccessFlags2) -> vk::AccessFlags2 {
    vk::AccessFlags2::from_raw(a.as_raw() | b.as_raw())
}

use vk::{AccessFlags2 as A, PipelineStageFlags2 as S};

const DEPTH_TESTS: S = both(S::EARLY_FRAGMENT_TESTS, S::LATE_FRAGMENT_TESTS);

impl Access {
    /// Nothing before: the first use of a resource.
    pub const NONE: Self = access(S::NONE, A::NONE);
    /// Any write by anything (coarse, for uploads and read-backs).
    pub const ANY_WRITE: Self = access(S::ALL_COMMANDS, A::MEMORY_WRITE);
    /// Any read or write by anything (coarse).
    pub const ANY: Self = access(S::ALL_COMMANDS, rw(A::MEMORY_READ, A::MEMORY_WRITE));
    /// Compute shaders read storage, textures or uniforms.
    pub const COMPUTE_READ: Self = access(S::COMPUTE_SHADER, A::SHADER_READ);
    /// Compute shaders write storage.
    pub const COMPUTE_WRITE: Self = access(S::COMPUTE_SHADER, A::SHADER_WRITE);
    /// Compute shaders read and write storage (atomics).
    pub const COMPUTE: Self = access(S::COMPUTE_SHADER, rw(A::SHADER_READ, A::SHADER_WRITE));
    /// Vertex, tessellation and geometry shaders read.
    pub const GEOMETRY_STAGES_READ: Self = access(S::PRE_RASTERIZATION_SHADERS, A::SHADER_READ);
    /// Fragment shaders read.
    pub const FRAGMENT_READ: Self = access(S::FRAGMENT_SHADER, A::SHADER_READ);
    /// Any graphics shader reads.
    pub const GRAPHICS_READ: Self =
        access(both(S::PRE_RASTERIZATION_SHADERS, S::FRAGMENT_SHADER), A::SHADER_READ);
    /// Draw and dispatch arguments are read.
    pub const INDIRECT_READ: Self = access(S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ);
    /// Colour attachments are written, blended or resolved.
    pub const COLOR_TARGET: Self =
        access(S::COLOR_ATTACHMENT_OUTPUT, rw(A::COLOR_ATTACHMENT_READ, A::COLOR_ATTACHMENT_WRITE));
    /// The depth attachment is tested and written.
    pub const DEPTH_TARGET: Self =
        access(DEPTH_TESTS, rw(A::DEPTH_STENCIL_ATTACHMENT_READ, A::DEPTH_STENCIL_ATTACHMENT_WRITE));
    /// Copies, fills and blits read.
    pub const TRANSFER_READ: Self = access(S::ALL_TRANSFER, A::TRANSFER_READ);
    /// Copies, fills and blits write.
    pub const TRANSFER_WRITE: Self = access(S::ALL_TRANSFER, A::TRANSFER_WRITE);
    /// The host reads after the fence.
    pub const HOST_READ: Self = access(S::HOST, A::HOST_READ);

    /// Both together.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        access(both(self.stage, other.stage), rw(self.access, other.access))
    }
}

/// An access with the layout that it needs or leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageState {
    /// Who touches the image.
    pub access: Access,
    /// In which layout.
    pub layout: vk::ImageLayout,
}

const fn state(access: Access, layout: vk::ImageLayout) -> ImageState {
    ImageState { access, layout }
}

impl ImageState {
    /// Never used, or its contents are no longer wanted. Only for an image that nothing earlier in
    /// the same submission used; otherwise pair that use's access with layout `UNDEFINED`.
    pub const UNDEFINED: Self = state(Access::NONE, vk::ImageLayout::UNDEFINED);
    /// Colour attachment or resolve target.
    pub const COLOR_TARGET: Self = state(Access::COLOR_TARGET, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL);
    /// Depth attachment.
    pub const DEPTH_TARGET: Self = state(Access::DEPTH_TARGET, vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL);
    /// Texture in fragment shaders.
    pub const SAMPLED_FRAGMENT: Self =
        state(Access::FRAGMENT_READ, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
    /// Texture in any graphics shader.
    pub const SAMPLED_GRAPHICS: Self =
        state(Access::GRAPHICS_READ, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
    /// Texture in compute shaders.
    pub const SAMPLED_COMPUTE: Self = state(Access::COMPUTE_READ, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
    /// Storage image of compute shaders.
    pub const STORAGE_COMPUTE: Self = state(Access::COMPUTE, vk::ImageLayout::GENERAL);
    /// Source of a copy.
    pub const TRANSFER_SRC: Self = state(Access::TRANSFER_READ, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    /// Target of a copy.
    pub const TRANSFER_DST: Self = state(Access::TRANSFER_WRITE, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
    /// Handed to the presentation engine (a semaphore orders it).
    pub const PRESENT: Self = state(Access::NONE, vk::ImageLayout::PRESENT_SRC_KHR);
}

impl Commands<'_> {
    /// Everything `to` does waits for everything `from` did, on all buffers.
    pub fn memory_barrier(&self, from: Access, to: Access) {
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(from.stage)
            .src_access_mask(from.access)
            .dst_stage_mask(to.stage)
            .dst_access_mask(to.access)];
        let info = vk::DependencyInfo::default().memory_barriers(&barrier);
        // SAFETY: recording is open, outside of rendering by this function's place in a frame.
        unsafe { self.device().raw().cmd_pipeline_barrier2(self.raw(), &info) };
    }

    /// Moves all of an image from one state to the next.
    pub fn image_barrier(&self, image: &Image, from: ImageState, to: ImageState) {
        self.image_range_barrier(image, image.full_range(), from, to);
    }

    /// Moves some levels or layers of an image from one state to the next.
    pub fn image_range_barrier(
        &self,
        image: &Image,
        range: vk::ImageSubresourceRange,
        from: ImageState,
        to: ImageState,
    ) {
        self.keep(image.inner.clone());
        self.raw_image_barrier(image.raw(), range, from, to);
    }

    /// As [`Self::image_range_barrier`], for an image not made here (of a swapchain). It must live
    /// until the commands have run.
    pub fn raw_image_barrier(
        &self,
        image: vk::Image,
        range: vk::ImageSubresourceRange,
        from: ImageState,
        to: ImageState,
    ) {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(from.access.stage)
            .src_access_mask(from.access.access)
            .dst_stage_mask(to.access.stage)
            .dst_access_mask(to.access.access)
            .old_layout(from.layout)
            .new_layout(to.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image)
            .subresource_range(range)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: recording is open; the image is kept until the fence (or by the caller's word).
        unsafe { self.device().raw().cmd_pipeline_barrier2(self.raw(), &info) };
    }
}
