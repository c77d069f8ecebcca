//! Expands yarn into fibers and shades them: vertex, tessellation, geometry and fragment stages.

use super::draw_plan::DrawPlan;
use super::strand_pipeline::{Manner, Strands, strand_pipeline};
use super::targets::Targets;
use crate::graph::{Pass, Use};
use crate::scene::features::Features;
use crate::shaders::ShaderSet;
use crate::vulkan::{
    Access, Binding, Buffer, ColorTarget, Commands, DepthTarget, DescriptorLayout, DescriptorSet, Device,
    Image, ImageState, Pipeline, Rendering, Resource, Sampler, SamplerInfo, VulkanError, vk,
};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Stages that read a fabric's buffers; compute stands for the test kernels, which share the layout.
const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::ALL_GRAPHICS.as_raw() | vk::ShaderStageFlags::COMPUTE.as_raw(),
);

/// What one fabric's shaders read, in the order of set 1's bindings in `glsl/passes/bindings.glsl`.
pub struct FabricBuffers {
    /// [`crate::gpu_types::ControlPoint`]s.
    pub control_points: Buffer,
    /// [`crate::gpu_types::Segment`]s.
    pub segments: Buffer,
    /// [`crate::gpu_types::Fiber`]s.
    pub fibers: Buffer,
    /// One [`crate::gpu_types::Yarn`].
    pub yarn: Buffer,
    /// The core texture: normals, shape and spread.
    pub core: [Image; 3],
    /// The physical model's tables, R and then TT: four floats an entry.
    pub scattering: Buffer,
    /// Optical depth over the yarn's cross-section, by the light's angle: a volume.
    pub self_shadow: Image,
    /// Ambient light over the yarn's cross-section.
    pub occlusion: Image,
    /// What is open of the sky at each control point: four halves.
    pub skies: Buffer,
}

/// What all shaders read of one frame, in the order of set 0's bindings.
pub struct FrameBuffers {
    /// One [`crate::gpu_types::Frame`], uniform.
    pub frame: Buffer,
    /// One [`crate::gpu_types::Statistics`], counted into.
    pub statistics: Buffer,
    /// [`crate::gpu_types::Light`]s, at least one.
    pub lights: Buffer,
    /// [`crate::gpu_types::ShadowView`]s, at least one.
    pub shadow_views: Buffer,
    /// What they see: two layers at least, so that its view is one of layers.
    pub shadow_map: Image,
}

/// One pipeline's draws of one fabric.
struct FabricDraw {
    /// Built when something is first drawn with it.
    pipeline: Option<Pipeline>,
    features: Features,
    /// Which of the pass's sets.
    fabric: usize,
    strands: Strands,
    manner: Manner,
    plan: DrawPlan,
}

/// The pass: layouts, pipelines by features, and what is drawn.
pub struct FibersPass {
    device: Arc<Device>,
    shaders: ShaderSet,
    frame_layout: DescriptorLayout,
    fabric_layout: DescriptorLayout,
    frame: FrameBuffers,
    frame_set: DescriptorSet,
    core_sampler: Sampler,
    table_sampler: Sampler,
    pipelines: HashMap<(Features, Strands, Manner), Pipeline>,
    samples: vk::SampleCountFlags,
    fabrics: Vec<DescriptorSet>,
    draws: Vec<FabricDraw>,
}

