//! The layers of a picture: how what is seen at the centre of each pixel moves, and which yarn it is. One sample, of the
//! very fibers that the picture shows.

use super::draw_plan::{DrawPlan, part_count, part_draws};
use super::pipelines::Builder;
use super::stages::Stages;
use super::strand_pipeline::{Manner, Strands, specialization};
use super::targets::DEPTH_FORMAT;
use crate::graph::{Pass, Use};
use crate::scene::features::Features;
use crate::scene::needs::{Need, any_needs};
use crate::vulkan::{
    Access, Buffer, ColorTarget, Commands, DepthState, DepthTarget, DescriptorLayout, DescriptorSet, Device,
    GraphicsPipelineInfo, Image, ImageInfo, ImageState, Pipeline, PipelineCache, Rendering, VulkanError, vk,
};
use std::sync::Arc;

/// Bits of four f32: motion to the frame before and to the frame after, in halves of the picture's sides, y down.
const MOTION_FORMAT: vk::Format = vk::Format::R32G32B32A32_UINT;
/// Fabric and curve, counted from 1; 0 where there is no yarn.
const ID_FORMAT: vk::Format = vk::Format::R32G32_UINT;

/// Push constants of `glsl/passes/layered.glsl`.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Constants {
    fabric: u32,
}

/// One pipeline's draws of a part of a fabric.
struct LayerDraw {
    /// Built when something is first drawn with it.
    pipeline: Option<Pipeline>,
    features: Features,
    layouts: [DescriptorLayout; 2],
    sets: [DescriptorSet; 2],
    /// The fabric's place among the scene's.
    fabric: usize,
    /// Which of the parts that the fiber pass draws.
    part: usize,
    strands: Strands,
    whole: bool,
    plan: DrawPlan,
}

/// What it draws into, of one size.
struct Images {
    size: [u32; 2],
    motion: Option<Image>,
    ids: Option<Image>,
    depth: Image,
}

impl Images {
    fn new(device: &Arc<Device>, [motion, ids]: [bool; 2], size: [u32; 2]) -> Result<Self, VulkanError> {
        use vk::ImageUsageFlags as Usage;
        let image = |name, format, usage| {
            let extent = [size[0], size[1], 1];
            Image::new(device, &ImageInfo { name, format, extent, usage, ..Default::default() })
        };
        let read_back = Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC;
        let layer = |asked: bool, name, format| asked.then(|| image(name, format, read_back)).transpose();
        Ok(Self {
            size,
            motion: layer(motion, "motion layer", MOTION_FORMAT)?,
            ids: layer(ids, "id layer", ID_FORMAT)?,
            depth: image("layer depth", DEPTH_FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT)?,
        })
    }
}

/// The pass over the fibers of all fabrics.
pub struct LayersPass {
    builder: Builder,
    images: Images,
    frame: Buffer,
    draws: Vec<LayerDraw>,
    parts: usize,
}

