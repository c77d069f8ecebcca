//! Graphics and compute pipelines, and the cache that makes the next start faster.

use std::sync::Arc;

use ash::vk;

use super::descriptors::{DescriptorLayout, Kept};
use super::device::Device;
use super::error::VulkanError;
use super::memory::Ticket;
use super::pipeline_cache::PipelineCache;
use super::shader::{ReadyStage, ShaderStage};

/// How a fragment's colour meets what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Blend {
    /// Replaces it.
    #[default]
    Replace,
    /// Adds to it.
    Add,
    /// Lies over it; the colour is already multiplied by its alpha.
    PremultipliedOver,
}

/// Depth test and write.
#[derive(Clone, Copy, Debug)]
pub struct DepthState {
    /// Format of the depth attachment.
    pub format: vk::Format,
    /// `GREATER` for reversed Z.
    pub compare: vk::CompareOp,
    /// Whether fragments that pass are written.
    pub write: bool,
    /// Constant (in units of the format) and slope factor added to the depth, for shadow maps.
    pub bias: Option<(f32, f32)>,
}

/// A graphics pipeline for dynamic rendering, without vertex input (shaders pull from buffers).
/// Viewport and scissor are dynamic.
#[derive(Clone, Copy)]
pub struct GraphicsPipelineInfo<'a> {
    /// Name for captures, reports and errors.
    pub name: &'a str,
    /// One stage each; vertex at least.
    pub stages: &'a [ShaderStage<'a>],
    /// `PATCH_LIST` exactly if there are tessellation stages.
    pub topology: vk::PrimitiveTopology,
    /// Control points per patch; used with `PATCH_LIST` only.
    pub patch_control_points: u32,
    /// Formats of the colour attachments, in order; empty for depth only.
    pub color_formats: &'a [vk::Format],
    /// Depth attachment, if any.
    pub depth: Option<DepthState>,
    /// Samples of every attachment.
    pub samples: vk::SampleCountFlags,
    /// Faces left out; none by default, since fibers and ribbons have two sides.
    pub cull: vk::CullModeFlags,
    /// Blending of every colour attachment.
    pub blend: Blend,
    /// Layouts of set 0, 1 ...
    pub set_layouts: &'a [&'a DescriptorLayout],
    /// Bytes of push constants (a multiple of 4; 128 work everywhere), seen by every stage.
    pub push_constant_bytes: u32,
    /// Cache of compiled pipelines.
    pub cache: Option<&'a PipelineCache>,
}

impl Default for GraphicsPipelineInfo<'_> {
    fn default() -> Self {
        Self {
            name: "pipeline",
            stages: &[],
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            patch_control_points: 1,
            color_formats: &[],
            depth: None,
            samples: vk::SampleCountFlags::TYPE_1,
            cull: vk::CullModeFlags::NONE,
            blend: Blend::Replace,
            set_layouts: &[],
            push_constant_bytes: 0,
            cache: None,
        }
    }
}

/// A compute pipeline.
#[derive(Clone, Copy)]
pub struct ComputePipelineInfo<'a> {
    /// Name for captures, reports and errors.
    pub name: &'a str,
    /// SPIR-V of the shader.
    pub spirv: &'a [u32],
    /// Its constants.
    pub constants: &'a super::shader::SpecializationConstants,
    /// Layouts of set 0, 1 ...
    pub set_layouts: &'a [&'a DescriptorLayout],
    /// Bytes of push constants (a multiple of 4; 128 work everywhere).
    pub push_constant_bytes: u32,
    /// Cache of compiled pipelines.
    pub cache: Option<&'a PipelineCache>,
}

/// A pipeline with its layout. Clones share it.
#[derive(Clone)]
pub struct Pipeline {
    pub(crate) inner: Arc<PipelineInner>,
}

pub(crate) struct PipelineInner {
    raw: vk::Pipeline,
    layout: vk::PipelineLayout,
    name: String,
    bind_point: vk::PipelineBindPoint,
    push: Option<(vk::ShaderStageFlags, u32)>,
    _set_layouts: Vec<Kept>,
    ticket: Ticket,
}

impl Drop for PipelineInner {
    fn drop(&mut self) {
        let device = self.ticket.device().raw();
        // SAFETY: recorded commands hold the pipeline until their fence has passed.
        unsafe {
            device.destroy_pipeline(self.raw, None);
            device.destroy_pipeline_layout(self.layout, None);
        }
    }
}