impl FibersPass {
    /// Builds the pass around one frame's buffers, for frames of `samples`.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(
        device: &Arc<Device>,
        frame: FrameBuffers,
        samples: vk::SampleCountFlags,
    ) -> Result<Self, VulkanError> {
        let binding = |binding, kind| Binding { binding, kind, stages: STAGES };
        let storage = vk::DescriptorType::STORAGE_BUFFER;
        let uniform = vk::DescriptorType::UNIFORM_BUFFER;
        let texture = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
        let frame_kinds = [uniform, storage, storage, storage, texture];
        let frame_bindings: [_; 5] = std::array::from_fn(|i| binding(i as u32, frame_kinds[i]));
        let frame_layout = DescriptorLayout::new(device, "frame", &frame_bindings)?;
        let kind_of = |i| if i < 4 || i == 7 || i == 10 { storage } else { texture };
        let fabric_bindings: [_; 11] = std::array::from_fn(|i| binding(i as u32, kind_of(i)));
        let fabric_layout = DescriptorLayout::new(device, "fabric", &fabric_bindings)?;
        // Bits, not numbers: nothing to blend.
        let nearest = SamplerInfo { filter: vk::Filter::NEAREST, ..Default::default() };
        let exact = Sampler::new(device, "shadow map", &nearest)?;
        let resources = [
            (0, Resource::Uniform(&frame.frame)),
            (1, Resource::Storage(&frame.statistics)),
            (2, Resource::Storage(&frame.lights)),
            (3, Resource::Storage(&frame.shadow_views)),
            (4, Resource::Sampled(frame.shadow_map.view(), &exact)),
        ];
        // Along the core the texture tiles.
        let [repeat, clamp] = [vk::SamplerAddressMode::REPEAT, vk::SamplerAddressMode::CLAMP_TO_EDGE];
        let sampling = SamplerInfo { address: [repeat, clamp, clamp], ..Default::default() };
        let frame_set = DescriptorSet::new(&frame_layout, "frame", &resources)?;
        Ok(Self {
            device: device.clone(),
            shaders: ShaderSet::default(),
            frame_layout,
            fabric_layout,
            frame,
            frame_set,
            core_sampler: Sampler::new(device, "core", &sampling)?,
            table_sampler: Sampler::new(device, "table", &SamplerInfo::default())?,
            pipelines: HashMap::new(),
            samples,
            fabrics: Vec::new(),
            draws: Vec::new(),
        })
    }

    /// The pass with other shaders for the fabrics that follow.
    #[must_use]
    pub fn with_shaders(self, shaders: ShaderSet) -> Self {
        Self { shaders, ..self }
    }

    /// Layouts of sets 0 and 1, for kernels that read the same buffers.
    pub fn layouts(&self) -> [&DescriptorLayout; 2] {
        [&self.frame_layout, &self.fabric_layout]
    }

    /// Sets 0 and 1 of a fabric, for kernels that read the same buffers.
    pub fn sets(&self, fabric: usize) -> Option<[&DescriptorSet; 2]> {
        Some([&self.frame_set, self.fabrics.get(fabric)?])
    }

    /// Adds a fabric to what is drawn: its core fibers, then those drawn one by one.
    ///
    /// # Errors
    /// Those of the device.
    pub fn add_fabric(&mut self, buffers: &FabricBuffers, features: Features) -> Result<(), VulkanError> {
        let sampled = |image: usize| Resource::Sampled(buffers.core[image].view(), &self.core_sampler);
        let resources = [
            (0, Resource::Storage(&buffers.control_points)),
            (1, Resource::Storage(&buffers.segments)),
            (2, Resource::Storage(&buffers.fibers)),
            (3, Resource::Storage(&buffers.yarn)),
            (4, sampled(0)),
            (5, sampled(1)),
            (6, sampled(2)),
            (7, Resource::Storage(&buffers.scattering)),
            (8, Resource::Sampled(buffers.self_shadow.view(), &self.table_sampler)),
            (9, Resource::Sampled(buffers.occlusion.view(), &self.table_sampler)),
            (10, Resource::Storage(&buffers.skies)),
        ];
        let set = DescriptorSet::new(&self.fabric_layout, "fabric", &resources)?;
        let fabric = self.fabrics.len();
        self.fabrics.push(set);
        // Cores first: what lies behind them is then never shaded.
        let drawn = [
            (Strands::Core, Manner::AtPixels, features.core_fibers_drawn),
            (Strands::Core, Manner::AtVertices, features.core_fibers_drawn && features.vertex_shading),
            (Strands::Regular, Manner::AtPixels, features.regular_fibers),
            (Strands::Regular, Manner::AtVertices, features.regular_fibers && features.vertex_shading),
            (Strands::Regular, Manner::Whole, features.may_be_whole()),
        ];
        for (strands, manner, _) in drawn.into_iter().filter(|(.., drawn)| *drawn) {
            let plan = DrawPlan::default();
            self.draws.push(FabricDraw { pipeline: None, features, fabric, strands, manner, plan });
        }
        Ok(())
    }

    /// Decides on the draws of the pictures that follow: `plan` is asked for each fabric's strands. Pipelines are built
    /// where they are first needed.
    ///
    /// # Errors
    /// Those of the device.
    pub fn plan(&mut self, plan: impl Fn(usize, Strands, Manner) -> DrawPlan) -> Result<(), VulkanError> {
        let layouts = [&self.frame_layout, &self.fabric_layout];
        for draw in &mut self.draws {
            draw.plan = plan(draw.fabric, draw.strands, draw.manner);
            if draw.pipeline.is_some() || draw.plan.draw_count() == 0 {
                continue;
            }
            let key = (draw.features, draw.strands, draw.manner);
            let built = match self.pipelines.get(&key) {
                Some(pipeline) => pipeline.clone(),
                None => {
                    let what = (draw.strands, draw.manner);
                    strand_pipeline(
                        &self.device,
                        &self.shaders,
                        &draw.features,
                        what,
                        self.samples,
                        &layouts,
                    )?
                }
            };
            self.pipelines.insert(key, built.clone());
            draw.pipeline = Some(built);
        }
        Ok(())
    }

    /// How many passes a frame is drawn in, so that none draws many more than `curves` fiber curves:
    /// between them a user hears of progress, and a device's watchdog is content.
    pub fn parts(&self, curves: u64) -> usize {
        let total: u64 = self.draws.iter().map(|draw| draw.plan.curves()).sum();
        usize::try_from(total.div_ceil(curves.max(1)))
            .unwrap_or(usize::MAX)
            .clamp(1, self.draw_count().max(1))
    }

    fn draw_count(&self) -> usize {
        self.draws.iter().map(|draw| draw.plan.draw_count()).sum()
    }

    /// Draws the `part`-th of `parts` equal parts of all fabrics into the targets' frame. The first part
    /// clears it, the last one averages its samples.
    pub fn pass<'a>(&'a self, targets: &'a Targets, part: usize, parts: usize) -> Pass<'a> {
        let (first, last) = (part == 0, part + 1 == parts);
        let color = targets.multisampled.as_ref().unwrap_or(&targets.frame);
        let begun = |image, state| if first { Use::Discard(image, state) } else { Use::Image(image, state) };
        let mut uses = vec![
            begun(color, ImageState::COLOR_TARGET),
            begun(&targets.depth, ImageState::DEPTH_TARGET),
            Use::Buffer(&self.frame.frame, Access::GRAPHICS_READ),
            Use::Buffer(&self.frame.lights, Access::GRAPHICS_READ),
            Use::Buffer(&self.frame.statistics, COUNTING),
            Use::Image(&self.frame.shadow_map, ImageState::SAMPLED_GRAPHICS),
        ];
        let resolved = targets.multisampled.as_ref().filter(|_| last).map(|_| &targets.frame);
        if let Some(frame) = resolved {
            uses.push(Use::Discard(frame, ImageState::COLOR_TARGET));
        }
        let draws = self.draw_count();
        let range = draws * part / parts..draws * (part + 1) / parts;
        let record = move |commands: &Commands<'_>| {
            let rendering = Rendering {
                extent: targets.size,
                color: &[ColorTarget {
                    view: color.view(),
                    resolve: resolved.map(Image::view),
                    clear: first.then_some([0.0; 4]),
                    store: !last || targets.multisampled.is_none(),
                }],
                depth: Some(DepthTarget {
                    view: targets.depth.view(),
                    clear: first.then_some(0.0),
                    store: !last,
                }),
            };
            commands.render(&rendering, || self.draw(commands, range.clone()));
            Ok(())
        };
        Pass { name: "fibers", uses, record: Box::new(record) }
    }

    /// Records the draws whose place among those of all fabrics lies in `range`.
    fn draw(&self, commands: &Commands<'_>, range: Range<usize>) {
        let mut before = 0;
        for draws in &self.draws {
            let count = draws.plan.draw_count();
            let start = range.start.clamp(before, before + count) - before;
            let end = range.end.clamp(before, before + count) - before;
            before += count;
            let Some(pipeline) = draws.pipeline.as_ref().filter(|_| start < end) else { continue };
            commands.bind_pipeline(pipeline);
            commands.bind_sets(pipeline, &[&self.frame_set, &self.fabrics[draws.fabric]]);
            for draw in draws.plan.draws().take(end).skip(start) {
                commands.draw(draw.patches, draw.groups, draw.first_patch, draw.first_group);
            }
        }
    }
}

/// The control stage counts with atomics.
const COUNTING: Access = Access {
    stage: vk::PipelineStageFlags2::TESSELLATION_CONTROL_SHADER,
    access: vk::AccessFlags2::from_raw(
        vk::AccessFlags2::SHADER_READ.as_raw() | vk::AccessFlags2::SHADER_WRITE.as_raw(),
    ),
};