impl LayersPass {
    /// The pass for pictures of `size` pixels, around the fiber pass's buffer of a frame; none where no fabric has a
    /// layer.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(
        builder: &Builder,
        frame: &Buffer,
        features: &[Features],
        size: [u32; 2],
    ) -> Result<Option<Self>, VulkanError> {
        let asked = [Need::MotionLayer, Need::IdLayer].map(|need| any_needs(features, need));
        if asked == [false; 2] {
            return Ok(None);
        }
        Ok(Some(Self {
            builder: builder.clone(),
            images: Images::new(builder.device(), asked, size)?,
            frame: frame.clone(),
            draws: Vec::new(),
            parts: 0,
        }))
    }

    /// Draws layers of `size` pixels from now on.
    ///
    /// # Errors
    /// Those of the device.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<(), VulkanError> {
        let asked = [&self.images.motion, &self.images.ids].map(Option::is_some);
        self.images = Images::new(self.builder.device(), asked, size)?;
        Ok(())
    }

    /// Draws with pipelines of this builder from now on.
    pub fn rebuild(&mut self, builder: &Builder) {
        self.builder = builder.clone();
        self.draws.iter_mut().for_each(|draw| draw.pipeline = None);
    }

    /// Adds the next part of a fabric, with the layouts and sets that the fiber pass reads it by.
    pub fn add_fabric(
        &mut self,
        fabric: usize,
        features: &Features,
        layouts: [&DescriptorLayout; 2],
        sets: [&DescriptorSet; 2],
    ) {
        let drawn = [
            (Strands::Core, false, features.core_fibers_drawn),
            (Strands::Regular, false, features.regular_fibers),
            (Strands::Regular, true, features.may_be_whole()),
        ];
        for (strands, whole, _) in drawn.into_iter().filter(|(.., drawn)| *drawn) {
            let features = if whole { features.whole() } else { *features };
            self.draws.push(LayerDraw {
                pipeline: None,
                features: features.of_layers(),
                layouts: layouts.map(Clone::clone),
                sets: sets.map(Clone::clone),
                fabric,
                part: self.parts,
                strands,
                whole,
                plan: DrawPlan::default(),
            });
        }
        self.parts += 1;
        self.draws.sort_by_key(|draw| draw.strands != Strands::Core);
    }

    /// Decides on the draws of the pictures that follow, as the fiber pass does: what it draws in two manners of
    /// shading is drawn here in one.
    ///
    /// # Errors
    /// Those of the device.
    pub fn plan(&mut self, plan: impl Fn(usize, Strands, Manner) -> DrawPlan) -> Result<(), VulkanError> {
        for draw in &mut self.draws {
            let of = |manner| plan(draw.part, draw.strands, manner);
            draw.plan = match (draw.whole, of(Manner::AtPixels)) {
                (true, _) => of(Manner::Whole),
                (false, none) if none.draw_count() == 0 && draw.strands == Strands::Regular => {
                    of(Manner::AtVertices)
                }
                (false, found) => found,
            };
            if draw.pipeline.is_some() || draw.plan.draw_count() == 0 {
                continue;
            }
            let layouts = draw.layouts.each_ref();
            draw.pipeline = Some(pipeline(&self.builder, &draw.features, draw.strands, &layouts)?);
        }
        Ok(())
    }

    /// How many passes they are drawn in, so that none draws many more than `curves` fiber curves.
    pub fn parts(&self, curves: u64) -> usize {
        part_count(self.plans(), curves)
    }

    fn plans(&self) -> impl Iterator<Item = &DrawPlan> + Clone {
        self.draws.iter().map(|draw| &draw.plan)
    }

    fn images(&self) -> impl Iterator<Item = &Image> {
        self.images.motion.iter().chain(&self.images.ids)
    }

    /// Draws the `part`-th of `parts` equal parts. The first part clears the layers.
    pub fn pass(&self, part: usize, parts: usize) -> Pass<'_> {
        let first = part == 0;
        let begun = |image, state| if first { Use::Discard(image, state) } else { Use::Image(image, state) };
        let mut uses: Vec<Use<'_>> =
            self.images().map(|image| begun(image, ImageState::COLOR_TARGET)).collect();
        uses.push(begun(&self.images.depth, ImageState::DEPTH_TARGET));
        uses.push(Use::Buffer(&self.frame, Access::GRAPHICS_READ));
        let record = move |commands: &Commands<'_>| {
            let clear = first.then_some([0.0; 4]);
            let views = self.images().map(Image::view);
            let color: Vec<ColorTarget<'_>> =
                views.map(|view| ColorTarget { view, resolve: None, clear, store: true }).collect();
            let depth = DepthTarget {
                view: self.images.depth.view(),
                clear: first.then_some(0.0),
                store: part + 1 < parts,
            };
            let rendering = Rendering { extent: self.images.size, color: &color, depth: Some(depth) };
            commands.render(&rendering, || self.draw(commands, (part, parts)))
        };
        Pass { name: "layers", uses, record: Box::new(record) }
    }

    fn draw(&self, commands: &Commands<'_>, (part, parts): (usize, usize)) -> Result<(), VulkanError> {
        for (place, range) in part_draws(self.plans(), part, parts) {
            let draws = &self.draws[place];
            let Some(pipeline) = &draws.pipeline else { continue };
            commands.bind_pipeline(pipeline);
            let [frame, fabric] = &draws.sets;
            commands.bind_sets(pipeline, &[frame, fabric]);
            commands.push_constants(pipeline, &Constants { fabric: draws.fabric as u32 })?;
            for draw in draws.plan.draws().take(range.end).skip(range.start) {
                commands.draw(draw.patches, draw.groups, draw.first_patch, draw.first_group);
            }
        }
        Ok(())
    }

    /// Motion of every pixel to the frame before and to the frame after, in halves of the picture's sides, y down; none
    /// where it was not asked for.
    ///
    /// # Errors
    /// Those of the device.
    pub fn read_motion(&self) -> Result<Option<Vec<[f32; 4]>>, VulkanError> {
        self.images.motion.as_ref().map(|image| image.read(ImageState::COLOR_TARGET)).transpose()
    }

    /// Fabric and curve of every pixel, counted from 1, 0 where there is no yarn; none where they were not asked for.
    ///
    /// # Errors
    /// Those of the device.
    pub fn read_ids(&self) -> Result<Option<Vec<[u32; 2]>>, VulkanError> {
        self.images.ids.as_ref().map(|image| image.read(ImageState::COLOR_TARGET)).transpose()
    }
}

