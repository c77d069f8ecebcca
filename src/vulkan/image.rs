//! Images and views of them.

use std::sync::Arc;

use ash::vk;

use super::device::Device;
use super::error::VulkanError;
use super::memory::BoundMemory;

/// What an image is. `Default` is a 1x1 `R8G8B8A8_UNORM` image with one sample and no use.
#[derive(Clone, Copy, Debug)]
pub struct ImageInfo<'a> {
    /// Name for captures, reports and errors.
    pub name: &'a str,
    /// Texel format; depth formats are seen as depth.
    pub format: vk::Format,
    /// Width, height and depth in texels, each at least 1. A depth above 1 makes a 3D image.
    pub extent: [u32; 3],
    /// Forces a 3D image at depth 1 as well, for a shader that declares `sampler3D`.
    pub volume: bool,
    /// Array layers, at least 1; above 1 the view is a 2D array.
    pub layers: u32,
    /// Mip levels, at least 1.
    pub mip_levels: u32,
    /// Samples per texel.
    pub samples: vk::SampleCountFlags,
    /// What it may be used for.
    pub usage: vk::ImageUsageFlags,
}

impl Default for ImageInfo<'_> {
    fn default() -> Self {
        Self {
            name: "image",
            format: vk::Format::R8G8B8A8_UNORM,
            extent: [1, 1, 1],
            volume: false,
            layers: 1,
            mip_levels: 1,
            samples: vk::SampleCountFlags::TYPE_1,
            usage: vk::ImageUsageFlags::empty(),
        }
    }
}

/// An image with its memory and a view of all of it. Clones share it.
#[derive(Clone)]
pub struct Image {
    pub(crate) inner: Arc<ImageInner>,
    view: ImageView,
}

pub(crate) struct ImageInner {
    raw: vk::Image,
    name: String,
    format: vk::Format,
    extent: [u32; 3],
    volume: bool,
    layers: u32,
    mip_levels: u32,
    samples: vk::SampleCountFlags,
    usage: vk::ImageUsageFlags,
    /// `None` only while the image is being made.
    memory: Option<BoundMemory>,
    device: Arc<Device>,
}

impl Drop for ImageInner {
    fn drop(&mut self) {
        // SAFETY: views and recorded commands hold the image, so nothing uses it any more. Its
        // memory is freed after this body.
        unsafe { self.device.raw().destroy_image(self.raw, None) };
    }
}

/// A view of some mip levels and layers of an image. Clones share it; it keeps its image alive.
#[derive(Clone)]
pub struct ImageView {
    pub(crate) inner: Arc<ViewInner>,
}

pub(crate) struct ViewInner {
    raw: vk::ImageView,
    image: Arc<ImageInner>,
}

impl Drop for ViewInner {
    fn drop(&mut self) {
        // SAFETY: descriptor sets and recorded commands hold the view, so nothing uses it any more.
        unsafe { self.image.device.raw().destroy_image_view(self.raw, None) };
    }
}

/// Depth for depth formats, colour for all others; stencil is not used.
fn aspect_of(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D32_SFLOAT => {
            vk::ImageAspectFlags::DEPTH
        }
        _ => vk::ImageAspectFlags::COLOR,
    }
}

fn has_stencil(format: vk::Format) -> bool {
    use vk::Format as F;
    matches!(format, F::S8_UINT | F::D16_UNORM_S8_UINT | F::D24_UNORM_S8_UINT | F::D32_SFLOAT_S8_UINT)
}

