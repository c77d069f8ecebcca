//! Which of the machine's devices will run the renderer, and why the others cannot.

use std::convert::Infallible;
use std::str::FromStr;

use ash::vk;

use super::error::{VkContext, VulkanError};
use super::instance::version_text;

/// Which device to use.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum DeviceChoice {
    /// The best suitable one: discrete, then integrated, then virtual, then CPU; ties by index.
    #[default]
    Auto,
    /// The device at this place in the driver's list.
    Index(usize),
    /// The best suitable device whose name contains this text, in any case.
    Name(String),
    /// A CPU device (lavapipe), which gives the same picture everywhere.
    Software,
}

impl FromStr for DeviceChoice {
    type Err = Infallible;

    /// `auto`, `software`, a number, or part of a name.
    fn from_str(text: &str) -> Result<Self, Infallible> {
        let text = text.trim();
        Ok(match text.to_lowercase().as_str() {
            "" | "auto" => Self::Auto,
            "software" => Self::Software,
            _ => text.parse().map(Self::Index).unwrap_or_else(|_| Self::Name(text.into())),
        })
    }
}

impl std::fmt::Display for DeviceChoice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Index(index) => write!(f, "{index}"),
            Self::Name(name) => f.write_str(name),
            Self::Software => f.write_str("software"),
        }
    }
}

/// Features that are used where present; the renderer works without each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OptionalFeatures {
    /// Counters of shader invocations and clipped primitives.
    pub pipeline_statistics: bool,
    /// More than one draw per indirect command.
    pub multi_draw_indirect: bool,
    /// A first instance other than 0 in indirect draws.
    pub draw_indirect_first_instance: bool,
    /// The number of indirect draws read from a buffer.
    pub draw_indirect_count: bool,
    /// `gl_DrawID`, `gl_BaseVertex` and `gl_BaseInstance`.
    pub shader_draw_parameters: bool,
    /// Storage writes and atomics in fragment shaders.
    pub fragment_stores_and_atomics: bool,
    /// Storage images in the extended formats (r16f, rg32f ...).
    pub storage_image_extended_formats: bool,
    /// Structures packed without padding (`layout(scalar)`).
    pub scalar_block_layout: bool,
    /// Depth clamping instead of near and far clipping.
    pub depth_clamp: bool,
    /// Doubles in shaders.
    pub shader_float64: bool,
}

/// A physical device with everything selection and `worsted doctor` want to know.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    pub(crate) index: usize,
    pub(crate) handle: vk::PhysicalDevice,
    pub(crate) name: String,
    pub(crate) kind: vk::PhysicalDeviceType,
    pub(crate) api_version: u32,
    pub(crate) driver: String,
    pub(crate) limits: vk::PhysicalDeviceLimits,
    pub(crate) max_buffer_bytes: u64,
    pub(crate) max_allocation_bytes: u64,
    pub(crate) memory: vk::PhysicalDeviceMemoryProperties,
    pub(crate) pipeline_cache_uuid: [u8; vk::UUID_SIZE],
    pub(crate) vendor_id: u32,
    pub(crate) device_id: u32,
    pub(crate) optional: OptionalFeatures,
    /// Every requirement by name, and whether it is met.
    pub(crate) needs: Vec<(&'static str, bool)>,
    pub(crate) queue_family: Option<u32>,
}

impl Candidate {
    /// `0: llvmpipe (LLVM 15.0.6, 256 bits) (cpu)`
    pub(crate) fn title(&self) -> String {
        format!("{}: {} ({})", self.index, self.name, kind_text(self.kind))
    }

    /// What is missing, or `None` if the device is suitable.
    fn rejection(&self) -> Option<String> {
        let missing: Vec<_> = self.needs.iter().filter(|(_, met)| !met).map(|(name, _)| *name).collect();
        if missing.is_empty() { None } else { Some(format!("{} lacks {}", self.title(), missing.join(", "))) }
    }
}

/// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
pub(crate) fn kind_text(kind: vk::PhysicalDeviceType) -> &'static str {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
        vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
        vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
        vk::PhysicalDeviceType::CPU => "cpu",
        _ => "other",
    }
}

fn rank(kind: vk::PhysicalDeviceType) -> u32 {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => 0,
        vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
        vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
        vk::PhysicalDeviceType::CPU => 3,
        _ => 4,
    }
}

/// Asks every physical device what it is and what it can do.
pub(crate) fn enumerate(instance: &ash::Instance) -> Result<Vec<Candidate>, VulkanError> {
    // SAFETY: the instance is alive for the length of this borrow.
    let devices = match unsafe { instance.enumerate_physical_devices() } {
        // Some loaders answer so when every driver failed to start.
        Err(result @ vk::Result::ERROR_INITIALIZATION_FAILED) => {
            return Err(VulkanError::NoDriver { reason: format!("listing the devices: {result:?}") });
        }
        devices => devices.during("listing the devices")?,
    };
    if devices.is_empty() {
        return Err(VulkanError::NoDriver { reason: "the list of devices is empty".into() });
    }
    Ok(devices.iter().enumerate().map(|(index, &handle)| examine(instance, index, handle)).collect())
}

