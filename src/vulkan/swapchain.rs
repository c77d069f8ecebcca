//! A window's surface and the images that are shown on it.

use std::ffi::{CStr, CString};
use std::sync::Arc;

use ash::vk;
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};

use super::commands::Semaphores;
use super::device::Device;
use super::error::{VkContext, VulkanError};

/// Formats that encode linear colors in sRGB as they are written, exactly, the best first.
const FORMATS: [vk::Format; 2] = [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB];

/// What presenting a picture came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presented {
    /// It is shown.
    Shown,
    /// The window has no area, or changed: nothing is shown yet.
    NotYet,
}

/// A window that pictures are shown in.
pub struct Swapchain<W> {
    chain: Option<Chain>,
    surface: Surface,
    acquired: Semaphore,
    size: [u32; 2],
    device: Arc<Device>,
    /// Last: the window outlives its surface.
    window: Arc<W>,
}

/// The images of one size.
struct Chain {
    loader: ash::khr::swapchain::Device,
    raw: vk::SwapchainKHR,
    images: Vec<vk::Image>,
    views: Vec<vk::ImageView>,
    /// One for each image: the one before may still wait to be shown.
    drawn: Vec<Semaphore>,
    extent: vk::Extent2D,
    device: Arc<Device>,
}

struct Surface {
    loader: ash::khr::surface::Instance,
    raw: vk::SurfaceKHR,
}

struct Semaphore {
    raw: vk::Semaphore,
    device: Arc<Device>,
}

impl Semaphore {
    fn new(device: &Arc<Device>) -> Result<Self, VulkanError> {
        // SAFETY: a plain semaphore.
        let raw = unsafe { device.raw().create_semaphore(&vk::SemaphoreCreateInfo::default(), None) }
            .during("a window's semaphore")?;
        Ok(Self { raw, device: device.clone() })
    }
}

impl Drop for Semaphore {
    fn drop(&mut self) {
        // SAFETY: whoever drops it has waited until the device is idle.
        unsafe { self.device.raw().destroy_semaphore(self.raw, None) };
    }
}

impl Drop for Chain {
    fn drop(&mut self) {
        // Presentation has no fence.
        if let Err(error) = self.device.wait_idle() {
            tracing::error!("closing a window: {error}");
        }
        // SAFETY: the device is idle or lost, and the views are of this chain's images.
        unsafe {
            for view in &self.views {
                self.device.raw().destroy_image_view(*view, None);
            }
            self.loader.destroy_swapchain(self.raw, None);
        }
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: the chain on it was dropped before: it is the field before, or was taken.
        unsafe { self.loader.destroy_surface(self.raw, None) };
    }
}

/// Instance extensions that surfaces on this display need.
///
/// # Errors
/// A kind of display that Vulkan knows no surface for.
pub fn surface_extensions(display: &impl HasDisplayHandle) -> Result<Vec<CString>, VulkanError> {
    let unknown = |why: String| VulkanError::MissingFeature { device: "the display".into(), what: why };
    let handle = display.display_handle().map_err(|e| unknown(format!("a handle ({e})")))?;
    let names = ash_window::enumerate_required_extensions(handle.as_raw())
        .map_err(|e| unknown(format!("a Vulkan surface ({e:?})")))?;
    // SAFETY: the crate returns pointers to its own constant names.
    Ok(names.iter().map(|name| unsafe { CStr::from_ptr(*name) }.to_owned()).collect())
}

/// The device extension that swapchains need.
pub fn swapchain_extension() -> CString {
    ash::khr::swapchain::NAME.to_owned()
}

impl<W: HasDisplayHandle + HasWindowHandle> Swapchain<W> {
    /// On a window of `size` pixels, by a device that was opened with the extensions for it.
    ///
    /// # Errors
    /// A device that cannot show pictures on this window; out of memory.
    pub fn new(device: &Arc<Device>, window: Arc<W>, size: [u32; 2]) -> Result<Self, VulkanError> {
        let surface = Surface::new(device, &*window)?;
        let acquired = Semaphore::new(device)?;
        let mut swapchain = Self { chain: None, surface, acquired, size, device: device.clone(), window };
        swapchain.make()?;
        Ok(swapchain)
    }

    /// The window is as large as this now.
    pub fn resize(&mut self, size: [u32; 2]) {
        if size != self.size {
            self.size = size;
            self.chain = None;
        }
    }

