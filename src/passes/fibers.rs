//! Expands yarn into fibers and shades them: vertex, tessellation, geometry and fragment stages.

use super::draw_plan::DrawPlan;
use super::spirv;
use super::targets::{DEPTH_FORMAT, RADIANCE_FORMAT, Targets};
use crate::graph::{Pass, Use};
use crate::scene::features::Features;
use crate::vulkan::{
    Access, Binding, Buffer, ColorTarget, Commands, DepthState, DepthTarget, DescriptorLayout, DescriptorSet,
    Device, GraphicsPipelineInfo, Image, ImageState, Pipeline, Rendering, Resource, ShaderStage,
    SpecializationConstants, VulkanError, vk,
};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Stages that read a fabric's buffers; compute stands for the test kernels, which share the layout.
const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::ALL_GRAPHICS.as_raw() | vk::ShaderStageFlags::COMPUTE.as_raw(),
);

/// The buffers of one fabric, in the order of set 1's bindings in `glsl/passes/bindings.glsl`.
pub struct FabricBuffers {
    /// [`crate::gpu_types::ControlPoint`]s.
    pub control_points: Buffer,
    /// [`crate::gpu_types::Segment`]s.
    pub segments: Buffer,
    /// [`crate::gpu_types::Fiber`]s.
    pub fibers: Buffer,
    /// One [`crate::gpu_types::Yarn`].
    pub yarn: Buffer,
}

/// One fabric ready to be drawn.
pub struct FabricDraw {
    pipeline: Pipeline,
    set: DescriptorSet,
    plan: DrawPlan,
}

/// The pass: layouts, pipelines by features, and what is drawn.
pub struct FibersPass {
    device: Arc<Device>,
    frame_layout: DescriptorLayout,
    fabric_layout: DescriptorLayout,
    frame: Buffer,
    statistics: Buffer,
    frame_set: DescriptorSet,
    pipelines: HashMap<Features, Pipeline>,
    fabrics: Vec<FabricDraw>,
}

impl FibersPass {
    /// Builds the pass around one frame's uniform buffer and the statistics it counts into.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: &Arc<Device>, frame: Buffer, statistics: Buffer) -> Result<Self, VulkanError> {
        let binding = |binding, kind| Binding { binding, kind, stages: STAGES };
        let storage = vk::DescriptorType::STORAGE_BUFFER;
        let frame_bindings = [binding(0, vk::DescriptorType::UNIFORM_BUFFER), binding(1, storage)];
        let frame_layout = DescriptorLayout::new(device, "frame", &frame_bindings)?;
        let fabric_bindings: [_; 4] = std::array::from_fn(|i| binding(i as u32, storage));
        let fabric_layout = DescriptorLayout::new(device, "fabric", &fabric_bindings)?;
        let resources = [(0, Resource::Uniform(&frame)), (1, Resource::Storage(&statistics))];
        let frame_set = DescriptorSet::new(&frame_layout, "frame", &resources)?;
        Ok(Self {
            device: device.clone(),
            frame_layout,
            fabric_layout,
            frame,
            statistics,
            frame_set,
            pipelines: HashMap::new(),
            fabrics: Vec::new(),
        })
    }

    /// Layouts of sets 0 and 1, for kernels that read the same buffers.
    pub fn layouts(&self) -> [&DescriptorLayout; 2] {
        [&self.frame_layout, &self.fabric_layout]
    }

    /// Sets 0 and 1 of a fabric, for kernels that read the same buffers.
    pub fn sets(&self, fabric: usize) -> Option<[&DescriptorSet; 2]> {
        Some([&self.frame_set, &self.fabrics.get(fabric)?.set])
    }

    /// Adds a fabric to what is drawn.
    ///
    /// # Errors
    /// Those of the device.
    pub fn add_fabric(
        &mut self,
        buffers: &FabricBuffers,
        features: Features,
        samples: vk::SampleCountFlags,
        plan: DrawPlan,
    ) -> Result<(), VulkanError> {
        let pipeline = match self.pipelines.get(&features) {
            Some(pipeline) => pipeline.clone(),
            None => {
                let pipeline = self.build_pipeline(&features, samples)?;
                self.pipelines.insert(features, pipeline.clone());
                pipeline
            }
        };
        let resources = [
            (0, Resource::Storage(&buffers.control_points)),
            (1, Resource::Storage(&buffers.segments)),
            (2, Resource::Storage(&buffers.fibers)),
            (3, Resource::Storage(&buffers.yarn)),
        ];
        let set = DescriptorSet::new(&self.fabric_layout, "fabric", &resources)?;
        self.fabrics.push(FabricDraw { pipeline, set, plan });
        Ok(())
    }

    fn build_pipeline(
        &self,
        features: &Features,
        samples: vk::SampleCountFlags,
    ) -> Result<Pipeline, VulkanError> {
        use vk::ShaderStageFlags as Stage;
        let constants = specialization(features);
        let files = [
            (Stage::VERTEX, "passes/fibers.vert"),
            (Stage::TESSELLATION_CONTROL, "passes/fibers.tesc"),
            (Stage::TESSELLATION_EVALUATION, "passes/fibers.tese"),
            (Stage::GEOMETRY, "passes/fibers.geom"),
            (Stage::FRAGMENT, "passes/fibers.frag"),
        ];
        let stages = files
            .iter()
            .map(|&(stage, file)| Ok(ShaderStage { stage, spirv: spirv(file)?, constants: &constants }))
            .collect::<Result<Vec<_>, VulkanError>>()?;
        Pipeline::graphics(
            &self.device,
            &GraphicsPipelineInfo {
                name: "fibers",
                stages: &stages,
                topology: vk::PrimitiveTopology::PATCH_LIST,
                patch_control_points: 1,
                color_formats: &[RADIANCE_FORMAT],
                depth: Some(DepthState {
                    format: DEPTH_FORMAT,
                    compare: vk::CompareOp::GREATER,
                    write: true,
                    bias: None,
                }),
                samples,
                set_layouts: &self.layouts(),
                ..Default::default()
            },
        )
    }

    /// How many passes a frame is drawn in, so that none draws many more than `curves` fiber curves:
    /// between them a user hears of progress, and a device's watchdog is content.
    pub fn parts(&self, curves: u64) -> usize {
        let total: u64 = self.fabrics.iter().map(|fabric| fabric.plan.curves()).sum();
        usize::try_from(total.div_ceil(curves.max(1)))
            .unwrap_or(usize::MAX)
            .clamp(1, self.draw_count().max(1))
    }

    fn draw_count(&self) -> usize {
        self.fabrics.iter().map(|fabric| fabric.plan.draws().count()).sum()
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
            Use::Buffer(&self.frame, Access::GRAPHICS_READ),
            Use::Buffer(&self.statistics, COUNTING),
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
        for fabric in &self.fabrics {
            let count = fabric.plan.draws().count();
            let start = range.start.clamp(before, before + count) - before;
            let end = range.end.clamp(before, before + count) - before;
            before += count;
            if start == end {
                continue;
            }
            commands.bind_pipeline(&fabric.pipeline);
            commands.bind_sets(&fabric.pipeline, &[&self.frame_set, &fabric.set]);
            for draw in fabric.plan.draws().take(end).skip(start) {
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

/// The features as specialization constants.
pub fn specialization(features: &Features) -> SpecializationConstants {
    features
        .specialization()
        .into_iter()
        .fold(SpecializationConstants::new(), |constants, (id, value)| constants.u32(id as u32, value))
}