impl Image {
    /// An image with undefined contents, in layout `UNDEFINED`.
    ///
    /// # Errors
    /// [`VulkanError::TooLarge`] or [`VulkanError::MissingFeature`] if the device cannot make it;
    /// [`VulkanError::Misuse`] for a size of 0; [`VulkanError::OutOfMemory`].
    pub fn new(device: &Arc<Device>, info: &ImageInfo<'_>) -> Result<Self, VulkanError> {
        let volume = info.volume || info.extent[2] > 1;
        check(device, info, volume)?;
        let [width, height, depth] = info.extent;
        let create = vk::ImageCreateInfo::default()
            .image_type(if volume { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D })
            .format(info.format)
            .extent(vk::Extent3D { width, height, depth })
            .mip_levels(info.mip_levels)
            .array_layers(info.layers)
            .samples(info.samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(info.usage)
            .sharing_mode(vk::SharingMode::EXCLUSIVE)
            .initial_layout(vk::ImageLayout::UNDEFINED);
        // SAFETY: `check` asked the device whether it can make exactly this image.
        let raw = unsafe { device.raw().create_image(&create, None) }
            .map_err(|r| VulkanError::from_vk(format!("image `{}`", info.name), r))?;
        device.set_name(raw, info.name);
        // From here on `inner` destroys the image, also when binding fails.
        let mut inner = ImageInner {
            raw,
            name: info.name.into(),
            format: info.format,
            extent: info.extent,
            volume,
            layers: info.layers,
            mip_levels: info.mip_levels,
            samples: info.samples,
            usage: info.usage,
            memory: None,
            device: device.clone(),
        };
        inner.memory = Some(BoundMemory::for_image(device, info.name, raw)?);
        let inner = Arc::new(inner);
        let view = ImageView::new(&inner, 0..info.mip_levels, 0..info.layers)?;
        Ok(Self { inner, view })
    }

    /// The view of the whole image.
    pub fn view(&self) -> &ImageView {
        &self.view
    }

    /// A view of one mip level of one layer, for rendering or storing into it.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if there is no such level or layer.
    pub fn subview(&self, mip_level: u32, layer: u32) -> Result<ImageView, VulkanError> {
        if mip_level >= self.inner.mip_levels || layer >= self.inner.layers {
            return Err(VulkanError::misuse(format!(
                "image `{}` has {} mip levels and {} layers; level {mip_level}, layer {layer} asked for",
                self.name(),
                self.inner.mip_levels,
                self.inner.layers
            )));
        }
        ImageView::new(&self.inner, mip_level..mip_level + 1, layer..layer + 1)
    }

    /// The name it was made with.
    pub fn name(&self) -> &str {
        &self.inner.name
    }

    /// Texel format.
    pub fn format(&self) -> vk::Format {
        self.inner.format
    }

    /// Width, height and depth in texels.
    pub fn extent(&self) -> [u32; 3] {
        self.inner.extent
    }

    /// Array layers.
    pub fn layers(&self) -> u32 {
        self.inner.layers
    }

    /// Mip levels.
    pub fn mip_levels(&self) -> u32 {
        self.inner.mip_levels
    }

    /// Samples per texel.
    pub fn samples(&self) -> vk::SampleCountFlags {
        self.inner.samples
    }

    /// What it may be used for.
    pub fn usage(&self) -> vk::ImageUsageFlags {
        self.inner.usage
    }

    /// Depth or colour.
    pub fn aspect(&self) -> vk::ImageAspectFlags {
        aspect_of(self.inner.format)
    }

    /// All mip levels and layers.
    pub fn full_range(&self) -> vk::ImageSubresourceRange {
        range(&self.inner, 0..self.inner.mip_levels, 0..self.inner.layers)
    }

    /// The Vulkan handle, for calls that have no wrapper here.
    pub fn raw(&self) -> vk::Image {
        self.inner.raw
    }

    pub(crate) fn device(&self) -> &Arc<Device> {
        &self.inner.device
    }
}

impl ImageView {
    fn new(
        image: &Arc<ImageInner>,
        mips: std::ops::Range<u32>,
        layers: std::ops::Range<u32>,
    ) -> Result<Self, VulkanError> {
        let kind = if image.volume {
            vk::ImageViewType::TYPE_3D
        } else if layers.len() > 1 {
            vk::ImageViewType::TYPE_2D_ARRAY
        } else {
            vk::ImageViewType::TYPE_2D
        };
        let create = vk::ImageViewCreateInfo::default()
            .image(image.raw)
            .view_type(kind)
            .format(image.format)
            .subresource_range(range(image, mips, layers));
        // SAFETY: the image is alive and bound, and the range lies in it (callers check).
        let raw = unsafe { image.device.raw().create_image_view(&create, None) }
            .map_err(|r| VulkanError::from_vk(format!("view of image `{}`", image.name), r))?;
        image.device.set_name(raw, &image.name);
        Ok(Self { inner: Arc::new(ViewInner { raw, image: image.clone() }) })
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::ImageView {
        self.inner.raw
    }

    pub(crate) fn image_name(&self) -> &str {
        &self.inner.image.name
    }
}

fn range(
    image: &ImageInner,
    mips: std::ops::Range<u32>,
    layers: std::ops::Range<u32>,
) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default()
        .aspect_mask(aspect_of(image.format))
        .base_mip_level(mips.start)
        .level_count(mips.end - mips.start)
        .base_array_layer(layers.start)
        .layer_count(layers.end - layers.start)
}

/// Asks the device whether it can make this image, so that the answer names what is wrong.
fn check(device: &Device, info: &ImageInfo<'_>, volume: bool) -> Result<(), VulkanError> {
    let what = || format!("image `{}`", info.name);
    if info.extent.contains(&0) || info.layers == 0 || info.mip_levels == 0 || info.usage.is_empty() {
        let size = format!("{:?}, {} layers, {} mip levels", info.extent, info.layers, info.mip_levels);
        return Err(VulkanError::misuse(format!(
            "{} needs a size and a usage: {size}, {:?}",
            what(),
            info.usage
        )));
    }
    if has_stencil(info.format) {
        return Err(VulkanError::misuse(format!(
            "{}: stencil formats are not used: {:?}",
            what(),
            info.format
        )));
    }
    let limits = device.limits();
    let (limit_name, limit) = if volume {
        ("maxImageDimension3D", limits.max_image_dimension3_d)
    } else {
        ("maxImageDimension2D", limits.max_image_dimension2_d)
    };
    let largest = info.extent.into_iter().max().unwrap_or(0);
    let too_large = |asked: u32, limit_name, limit: u32| {
        Err(VulkanError::TooLarge { what: what(), asked: asked.into(), limit_name, limit: limit.into() })
    };
    if largest > limit {
        return too_large(largest, limit_name, limit);
    }
    if info.layers > limits.max_image_array_layers {
        return too_large(info.layers, "maxImageArrayLayers", limits.max_image_array_layers);
    }
    let found = offered(device, info, volume)?;
    if !found.sample_counts.contains(info.samples) {
        let lacking = format!("{:?} samples in {:?} ({})", info.samples, info.format, what());
        return Err(VulkanError::MissingFeature { device: device.name().into(), what: lacking });
    }
    if info.mip_levels > found.max_mip_levels {
        return too_large(info.mip_levels, "maxMipLevels", found.max_mip_levels);
    }
    Ok(())
}

/// What the device offers for this format and usage.
fn offered(
    device: &Device,
    info: &ImageInfo<'_>,
    volume: bool,
) -> Result<vk::ImageFormatProperties, VulkanError> {
    let kind = if volume { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D };
    // SAFETY: the physical device belongs to the live instance.
    let found = unsafe {
        device.instance().get_physical_device_image_format_properties(
            device.physical(),
            info.format,
            kind,
            vk::ImageTiling::OPTIMAL,
            info.usage,
            vk::ImageCreateFlags::empty(),
        )
    };
    found.map_err(|result| match result {
        vk::Result::ERROR_FORMAT_NOT_SUPPORTED => VulkanError::MissingFeature {
            device: device.name().into(),
            what: format!(
                "{kind:?} images of {:?} used as {:?} (image `{}`)",
                info.format, info.usage, info.name
            ),
        },
        result => VulkanError::from_vk(format!("image `{}`", info.name), result),
    })
}