    /// Records `draw` between the layouts of drawing and of showing, runs it, and shows the image. `draw` is given the
    /// commands and the image's size.
    ///
    /// # Errors
    /// Those of the device and of `draw`. Windows that change or go meanwhile are none.
    pub fn present(
        &mut self,
        draw: impl FnOnce(vk::CommandBuffer, [u32; 2]) -> Result<(), VulkanError>,
    ) -> Result<Presented, VulkanError> {
        if self.chain.is_none() {
            self.make()?;
        }
        let Some(chain) = &self.chain else { return Ok(Presented::NotYet) };
        // SAFETY: the chain lives; the semaphore is unsignalled, since the submission that waited for it is done.
        let acquired = unsafe {
            chain.loader.acquire_next_image(chain.raw, u64::MAX, self.acquired.raw, vk::Fence::null())
        };
        let index = match acquired {
            Ok((index, _)) => index as usize,
            Err(result) => return self.outdated(result),
        };
        let wait = [(self.acquired.raw, vk::PipelineStageFlags2::ALL_COMMANDS)];
        let signal = [chain.drawn[index].raw];
        self.device.run_once_with("window", Semaphores { wait: &wait, signal: &signal }, |commands| {
            chain.record(commands.raw(), index, draw)
        })?;
        let (chains, indices) = ([chain.raw], [index as u32]);
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&signal)
            .swapchains(&chains)
            .image_indices(&indices);
        // SAFETY: the queue is locked; the image was acquired and is in the layout for showing it.
        let presented = unsafe { chain.loader.queue_present(*self.device.lock_queue(), &info) };
        match presented {
            Ok(false) => Ok(Presented::Shown),
            // It is shown, if not as well as it could be.
            Ok(true) => {
                self.chain = None;
                Ok(Presented::Shown)
            }
            Err(result) => self.outdated(result),
        }
    }

    /// What follows of a failure: windows change, are covered and go.
    fn outdated(&mut self, result: vk::Result) -> Result<Presented, VulkanError> {
        match result {
            vk::Result::ERROR_OUT_OF_DATE_KHR => self.chain = None,
            vk::Result::ERROR_SURFACE_LOST_KHR => {
                self.chain = None;
                self.surface = Surface::new(&self.device, &*self.window)?;
            }
            result => return Err(VulkanError::from_vk("showing a picture", result)),
        }
        // A wait for the image that never came may have been left behind.
        self.acquired = Semaphore::new(&self.device)?;
        Ok(Presented::NotYet)
    }

    /// Makes the images, if the window has an area.
    fn make(&mut self) -> Result<(), VulkanError> {
        let capabilities = self.surface.capabilities(&self.device)?;
        let extent = match capabilities.current_extent {
            // The surface takes the size of its images.
            vk::Extent2D { width: u32::MAX, .. } => {
                let [width, height] = self.size;
                let (least, most) = (capabilities.min_image_extent, capabilities.max_image_extent);
                vk::Extent2D {
                    width: width.clamp(least.width, most.width),
                    height: height.clamp(least.height, most.height),
                }
            }
            extent => extent,
        };
        if extent.width > 0 && extent.height > 0 && self.size.iter().all(|side| *side > 0) {
            self.chain = Some(Chain::new(&self.device, &self.surface, &capabilities, extent)?);
        }
        Ok(())
    }

    /// The format of the images.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn format(&self) -> Result<vk::Format, VulkanError> {
        self.surface.format(&self.device).map(|format| format.format)
    }
}

impl Surface {
    fn new<W: HasDisplayHandle + HasWindowHandle>(
        device: &Arc<Device>,
        window: &W,
    ) -> Result<Self, VulkanError> {
        let gone = |why: String| VulkanError::MissingFeature { device: "the window".into(), what: why };
        let display = window.display_handle().map_err(|e| gone(format!("a display ({e})")))?;
        let handle = window.window_handle().map_err(|e| gone(format!("a handle ({e})")))?;
        let (entry, instance) = (device.entry(), device.instance());
        // SAFETY: both handles are of a window that is kept for as long as the surface, and the instance was made with the
        // extensions that the display needs.
        let raw =
            unsafe { ash_window::create_surface(entry, instance, display.as_raw(), handle.as_raw(), None) }
                .during("a window's surface")?;
        let surface = Self { loader: ash::khr::surface::Instance::new(entry, instance), raw };
        // SAFETY: the family is the device's own and the surface lives.
        let shows = unsafe {
            surface.loader.get_physical_device_surface_support(device.physical(), device.queue_family(), raw)
        }
        .during("asking whether a window can be shown")?;
        if !shows {
            let what = "pictures in windows on this display".to_owned();
            return Err(VulkanError::MissingFeature { device: device.name().to_owned(), what });
        }
        Ok(surface)
    }