/// A pipeline whose layout exists; the pipeline itself follows.
fn begin(
    device: &Arc<Device>,
    name: &str,
    bind_point: vk::PipelineBindPoint,
    set_layouts: &[&DescriptorLayout],
    push: Option<(vk::ShaderStageFlags, u32)>,
) -> Result<PipelineInner, VulkanError> {
    let limits = device.limits();
    if let Some((_, bytes)) = push {
        let limit = limits.max_push_constants_size;
        if !bytes.is_multiple_of(4) {
            let what = format!("pipeline `{name}`: {bytes} bytes of push constants are not whole words");
            return Err(VulkanError::misuse(what));
        }
        if bytes > limit {
            return Err(VulkanError::TooLarge {
                what: format!("push constants of pipeline `{name}`"),
                asked: bytes.into(),
                limit_name: "maxPushConstantsSize",
                limit: limit.into(),
            });
        }
    }
    let layouts: Vec<_> = set_layouts.iter().map(|l| l.raw()).collect();
    let ranges: Vec<_> = push
        .iter()
        .map(|&(stages, bytes)| vk::PushConstantRange::default().stage_flags(stages).size(bytes))
        .collect();
    let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&ranges);
    // SAFETY: the set layouts are alive and kept below; the range is within the limit.
    let layout = unsafe { device.raw().create_pipeline_layout(&info, None) }
        .map_err(|r| VulkanError::from_vk(format!("layout of pipeline `{name}`"), r))?;
    device.set_name(layout, name);
    Ok(PipelineInner {
        // Destroying the null handle is allowed, so a failure from here on frees the layout.
        raw: vk::Pipeline::null(),
        layout,
        name: name.into(),
        bind_point,
        push,
        _set_layouts: set_layouts.iter().map(|l| l.inner.clone() as Kept).collect(),
        ticket: Ticket::new(device, "pipeline", name, 0),
    })
}

fn raw_cache(cache: Option<&PipelineCache>) -> vk::PipelineCache {
    cache.map(PipelineCache::raw).unwrap_or_default()
}

/// Takes the one pipeline that was asked for.
fn finish(
    mut inner: PipelineInner,
    device: &Device,
    created: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
) -> Result<Pipeline, VulkanError> {
    let pipelines = created.map_err(|(_, result)| {
        VulkanError::from_vk(format!("compiling pipeline `{}`", inner.name), result)
    })?;
    inner.raw = pipelines.first().copied().unwrap_or_default();
    device.set_name(inner.raw, &inner.name);
    Ok(Pipeline { inner: Arc::new(inner) })
}

impl Pipeline {
    /// Whether anything beside this clone holds the pipeline.
    pub fn is_shared(&self) -> bool {
        Arc::strong_count(&self.inner) > 1
    }

    /// Compiles a compute pipeline.
    ///
    /// # Errors
    /// [`VulkanError::Misuse`] if the words are not SPIR-V, [`VulkanError::TooLarge`] for push
    /// constants, out of memory; faults of the shader itself are found by the validation layer.
    pub fn compute(device: &Arc<Device>, info: &ComputePipelineInfo<'_>) -> Result<Self, VulkanError> {
        let stage = vk::ShaderStageFlags::COMPUTE;
        let stage = ShaderStage { stage, spirv: info.spirv, constants: info.constants };
        let stage = ReadyStage::new(device, info.name, &stage)?;
        let push = (info.push_constant_bytes > 0).then_some((stage.stage(), info.push_constant_bytes));
        let inner = begin(device, info.name, vk::PipelineBindPoint::COMPUTE, info.set_layouts, push)?;
        let specialization = stage.specialization();
        let create = vk::ComputePipelineCreateInfo::default()
            .stage(stage.create_info(&specialization))
            .layout(inner.layout);
        // SAFETY: module, layout and cache are alive for the call.
        let created =
            unsafe { device.raw().create_compute_pipelines(raw_cache(info.cache), &[create], None) };
        finish(inner, device, created)
    }

