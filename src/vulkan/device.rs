//! The one shared context: logical device, queue, memory and names.

use std::collections::BTreeMap;
use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::vk;

use super::error::{VkContext, VulkanError};
use super::instance::{Instance, Validation};
use super::memory::Memory;
use super::select::{self, Candidate, DeviceChoice, OptionalFeatures};

/// How to open a device. `Default` is the best suitable device, unvalidated.
#[derive(Clone, Debug, Default)]
pub struct DeviceOptions {
    /// Which device.
    pub choice: DeviceChoice,
    /// Whether calls are checked.
    pub validation: Validation,
    /// Instance extensions beyond those used here (a window's surface extensions).
    pub instance_extensions: Vec<CString>,
    /// Device extensions beyond Vulkan 1.3 (`VK_KHR_swapchain`).
    pub device_extensions: Vec<CString>,
}

/// A Vulkan device with its queue and memory, shared by everything made from it.
///
/// Buffers, images, pipelines and descriptor sets hold an `Arc<Device>` and free themselves when
/// dropped. `Send` and `Sync`: submission and allocation are serialised inside.
pub struct Device {
    raw: ash::Device,
    queue: Mutex<vk::Queue>,
    queue_family: u32,
    memory: Memory,
    candidate: Candidate,
    debug: Option<ash::ext::debug_utils::Device>,
    /// Last: the instance outlives the device.
    instance: Instance,
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Device({})", self.candidate.title())
    }
}

impl Device {
    /// Opens a device.
    ///
    /// # Errors
    /// No loader, driver or suitable device; an asked-for layer or extension that is missing; a
    /// validation error while opening.
    pub fn new(options: &DeviceOptions) -> Result<Arc<Self>, VulkanError> {
        let instance = Instance::new(options.validation, &options.instance_extensions)?;
        let candidates = select::enumerate(&instance.raw)?;
        let candidate = select::choose(&candidates, &options.choice)?.clone();
        let missing =
            |what: &str| VulkanError::MissingFeature { device: candidate.name.clone(), what: what.into() };
        let queue_family = candidate.queue_family.ok_or_else(|| missing("a graphics and compute queue"))?;
        check_extensions(&instance.raw, &candidate, &options.device_extensions)?;
        let raw = create_raw(&instance.raw, &candidate, queue_family, &options.device_extensions)?;
        // SAFETY: queue 0 of this family was requested at creation.
        let queue = unsafe { raw.get_device_queue(queue_family, 0) };
        let memory = match Memory::new(&instance.raw, &raw, &candidate) {
            Ok(memory) => memory,
            Err(error) => {
                // SAFETY: nothing was made from the device yet.
                unsafe { raw.destroy_device(None) };
                return Err(error);
            }
        };
        let debug = instance.debug_utils.then(|| ash::ext::debug_utils::Device::new(&instance.raw, &raw));
        let queue = Mutex::new(queue);
        let device = Arc::new(Self { raw, queue, queue_family, memory, candidate, debug, instance });
        tracing::info!("Vulkan device {} ({})", device.candidate.title(), device.driver());
        device.check_validation()?;
        Ok(device)
    }

    /// Destroys the device and everything under it.
    ///
    /// # Errors
    /// [`VulkanError::Leaked`] if resources are still alive (the device then lives on until they are
    /// dropped); [`VulkanError::Validation`] for errors not reported before, or raised by the
    /// destruction itself.
    pub fn shutdown(device: Arc<Self>) -> Result<(), VulkanError> {
        device.wait_idle()?;
        let live = device.memory.live();
        if !live.is_empty() {
            return Err(VulkanError::Leaked { resources: live });
        }
        let messages = device.instance.messages.clone();
        match Arc::try_unwrap(device) {
            Ok(device) => drop(device),
            Err(shared) => {
                let holders = Arc::strong_count(&shared) - 1;
                return Err(VulkanError::Leaked {
                    resources: vec![format!("the device ({holders} holders)")],
                });
            }
        }
        messages.check()
    }

    /// Errors of the validation layer since the last check; always good when validation is off.
    ///
    /// # Errors
    /// [`VulkanError::Validation`] with every message.
    pub fn check_validation(&self) -> Result<(), VulkanError> {
        self.instance.messages.check()
    }

    /// Waits until the device has nothing to do.
    ///
    /// # Errors
    /// Device lost or out of memory.
    pub fn wait_idle(&self) -> Result<(), VulkanError> {
        // Waiting touches every queue, so no submission may run meanwhile.
        let _queue = self.lock_queue();
        // SAFETY: the device lives, and its only queue is locked.
        unsafe { self.raw.device_wait_idle() }.during("waiting for the device")
    }

    /// Whether the validation layer checks this device.
    pub fn is_validated(&self) -> bool {
        self.instance.validated
    }

    /// Whether the device is the CPU (lavapipe): time there passes by submit and fence, and device
    /// memory is the host's.
    pub fn is_cpu(&self) -> bool {
        self.candidate.kind == vk::PhysicalDeviceType::CPU
    }

    /// The device's name, as the driver gives it.
    pub fn name(&self) -> &str {
        &self.candidate.name
    }

    /// The driver's name and version.
    pub fn driver(&self) -> &str {
        &self.candidate.driver
    }

    /// The device's place in the driver's list.
    pub fn index(&self) -> usize {
        self.candidate.index
    }

    /// The device's limits.
    pub fn limits(&self) -> &vk::PhysicalDeviceLimits {
        &self.candidate.limits
    }

    /// Optional features; each that is present is enabled.
    pub fn features(&self) -> OptionalFeatures {
        self.candidate.optional
    }

