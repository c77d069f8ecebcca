//! Drawing into images.

use ash::vk;

use super::buffer::Buffer;
use super::commands::Commands;
use super::image::ImageView;

/// A colour attachment, in layout `COLOR_ATTACHMENT_OPTIMAL`.
#[derive(Clone, Copy)]
pub struct ColorTarget<'a> {
    /// What is drawn into.
    pub view: &'a ImageView,
    /// Where the samples are averaged to at the end, in the same layout.
    pub resolve: Option<&'a ImageView>,
    /// The colour to start from; what is there, if none.
    pub clear: Option<[f32; 4]>,
    /// Whether the samples themselves are kept.
    pub store: bool,
}

/// The depth attachment, in layout `DEPTH_ATTACHMENT_OPTIMAL`.
#[derive(Clone, Copy)]
pub struct DepthTarget<'a> {
    /// What is drawn into.
    pub view: &'a ImageView,
    /// The depth to start from (0 for reversed Z); what is there, if none.
    pub clear: Option<f32>,
    /// Whether the depth is kept.
    pub store: bool,
}

/// Where a pass draws.
#[derive(Clone, Copy, Default)]
pub struct Rendering<'a> {
    /// Width and height in pixels, also of the viewport.
    pub extent: [u32; 2],
    /// Colour attachments, in order.
    pub color: &'a [ColorTarget<'a>],
    /// Depth attachment, if any.
    pub depth: Option<DepthTarget<'a>>,
}

fn load(clears: bool) -> vk::AttachmentLoadOp {
    if clears { vk::AttachmentLoadOp::CLEAR } else { vk::AttachmentLoadOp::LOAD }
}

fn store(stores: bool) -> vk::AttachmentStoreOp {
    if stores { vk::AttachmentStoreOp::STORE } else { vk::AttachmentStoreOp::DONT_CARE }
}

fn color_info(target: &ColorTarget<'_>) -> vk::RenderingAttachmentInfo<'static> {
    let info = vk::RenderingAttachmentInfo::default()
        .image_view(target.view.raw())
        .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
        .load_op(load(target.clear.is_some()))
        .store_op(store(target.store))
        .clear_value(vk::ClearValue {
            color: vk::ClearColorValue { float32: target.clear.unwrap_or_default() },
        });
    match target.resolve {
        None => info,
        Some(view) => info
            .resolve_mode(vk::ResolveModeFlags::AVERAGE)
            .resolve_image_view(view.raw())
            .resolve_image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL),
    }
}

fn depth_info(target: &DepthTarget<'_>) -> vk::RenderingAttachmentInfo<'static> {
    vk::RenderingAttachmentInfo::default()
        .image_view(target.view.raw())
        .image_layout(vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL)
        .load_op(load(target.clear.is_some()))
        .store_op(store(target.store))
        .clear_value(vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue { depth: target.clear.unwrap_or_default(), stencil: 0 },
        })
}

impl Commands<'_> {
    /// Opens rendering, sets viewport (depth 0 to 1) and scissor to the whole extent, runs `record`,
    /// and closes rendering again.
    pub fn render<R>(&self, rendering: &Rendering<'_>, record: impl FnOnce() -> R) -> R {
        for target in rendering.color {
            self.keep(target.view.inner.clone());
            if let Some(view) = target.resolve {
                self.keep(view.inner.clone());
            }
        }
        if let Some(target) = &rendering.depth {
            self.keep(target.view.inner.clone());
        }
        let color: Vec<_> = rendering.color.iter().map(color_info).collect();
        let depth = rendering.depth.as_ref().map(depth_info);
        let [width, height] = rendering.extent;
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let mut info =
            vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&color);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        // SAFETY: recording is open and outside of rendering; the views are kept until the fence.
        unsafe { self.device().raw().cmd_begin_rendering(self.raw(), &info) };
        self.set_viewport(rendering.extent);
        let result = record();
        // SAFETY: closes the rendering opened above.
        unsafe { self.device().raw().cmd_end_rendering(self.raw()) };
        result
    }

    /// Sets viewport and scissor to `extent` pixels from the corner.
    pub fn set_viewport(&self, extent: [u32; 2]) {
        let [width, height] = extent;
        let viewport = vk::Viewport {
            x: 0.0,
            y: 0.0,
            // Image sizes are far below 2^24, where these are exact.
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let scissor = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        // SAFETY: recording is open; one viewport and one scissor, as every pipeline declares.
        unsafe {
            self.device().raw().cmd_set_viewport(self.raw(), 0, &[viewport]);
            self.device().raw().cmd_set_scissor(self.raw(), 0, &[scissor]);
        }
    }

    /// Draws `vertices` from `first_vertex`, `instances` times from `first_instance`.
    pub fn draw(&self, vertices: u32, instances: u32, first_vertex: u32, first_instance: u32) {
        // SAFETY: recording is open, inside rendering with a pipeline bound (or validation says so).
        unsafe {
            self.device().raw().cmd_draw(self.raw(), vertices, instances, first_vertex, first_instance);
        }
    }

    /// Draws `count` times with arguments (`VkDrawIndirectCommand`) from a buffer, `stride` bytes
    /// apart. More than one needs [`super::OptionalFeatures::multi_draw_indirect`].
    pub fn draw_indirect(&self, arguments: &Buffer, offset: u64, count: u32, stride: u32) {
        self.keep_buffer(arguments);
        // SAFETY: as for `draw`; the buffer is kept until the fence.
        unsafe { self.device().raw().cmd_draw_indirect(self.raw(), arguments.raw(), offset, count, stride) };
    }

    /// As [`Self::draw_indirect`], with the number of draws (at most `most`) read from another buffer.
    /// Needs [`super::OptionalFeatures::draw_indirect_count`].
    pub fn draw_indirect_count(
        &self,
        arguments: (&Buffer, u64),
        count: (&Buffer, u64),
        most: u32,
        stride: u32,
    ) {
        self.keep_buffer(arguments.0);
        self.keep_buffer(count.0);
        // SAFETY: as for `draw`; both buffers are kept until the fence.
        unsafe {
            self.device().raw().cmd_draw_indirect_count(
                self.raw(),
                arguments.0.raw(),
                arguments.1,
                count.0.raw(),
                count.1,
                most,
                stride,
            );
        }
    }
}