    /// Compiles a graphics pipeline.
    ///
    /// # Errors
    /// As [`Self::compute`]; [`VulkanError::Misuse`] also for stages that do not fit the topology.
    pub fn graphics(device: &Arc<Device>, info: &GraphicsPipelineInfo<'_>) -> Result<Self, VulkanError> {
        let present = check_stages(device, info)?;
        let stages: Vec<_> =
            info.stages.iter().map(|s| ReadyStage::new(device, info.name, s)).collect::<Result<_, _>>()?;
        let push = (info.push_constant_bytes > 0).then_some((present, info.push_constant_bytes));
        let inner = begin(device, info.name, vk::PipelineBindPoint::GRAPHICS, info.set_layouts, push)?;
        let specializations: Vec<_> = stages.iter().map(ReadyStage::specialization).collect();
        let stage_infos: Vec<_> =
            stages.iter().zip(&specializations).map(|(stage, spec)| stage.create_info(spec)).collect();
        let blend = vec![blend_state(info.blend); info.color_formats.len()];
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(info.topology);
        let tessellation = vk::PipelineTessellationStateCreateInfo::default()
            .patch_control_points(info.patch_control_points);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = raster_state(info);
        let samples = vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(info.samples);
        let depth = depth_state(info.depth);
        let blending = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blend);
        let dynamic_state = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(info.color_formats)
            .depth_attachment_format(info.depth.map_or(vk::Format::UNDEFINED, |d| d.format));
        let mut create = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stage_infos)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blending)
            .dynamic_state(&dynamic_state)
            .layout(inner.layout)
            .push_next(&mut rendering);
        if info.topology == vk::PrimitiveTopology::PATCH_LIST {
            create = create.tessellation_state(&tessellation);
        }
        // SAFETY: modules, layout and cache are alive for the call, and so is every state above.
        let created =
            unsafe { device.raw().create_graphics_pipelines(raw_cache(info.cache), &[create], None) };
        finish(inner, device, created)
    }

    /// The name it was made with.
    pub fn name(&self) -> &str {
        &self.inner.name
    }

    /// The Vulkan handle.
    pub fn raw(&self) -> vk::Pipeline {
        self.inner.raw
    }

    /// The pipeline layout.
    pub fn layout(&self) -> vk::PipelineLayout {
        self.inner.layout
    }

    /// Graphics or compute.
    pub fn bind_point(&self) -> vk::PipelineBindPoint {
        self.inner.bind_point
    }

    /// The stages that see the push constants, and their bytes.
    pub fn push_constants(&self) -> Option<(vk::ShaderStageFlags, u32)> {
        self.inner.push
    }
}

/// All stages as one mask.
fn check_stages(
    device: &Device,
    info: &GraphicsPipelineInfo<'_>,
) -> Result<vk::ShaderStageFlags, VulkanError> {
    use vk::ShaderStageFlags as Stage;
    let fault = |what: String| Err(VulkanError::misuse(format!("pipeline `{}`: {what}", info.name)));
    let mut present = Stage::empty();
    for stage in info.stages {
        if stage.stage.as_raw().count_ones() != 1 || !Stage::ALL_GRAPHICS.contains(stage.stage) {
            return fault(format!("{:?} is not one graphics stage", stage.stage));
        }
        if present.contains(stage.stage) {
            return fault(format!("stage {:?} is given twice", stage.stage));
        }
        present |= stage.stage;
    }
    if !present.contains(Stage::VERTEX) {
        return fault("there is no vertex stage".into());
    }
    let patches = info.topology == vk::PrimitiveTopology::PATCH_LIST;
    let tessellation = Stage::TESSELLATION_CONTROL | Stage::TESSELLATION_EVALUATION;
    if present.contains(tessellation) != patches || present.intersects(tessellation) != patches {
        return fault(format!("topology {:?} with stages {present:?}", info.topology));
    }
    let limit = device.limits().max_tessellation_patch_size;
    if patches && !(1..=limit).contains(&info.patch_control_points) {
        return fault(format!(
            "{} control points a patch; 1 to {limit} are allowed",
            info.patch_control_points
        ));
    }
    Ok(present)
}

fn raster_state(info: &GraphicsPipelineInfo<'_>) -> vk::PipelineRasterizationStateCreateInfo<'static> {
    let bias = info.depth.and_then(|d| d.bias);
    let (constant, slope) = bias.unwrap_or((0.0, 0.0));
    vk::PipelineRasterizationStateCreateInfo::default()
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(info.cull)
        .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
        .depth_bias_enable(bias.is_some())
        .depth_bias_constant_factor(constant)
        .depth_bias_slope_factor(slope)
        .line_width(1.0)
}

fn depth_state(depth: Option<DepthState>) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
    let state = vk::PipelineDepthStencilStateCreateInfo::default();
    match depth {
        None => state,
        Some(depth) => {
            state.depth_test_enable(true).depth_write_enable(depth.write).depth_compare_op(depth.compare)
        }
    }
}

fn blend_state(blend: Blend) -> vk::PipelineColorBlendAttachmentState {
    let state = vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(vk::ColorComponentFlags::RGBA)
        .color_blend_op(vk::BlendOp::ADD)
        .alpha_blend_op(vk::BlendOp::ADD)
        .src_color_blend_factor(vk::BlendFactor::ONE)
        .src_alpha_blend_factor(vk::BlendFactor::ONE);
    let under =
        |factor| state.blend_enable(true).dst_color_blend_factor(factor).dst_alpha_blend_factor(factor);
    match blend {
        Blend::Replace => state,
        Blend::Add => under(vk::BlendFactor::ONE),
        Blend::PremultipliedOver => under(vk::BlendFactor::ONE_MINUS_SRC_ALPHA),
    }
}