    /// Bytes of device memory in use, by resource name (resources of one name are summed).
    pub fn memory_bytes(&self) -> BTreeMap<String, u64> {
        self.memory.bytes_by_name()
    }

    /// Everything alive on this device: kind, name, bytes.
    pub fn live_resources(&self) -> Vec<String> {
        self.memory.live()
    }

    /// The logical device, for calls that have no wrapper here.
    pub fn raw(&self) -> &ash::Device {
        &self.raw
    }

    /// The loader's entry points (for a window's surface).
    pub fn entry(&self) -> &ash::Entry {
        &self.instance.entry
    }

    /// The instance (for a window's surface).
    pub fn instance(&self) -> &ash::Instance {
        &self.instance.raw
    }

    /// The physical device.
    pub fn physical(&self) -> vk::PhysicalDevice {
        self.candidate.handle
    }

    /// The family of the only queue: graphics, compute and transfer.
    pub fn queue_family(&self) -> u32 {
        self.queue_family
    }

    /// The queue, locked for as long as the guard lives: submit and present need that.
    pub fn lock_queue(&self) -> MutexGuard<'_, vk::Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn candidate(&self) -> &Candidate {
        &self.candidate
    }

    pub(crate) fn memory(&self) -> &Memory {
        &self.memory
    }

    pub(crate) fn debug_utils(&self) -> Option<&ash::ext::debug_utils::Device> {
        self.debug.as_ref()
    }

    /// Names a Vulkan object for validation messages and captures; does nothing without
    /// `VK_EXT_debug_utils`.
    pub fn set_name<H: vk::Handle>(&self, handle: H, name: &str) {
        let Some(debug) = &self.debug else { return };
        let name = c_text(name);
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle was created from this device by the caller, who also owns it, so no
        // other thread names it at the same time. A failure (out of memory) only loses the name.
        if let Err(result) = unsafe { debug.set_debug_utils_object_name(&info) } {
            tracing::warn!("naming `{}`: {result:?}", name.to_string_lossy());
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        if let Err(error) = self.wait_idle() {
            tracing::error!("closing the device: {error}");
        }
        let live = self.memory.live();
        if !live.is_empty() {
            tracing::error!("closing the device: {}", VulkanError::Leaked { resources: live });
        }
        self.memory.destroy();
        // SAFETY: every object made from the device holds an `Arc` of it, so none is left; the
        // memory blocks were returned just above, and the device is idle.
        unsafe { self.raw.destroy_device(None) };
    }
}

/// Text for Vulkan: ends at the first zero byte.
pub(crate) fn c_text(text: &str) -> CString {
    let end = text.find('\0').unwrap_or(text.len());
    CString::new(&text[..end]).unwrap_or_default()
}

fn check_extensions(
    instance: &ash::Instance,
    candidate: &Candidate,
    asked: &[CString],
) -> Result<(), VulkanError> {
    // SAFETY: the handle was listed by this live instance.
    let present = unsafe { instance.enumerate_device_extension_properties(candidate.handle) }
        .during("listing the device extensions")?;
    match asked.iter().find(|a| !present.iter().any(|p| p.extension_name_as_c_str() == Ok(a.as_c_str()))) {
        None => Ok(()),
        Some(absent) => Err(VulkanError::MissingFeature {
            device: candidate.name.clone(),
            what: format!("the extension {}", absent.to_string_lossy()),
        }),
    }
}

fn create_raw(
    instance: &ash::Instance,
    candidate: &Candidate,
    queue_family: u32,
    extensions: &[CString],
) -> Result<ash::Device, VulkanError> {
    let optional = candidate.optional;
    let core = vk::PhysicalDeviceFeatures::default()
        .tessellation_shader(true)
        .geometry_shader(true)
        .vertex_pipeline_stores_and_atomics(true)
        .pipeline_statistics_query(optional.pipeline_statistics)
        .multi_draw_indirect(optional.multi_draw_indirect)
        .draw_indirect_first_instance(optional.draw_indirect_first_instance)
        .fragment_stores_and_atomics(optional.fragment_stores_and_atomics)
        .shader_storage_image_extended_formats(optional.storage_image_extended_formats)
        .depth_clamp(optional.depth_clamp)
        .shader_float64(optional.shader_float64);
    let mut v11 =
        vk::PhysicalDeviceVulkan11Features::default().shader_draw_parameters(optional.shader_draw_parameters);
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default()
        .draw_indirect_count(optional.draw_indirect_count)
        .scalar_block_layout(optional.scalar_block_layout);
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true)
        // Every 1.3 device has it; glslang's 1.3 target makes it of `discard`.
        .shader_demote_to_helper_invocation(true)
        // Every 1.3 device has it; glslang's 1.3 target may use LocalSizeId.
        .maintenance4(true);
    let priorities = [1.0];
    let queues =
        [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&priorities)];
    let names: Vec<_> = extensions.iter().map(|e| e.as_ptr()).collect();
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&names)
        .enabled_features(&core)
        .push_next(&mut v11)
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: all pointers in `info` refer to locals that outlive the call; the features and
    // extensions were found on this device, and the queue family comes from its own list.
    unsafe { instance.create_device(candidate.handle, &info, None) }.map_err(|result| match result {
        vk::Result::ERROR_FEATURE_NOT_PRESENT | vk::Result::ERROR_EXTENSION_NOT_PRESENT => {
            VulkanError::MissingFeature {
                device: candidate.name.clone(),
                what: format!("a feature it claims to have ({result:?})"),
            }
        }
        result => VulkanError::from_vk(format!("opening device {}", candidate.title()), result),
    })
}
