//! Shader stages: SPIR-V words with their specialization constants.

use std::sync::Arc;

use ash::vk;

use super::device::Device;
use super::error::VulkanError;

const SPIRV_MAGIC: u32 = 0x0723_0203;

/// Values for `layout(constant_id = N)`, each 4 bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SpecializationConstants {
    entries: Vec<(u32, [u8; 4])>,
}

impl SpecializationConstants {
    /// None: every constant keeps its default.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets an unsigned integer. A later value for the same id replaces an earlier one.
    #[must_use]
    pub fn u32(self, id: u32, value: u32) -> Self {
        self.set(id, value.to_ne_bytes())
    }

    /// Sets a signed integer.
    #[must_use]
    pub fn i32(self, id: u32, value: i32) -> Self {
        self.set(id, value.to_ne_bytes())
    }

    /// Sets a float.
    #[must_use]
    pub fn f32(self, id: u32, value: f32) -> Self {
        self.set(id, value.to_ne_bytes())
    }

    /// Sets a boolean (32 bits in Vulkan).
    #[must_use]
    pub fn bool(self, id: u32, value: bool) -> Self {
        self.set(id, u32::from(value).to_ne_bytes())
    }

    fn set(mut self, id: u32, bytes: [u8; 4]) -> Self {
        self.entries.retain(|(other, _)| *other != id);
        self.entries.push((id, bytes));
        self
    }

    /// The word of this id, if it is set.
    pub(crate) fn word(&self, id: u32) -> Option<u32> {
        self.entries.iter().find(|(other, _)| *other == id).map(|(_, bytes)| u32::from_ne_bytes(*bytes))
    }

    fn map(&self) -> Vec<vk::SpecializationMapEntry> {
        let mut offset = 0;
        let mut map = Vec::with_capacity(self.entries.len());
        for (id, bytes) in &self.entries {
            map.push(vk::SpecializationMapEntry { constant_id: *id, offset, size: bytes.len() });
            offset += 4;
        }
        map
    }

    fn data(&self) -> Vec<u8> {
        self.entries.iter().flat_map(|(_, bytes)| *bytes).collect()
    }
}

/// One stage of a pipeline; the entry point is `main`.
#[derive(Clone, Copy, Debug)]
pub struct ShaderStage<'a> {
    /// Exactly one stage bit.
    pub stage: vk::ShaderStageFlags,
    /// SPIR-V in the host's byte order.
    pub spirv: &'a [u32],
    /// Constants for this stage; ids the shader does not declare are ignored.
    pub constants: &'a SpecializationConstants,
}

/// A stage made ready: its module lives until the pipeline exists.
pub(crate) struct ReadyStage {
    stage: vk::ShaderStageFlags,
    module: vk::ShaderModule,
    map: Vec<vk::SpecializationMapEntry>,
    data: Vec<u8>,
    device: Arc<Device>,
}

impl ReadyStage {
    pub(crate) fn new(
        device: &Arc<Device>,
        pipeline: &str,
        stage: &ShaderStage<'_>,
    ) -> Result<Self, VulkanError> {
        let what = || format!("{:?} shader of pipeline `{pipeline}`", stage.stage);
        if stage.spirv.len() < 5 || stage.spirv[0] != SPIRV_MAGIC {
            return Err(VulkanError::misuse(format!(
                "{} is not SPIR-V: expected the word {SPIRV_MAGIC:#010x} first, found {:#010x} in {} words",
                what(),
                stage.spirv.first().copied().unwrap_or(0),
                stage.spirv.len()
            )));
        }
        let info = vk::ShaderModuleCreateInfo::default().code(stage.spirv);
        // SAFETY: the words are a SPIR-V module by their header. They come from the compiler: of this crate's own
        // build, or of a text that a user edits, with the interface of the shader that it replaces. No file of
        // SPIR-V is ever read.
        let module = unsafe { device.raw().create_shader_module(&info, None) }
            .map_err(|r| VulkanError::from_vk(what(), r))?;
        device.set_name(module, &what());
        let (map, data) = (stage.constants.map(), stage.constants.data());
        Ok(Self { stage: stage.stage, module, map, data, device: device.clone() })
    }

    pub(crate) fn stage(&self) -> vk::ShaderStageFlags {
        self.stage
    }

    pub(crate) fn specialization(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.map).data(&self.data)
    }

    pub(crate) fn create_info<'a>(
        &'a self,
        specialization: &'a vk::SpecializationInfo<'a>,
    ) -> vk::PipelineShaderStageCreateInfo<'a> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(self.stage)
            .module(self.module)
            .name(c"main")
            .specialization_info(specialization)
    }
}

impl Drop for ReadyStage {
    fn drop(&mut self) {
        // SAFETY: a module may be destroyed once the pipelines made from it exist.
        unsafe { self.device.raw().destroy_shader_module(self.module, None) };
    }
}