fn pipeline(
    builder: &Builder,
    features: &Features,
    strands: Strands,
    layouts: &[&DescriptorLayout; 2],
) -> Result<Pipeline, VulkanError> {
    let fragment = match strands {
        Strands::Core => "passes/layers.core.frag",
        Strands::Regular => "passes/layers.frag",
    };
    let of_layers =
        |stage, path| (stage, if stage == vk::ShaderStageFlags::FRAGMENT { fragment } else { path });
    let stages = strands.stages().map(|(stage, path)| of_layers(stage, path));
    let bindings = layouts.map(DescriptorLayout::bindings);
    let what = format!("layers {strands:?} {features:?} {bindings:?}");
    builder.get(&what, &stages.map(|(_, path)| path), |cache| {
        let constants = specialization(features, vk::SampleCountFlags::TYPE_1, Manner::AtPixels);
        let stages = Stages::new(builder, &stages, &constants, layouts)?;
        build(builder, &stages, features, strands, layouts, cache)
    })
}

fn build(
    builder: &Builder,
    stages: &Stages<'_>,
    features: &Features,
    strands: Strands,
    layouts: &[&DescriptorLayout],
    cache: Option<&PipelineCache>,
) -> Result<Pipeline, VulkanError> {
    let name = match strands {
        Strands::Core => "layers of core fibers",
        Strands::Regular => "layers",
    };
    let formats = [(features.motion_layer, MOTION_FORMAT), (features.id_layer, ID_FORMAT)];
    let color_formats: Vec<vk::Format> =
        formats.into_iter().filter(|(there, _)| *there).map(|(_, format)| format).collect();
    Pipeline::graphics(
        builder.device(),
        &GraphicsPipelineInfo {
            name,
            stages: &stages.infos(),
            topology: vk::PrimitiveTopology::PATCH_LIST,
            patch_control_points: 1,
            color_formats: &color_formats,
            depth: Some(DepthState {
                format: DEPTH_FORMAT,
                compare: vk::CompareOp::GREATER,
                write: true,
                bias: None,
            }),
            samples: vk::SampleCountFlags::TYPE_1,
            set_layouts: layouts,
            push_constant_bytes: size_of::<Constants>() as u32,
            cache,
            ..Default::default()
        },
    )
}