    fn capabilities(&self, device: &Device) -> Result<vk::SurfaceCapabilitiesKHR, VulkanError> {
        // SAFETY: the surface and the device live.
        unsafe { self.loader.get_physical_device_surface_capabilities(device.physical(), self.raw) }
            .during("asking for a window's size")
    }

    fn format(&self, device: &Device) -> Result<vk::SurfaceFormatKHR, VulkanError> {
        // SAFETY: the surface and the device live.
        let formats = unsafe { self.loader.get_physical_device_surface_formats(device.physical(), self.raw) }
            .during("asking for a window's formats")?;
        let found = FORMATS.iter().find_map(|format| {
            let srgb = vk::ColorSpaceKHR::SRGB_NONLINEAR;
            formats.iter().find(|found| found.format == *format && found.color_space == srgb)
        });
        found.copied().ok_or_else(|| VulkanError::MissingFeature {
            device: device.name().to_owned(),
            what: "windows of 8 bits a channel".into(),
        })
    }
}

impl Chain {
    fn new(
        device: &Arc<Device>,
        surface: &Surface,
        capabilities: &vk::SurfaceCapabilitiesKHR,
        extent: vk::Extent2D,
    ) -> Result<Self, VulkanError> {
        let format = surface.format(device)?;
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
        let alpha = [vk::CompositeAlphaFlagsKHR::OPAQUE, vk::CompositeAlphaFlagsKHR::INHERIT];
        let supported =
            |flag: &vk::CompositeAlphaFlagsKHR| capabilities.supported_composite_alpha.contains(*flag);
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count((capabilities.min_image_count + 1).min(most))
            .image_format(format.format)
            .image_color_space(format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(capabilities.current_transform)
            .composite_alpha(alpha.into_iter().find(supported).unwrap_or(alpha[0]))
            // Every device has it, and a window that is looked at needs no more than its display shows.
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true);
        let loader = ash::khr::swapchain::Device::new(device.instance(), device.raw());
        // SAFETY: the surface lives, and all that is asked for is among what it can.
        let raw = unsafe { loader.create_swapchain(&info, None) }.during("a window's images")?;
        let (images, views, drawn) = (Vec::new(), Vec::new(), Vec::new());
        let mut chain = Self { loader, raw, images, views, drawn, extent, device: device.clone() };
        // SAFETY: the chain was just made.
        chain.images = unsafe { chain.loader.get_swapchain_images(raw) }.during("a window's images")?;
        for image in chain.images.clone() {
            let range = vk::ImageSubresourceRange::default()
                .aspect_mask(vk::ImageAspectFlags::COLOR)
                .level_count(1)
                .layer_count(1);
            let view = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format.format)
                .subresource_range(range);
            // SAFETY: the image is the chain's, which outlives its views.
            let view = unsafe { device.raw().create_image_view(&view, None) }.during("a window's images")?;
            chain.views.push(view);
            chain.drawn.push(Semaphore::new(device)?);
        }
        Ok(chain)
    }

    fn record(
        &self,
        commands: vk::CommandBuffer,
        index: usize,
        draw: impl FnOnce(vk::CommandBuffer, [u32; 2]) -> Result<(), VulkanError>,
    ) -> Result<(), VulkanError> {
        use vk::ImageLayout as Layout;
        self.barrier(commands, index, (Layout::UNDEFINED, Layout::COLOR_ATTACHMENT_OPTIMAL));
        let color = [vk::RenderingAttachmentInfo::default()
            .image_view(self.views[index])
            .image_layout(Layout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)];
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: self.extent };
        let info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&color);
        let raw = self.device.raw();
        // SAFETY: recording is open and outside of rendering; the image is in the layout that is stated.
        unsafe { raw.cmd_begin_rendering(commands, &info) };
        let drawn = draw(commands, [self.extent.width, self.extent.height]);
        // SAFETY: closes the rendering opened above.
        unsafe { raw.cmd_end_rendering(commands) };
        self.barrier(commands, index, (Layout::COLOR_ATTACHMENT_OPTIMAL, Layout::PRESENT_SRC_KHR));
        drawn
    }

    fn barrier(
        &self,
        commands: vk::CommandBuffer,
        index: usize,
        (before, after): (vk::ImageLayout, vk::ImageLayout),
    ) {
        let range = vk::ImageSubresourceRange::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .level_count(1)
            .layer_count(1);
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let barriers = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(all)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(before)
            .new_layout(after)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.images[index])
            .subresource_range(range)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: recording is open and outside of rendering, and the image is this chain's.
        unsafe { self.device.raw().cmd_pipeline_barrier2(commands, &info) };
    }
}
