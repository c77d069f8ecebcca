//! What this machine's Vulkan offers, for `worsted doctor`. Never fails: what cannot be found out is
//! itself a finding.

use ash::vk;

use super::error::{INSTALL_DRIVER, INSTALL_LAYER, VulkanError};
use super::instance::{self, Instance, VALIDATION_LAYER, Validation, version_text};
use super::select::{self, Candidate, DeviceChoice};

/// Everything found.
#[derive(Clone, Debug, Default)]
pub struct DoctorReport {
    /// The loader's version (`1.3.239`), if there is a loader.
    pub loader: Option<String>,
    /// Every layer the loader knows.
    pub layers: Vec<LayerFacts>,
    /// Whether `VK_LAYER_KHRONOS_validation` is among them.
    pub validation_layer: bool,
    /// Every physical device, in the driver's order.
    pub devices: Vec<DeviceFacts>,
    /// Index into `devices` of the one that a run would use.
    pub chosen: Option<usize>,
    /// Why nothing would run, if so: one line with the fix.
    pub problem: Option<String>,
    /// Commands that install what is missing, most urgent first.
    pub fixes: Vec<String>,
    /// The exit code that a run would end with for want of a device: 0 if one would be used.
    pub exit_code: u8,
}

/// A layer of the loader.
#[derive(Clone, Debug)]
pub struct LayerFacts {
    /// `VK_LAYER_...`
    pub name: String,
    /// The Vulkan version it was written against.
    pub version: String,
    /// Its own words.
    pub description: String,
}

/// A physical device.
#[derive(Clone, Debug)]
pub struct DeviceFacts {
    /// Its place in the driver's list, as `--device` takes it.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    pub kind: &'static str,
    /// Its Vulkan version.
    pub api_version: String,
    /// Name and version of its driver.
    pub driver: String,
    /// Each requirement, and whether it is met.
    pub needs: Vec<(&'static str, bool)>,
    /// Each optional feature, and whether it is there.
    pub optional: Vec<(&'static str, bool)>,
    /// The limits that matter, by Vulkan name.
    pub limits: Vec<(&'static str, u64)>,
    /// Bytes of device-local memory.
    pub device_memory_bytes: u64,
}

impl DeviceFacts {
    /// The requirements that are not met; empty if the device is suitable.
    pub fn missing(&self) -> Vec<&'static str> {
        self.needs.iter().filter(|(_, met)| !met).map(|(name, _)| *name).collect()
    }
}

/// Looks at the loader, its layers and its devices, and at which would be used for `choice`.
pub fn inspect(choice: &DeviceChoice) -> DoctorReport {
    let mut report = DoctorReport::default();
    if let Err(error) = fill(&mut report, choice) {
        report.exit_code = error.exit_code();
        report.problem = Some(error.to_string());
        report.fixes.push(INSTALL_DRIVER.into());
    }
    if !report.validation_layer {
        report.fixes.push(INSTALL_LAYER.into());
    }
    report
}

fn fill(report: &mut DoctorReport, choice: &DeviceChoice) -> Result<(), VulkanError> {
    let entry = instance::load_entry()?;
    report.loader = Some(version_text(instance::loader_version(&entry)?));
    report.layers = instance::layers(&entry)?.iter().map(layer_facts).collect();
    report.validation_layer =
        report.layers.iter().any(|layer| layer.name.as_bytes() == VALIDATION_LAYER.to_bytes());
    let instance = Instance::new(Validation::Off, &[])?;
    let candidates = select::enumerate(&instance.raw)?;
    report.devices = candidates.iter().map(device_facts).collect();
    report.chosen = Some(select::choose(&candidates, choice)?.index);
    Ok(())
}

fn layer_facts(layer: &vk::LayerProperties) -> LayerFacts {
    let text = |text: Result<&std::ffi::CStr, _>| text.unwrap_or(c"").to_string_lossy().into_owned();
    LayerFacts {
        name: text(layer.layer_name_as_c_str()),
        version: version_text(layer.spec_version),
        description: text(layer.description_as_c_str()),
    }
}

fn device_facts(candidate: &Candidate) -> DeviceFacts {
    let heaps = candidate.memory.memory_heaps_as_slice().iter();
    let local = heaps.filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
    DeviceFacts {
        index: candidate.index,
        name: candidate.name.clone(),
        kind: select::kind_text(candidate.kind),
        api_version: version_text(candidate.api_version),
        driver: candidate.driver.clone(),
        needs: candidate.needs.clone(),
        optional: optional_facts(candidate),
        limits: limit_facts(candidate),
        device_memory_bytes: local.map(|heap| heap.size).sum(),
    }
}

fn optional_facts(candidate: &Candidate) -> Vec<(&'static str, bool)> {
    let optional = &candidate.optional;
    vec![
        ("pipelineStatisticsQuery", optional.pipeline_statistics),
        ("multiDrawIndirect", optional.multi_draw_indirect),
        ("drawIndirectFirstInstance", optional.draw_indirect_first_instance),
        ("drawIndirectCount", optional.draw_indirect_count),
        ("shaderDrawParameters", optional.shader_draw_parameters),
        ("fragmentStoresAndAtomics", optional.fragment_stores_and_atomics),
        ("shaderStorageImageExtendedFormats", optional.storage_image_extended_formats),
        ("scalarBlockLayout", optional.scalar_block_layout),
        ("depthClamp", optional.depth_clamp),
        ("shaderFloat64", optional.shader_float64),
    ]
}

fn limit_facts(candidate: &Candidate) -> Vec<(&'static str, u64)> {
    let limits = &candidate.limits;
    let counts = limits.framebuffer_color_sample_counts & limits.framebuffer_depth_sample_counts;
    let samples = 1_u64.checked_shl(31 - counts.as_raw().max(1).leading_zeros()).unwrap_or(1);
    vec![
        ("maxStorageBufferRange", limits.max_storage_buffer_range.into()),
        ("maxUniformBufferRange", limits.max_uniform_buffer_range.into()),
        ("maxBufferSize", candidate.max_buffer_bytes),
        ("maxMemoryAllocationSize", candidate.max_allocation_bytes),
        ("maxPushConstantsSize", limits.max_push_constants_size.into()),
        ("maxImageDimension2D", limits.max_image_dimension2_d.into()),
        ("maxImageDimension3D", limits.max_image_dimension3_d.into()),
        ("maxTessellationGenerationLevel", limits.max_tessellation_generation_level.into()),
        ("maxGeometryOutputVertices", limits.max_geometry_output_vertices.into()),
        ("maxComputeWorkGroupInvocations", limits.max_compute_work_group_invocations.into()),
        ("maxSamples", samples),
    ]
}
