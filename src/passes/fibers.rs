//! Expands yarn into fibers and shades them: vertex, tessellation, geometry and fragment stages.

use super::draw_plan::{DrawPlan, part_count, part_draws};
use super::fiber_sets::{FabricBuffers, FabricSamplers, FrameBuffers, fabric_layout, frame_set};
use super::pipelines::Builder;
use super::strand_pipeline::{Manner, Strands, strand_pipeline};
use super::targets::Targets;
use crate::graph::{Pass, Use};
use crate::scene::features::Features;
use crate::vulkan::{
    Access, ColorTarget, Commands, DepthTarget, DescriptorLayout, DescriptorSet, Image, ImageState, Pipeline,
    Rendering, VulkanError, vk,
};

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
    builder: Builder,
    frame_layout: DescriptorLayout,
    frame: FrameBuffers,
    frame_set: DescriptorSet,
    samplers: FabricSamplers,
    samples: vk::SampleCountFlags,
    fabrics: Vec<(Features, DescriptorLayout, DescriptorSet)>,
    draws: Vec<FabricDraw>,
}

impl FibersPass {
    /// Builds the pass around one frame's buffers, for fabrics of these features and frames of
    /// `samples`.
    ///
    /// # Errors
    /// Those of the device; buffers that no feature asks for, or that are missing.
    pub fn new(
        builder: &Builder,
        frame: FrameBuffers,
        features: &[Features],
        samples: vk::SampleCountFlags,
    ) -> Result<Self, VulkanError> {
        let (frame_layout, frame_set) = frame_set(builder.device(), &frame, features)?;
        Ok(Self {
            builder: builder.clone(),
            frame_layout,
            frame,
            frame_set,
            samplers: FabricSamplers::default(),
            samples,
            fabrics: Vec::new(),
            draws: Vec::new(),
        })
    }

    /// Draws with pipelines of this builder from now on.
    pub fn rebuild(&mut self, builder: &Builder) {
        self.builder = builder.clone();
        self.draws.iter_mut().for_each(|draw| draw.pipeline = None);
    }

    /// Layouts of sets 0 and 1 of a fabric, for kernels that read the same buffers.
    pub fn layouts(&self, fabric: usize) -> Option<[&DescriptorLayout; 2]> {
        Some([&self.frame_layout, &self.fabrics.get(fabric)?.1])
    }

    /// Sets 0 and 1 of a fabric, for kernels that read the same buffers.
    pub fn sets(&self, fabric: usize) -> Option<[&DescriptorSet; 2]> {
        Some([&self.frame_set, &self.fabrics.get(fabric)?.2])
    }

    /// Adds a fabric to what is drawn: its core fibers, then those drawn one by one.
    ///
    /// # Errors
    /// Those of the device.
    pub fn add_fabric(&mut self, buffers: &FabricBuffers, features: Features) -> Result<(), VulkanError> {
        let alike = self.fabrics.iter().find(|(other, ..)| *other == features);
        let layout = match alike {
            Some((_, layout, _)) => layout.clone(),
            None => fabric_layout(self.builder.device(), &features)?,
        };
        let set = self.samplers.fabric_set(self.builder.device(), &layout, buffers)?;
        let fabric = self.fabrics.len();
        self.fabrics.push((features, layout.clone(), set));
        // Cores first, those of all fabrics: what lies behind them is then never shaded.
        let drawn = [
            (Strands::Core, Manner::AtPixels, features.core_fibers_drawn),
            (Strands::Regular, Manner::AtPixels, features.regular_fibers),
            (Strands::Regular, Manner::AtVertices, features.regular_fibers && features.vertex_shading),
            (Strands::Regular, Manner::Whole, features.may_be_whole()),
        ];
        for (strands, manner, _) in drawn.into_iter().filter(|(.., drawn)| *drawn) {
            let plan = DrawPlan::default();
            self.draws.push(FabricDraw { pipeline: None, features, fabric, strands, manner, plan });
        }
        self.draws.sort_by_key(|draw| draw.strands != Strands::Core);
        Ok(())
    }

    /// Decides on the draws of the pictures that follow: `plan` is asked for each fabric's strands. Pipelines are built
    /// where they are first needed.
    ///
    /// # Errors
    /// Those of the device.
    pub fn plan(&mut self, plan: impl Fn(usize, Strands, Manner) -> DrawPlan) -> Result<(), VulkanError> {
        for draw in &mut self.draws {
            draw.plan = plan(draw.fabric, draw.strands, draw.manner);
            if draw.pipeline.is_some() || draw.plan.draw_count() == 0 {
                continue;
            }
            let what = (draw.strands, draw.manner);
            let layouts = [&self.frame_layout, &self.fabrics[draw.fabric].1];
            let pipeline = strand_pipeline(&self.builder, &draw.features, what, self.samples, &layouts)?;
            draw.pipeline = Some(pipeline);
        }
        Ok(())
    }

    /// How many passes a frame is drawn in, so that none draws many more than `curves` fiber curves.
    pub fn parts(&self, curves: u64) -> usize {
        part_count(self.plans(), curves)
    }

    fn plans(&self) -> impl Iterator<Item = &DrawPlan> + Clone {
        self.draws.iter().map(|draw| &draw.plan)
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
        ];
        let FrameBuffers { lights, statistics, shadow_map, .. } = &self.frame;
        uses.extend(lights.iter().map(|lights| Use::Buffer(lights, Access::GRAPHICS_READ)));
        uses.extend(statistics.iter().map(|counts| Use::Buffer(counts, COUNTING)));
        uses.extend(shadow_map.iter().map(|map| Use::Image(map, ImageState::SAMPLED_GRAPHICS)));
        let resolved = targets.multisampled.as_ref().filter(|_| last).map(|_| &targets.frame);
        if let Some(frame) = resolved {
            uses.push(Use::Discard(frame, ImageState::COLOR_TARGET));
        }
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
            commands.render(&rendering, || self.draw(commands, (part, parts)));
            Ok(())
        };
        Pass { name: "fibers", uses, record: Box::new(record) }
    }

    /// Records a part of the draws.
    fn draw(&self, commands: &Commands<'_>, (part, parts): (usize, usize)) {
        for (place, range) in part_draws(self.plans(), part, parts) {
            let draws = &self.draws[place];
            let Some(pipeline) = &draws.pipeline else { continue };
            commands.bind_pipeline(pipeline);
            commands.bind_sets(pipeline, &[&self.frame_set, &self.fabrics[draws.fabric].2]);
            for draw in draws.plan.draws().take(range.end).skip(range.start) {
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