fn examine(instance: &ash::Instance, index: usize, handle: vk::PhysicalDevice) -> Candidate {
    // SAFETY: the handle was just listed by this live instance. This query exists in every version.
    let base = unsafe { instance.get_physical_device_properties(handle) };
    let modern = base.api_version >= vk::API_VERSION_1_3;
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut maintenance3 = vk::PhysicalDeviceMaintenance3Properties::default();
    let mut maintenance4 = vk::PhysicalDeviceMaintenance4Properties::default();
    if modern {
        let mut all = vk::PhysicalDeviceProperties2::default()
            .push_next(&mut driver)
            .push_next(&mut maintenance3)
            .push_next(&mut maintenance4);
        // SAFETY: a 1.3 device knows each of the chained structures.
        unsafe { instance.get_physical_device_properties2(handle, &mut all) };
    }
    // SAFETY: as above.
    let memory = unsafe { instance.get_physical_device_memory_properties(handle) };
    let queue_family = find_queue_family(instance, handle);
    let (mut needs, optional) = features(instance, handle, modern);
    needs.insert(0, ("Vulkan 1.3", modern));
    needs.push(("a queue with graphics and compute", queue_family.is_some()));
    // Shaders know by them where in a pixel a thin fiber is seen: glsl/passes/covered.glsl.
    needs.push(("the standard sample locations", base.limits.standard_sample_locations == vk::TRUE));
    Candidate {
        index,
        handle,
        name: base.device_name_as_c_str().unwrap_or(c"unnamed").to_string_lossy().into_owned(),
        kind: base.device_type,
        api_version: base.api_version,
        driver: driver_text(&driver, base.driver_version),
        limits: base.limits,
        max_buffer_bytes: maintenance4.max_buffer_size,
        max_allocation_bytes: maintenance3.max_memory_allocation_size,
        memory,
        pipeline_cache_uuid: base.pipeline_cache_uuid,
        vendor_id: base.vendor_id,
        device_id: base.device_id,
        optional,
        needs,
        queue_family,
    }
}

fn driver_text(driver: &vk::PhysicalDeviceDriverProperties<'_>, version: u32) -> String {
    let name = driver.driver_name_as_c_str().unwrap_or(c"").to_string_lossy().into_owned();
    let info = driver.driver_info_as_c_str().unwrap_or(c"").to_string_lossy().into_owned();
    let text = format!("{name} {info}").trim().to_string();
    if text.is_empty() { format!("driver version {}", version_text(version)) } else { text }
}

/// The first family with graphics and compute; both imply transfer.
fn find_queue_family(instance: &ash::Instance, handle: vk::PhysicalDevice) -> Option<u32> {
    // SAFETY: the handle belongs to this live instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(handle) };
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    let found = families.iter().position(|f| f.queue_count > 0 && f.queue_flags.contains(both));
    found.and_then(|place| u32::try_from(place).ok())
}

fn features(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
    modern: bool,
) -> (Vec<(&'static str, bool)>, OptionalFeatures) {
    let mut v11 = vk::PhysicalDeviceVulkan11Features::default();
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    // SAFETY: the handle belongs to this live instance.
    let mut core = unsafe { instance.get_physical_device_features(handle) };
    if modern {
        let mut all = vk::PhysicalDeviceFeatures2::default()
            .push_next(&mut v11)
            .push_next(&mut v12)
            .push_next(&mut v13);
        // SAFETY: a 1.3 device knows each of the chained structures.
        unsafe { instance.get_physical_device_features2(handle, &mut all) };
        core = all.features;
    }
    let yes = |flag: vk::Bool32| flag == vk::TRUE;
    let needs = vec![
        ("tessellationShader", yes(core.tessellation_shader)),
        ("geometryShader", yes(core.geometry_shader)),
        ("vertexPipelineStoresAndAtomics", yes(core.vertex_pipeline_stores_and_atomics)),
        ("dynamicRendering", yes(v13.dynamic_rendering)),
        ("synchronization2", yes(v13.synchronization2)),
    ];
    let optional = OptionalFeatures {
        pipeline_statistics: yes(core.pipeline_statistics_query),
        multi_draw_indirect: yes(core.multi_draw_indirect),
        draw_indirect_first_instance: yes(core.draw_indirect_first_instance),
        draw_indirect_count: yes(v12.draw_indirect_count),
        shader_draw_parameters: yes(v11.shader_draw_parameters),
        fragment_stores_and_atomics: yes(core.fragment_stores_and_atomics),
        storage_image_extended_formats: yes(core.shader_storage_image_extended_formats),
        scalar_block_layout: yes(v12.scalar_block_layout),
        depth_clamp: yes(core.depth_clamp),
        shader_float64: yes(core.shader_float64),
    };
    (needs, optional)
}

/// Picks one candidate.
///
/// # Errors
/// [`VulkanError::DeviceNotFound`] if nothing matches the choice, [`VulkanError::NoSuitableDevice`]
/// if what matches cannot run the renderer.
pub(crate) fn choose<'a>(
    candidates: &'a [Candidate],
    choice: &DeviceChoice,
) -> Result<&'a Candidate, VulkanError> {
    let matches = |candidate: &Candidate| match choice {
        DeviceChoice::Auto => true,
        DeviceChoice::Index(index) => candidate.index == *index,
        DeviceChoice::Name(part) => candidate.name.to_lowercase().contains(&part.to_lowercase()),
        DeviceChoice::Software => candidate.kind == vk::PhysicalDeviceType::CPU,
    };
    let mut matching: Vec<_> = candidates.iter().filter(|c| matches(c)).collect();
    if matching.is_empty() {
        let available = candidates.iter().map(Candidate::title).collect();
        return Err(VulkanError::DeviceNotFound { asked: choice.to_string(), available });
    }
    matching.sort_by_key(|c| (rank(c.kind), c.index));
    let reasons: Vec<String> = matching.iter().filter_map(|c| c.rejection()).collect();
    for reason in &reasons {
        tracing::debug!("Vulkan device {reason}");
    }
    matching.into_iter().find(|c| c.rejection().is_none()).ok_or(VulkanError::NoSuitableDevice { reasons })
}

#[cfg(test)]
#[path = "select_tests.rs"]
mod tests;
