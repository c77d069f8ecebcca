//! Draws every yarn as a ribbon of its outer radius as each light sees it (Wu & Yuksel 2019, Sec. 4.1).

use super::pipelines::Builder;
use super::stages::{Stage, Stages};
use super::strand_pipeline::{Manner, specialization};
use super::targets::DEPTH_FORMAT;
use crate::graph::{Pass, Use};
use crate::scene::features::Features;
use crate::vulkan::{
    Access, Buffer, ColorTarget, Commands, DepthState, DepthTarget, DescriptorLayout, DescriptorSet, Device,
    GraphicsPipelineInfo, Image, ImageInfo, ImageState, ImageView, Pipeline, PipelineCache, Rendering,
    VulkanError, vk,
};
use std::sync::Arc;

/// Bits of a depth, and a piece's number plus one; 0 where there is nothing.
const MAP_FORMAT: vk::Format = vk::Format::R32G32_UINT;

/// The map: one layer for each view of each light.
pub struct ShadowMap {
    /// What shading reads.
    pub image: Image,
    depth: Image,
    layers: Vec<ImageView>,
    resolution: u32,
}

impl ShadowMap {
    /// Makes a map of `resolution` texels a side with `views` layers, at least one.
    ///
    /// # Errors
    /// A size beyond the device's limits, or no memory for it.
    pub fn new(device: &Arc<Device>, resolution: u32, views: u32) -> Result<Self, VulkanError> {
        use vk::ImageUsageFlags as Usage;
        let extent = [resolution, resolution, 1];
        // A view of several layers is what the shader declares, also where there is but one.
        let map = ImageInfo {
            name: "shadow map",
            format: MAP_FORMAT,
            extent,
            layers: views.max(2),
            usage: Usage::COLOR_ATTACHMENT | Usage::SAMPLED,
            ..Default::default()
        };
        let depth = ImageInfo {
            name: "shadow depth",
            format: DEPTH_FORMAT,
            extent,
            usage: Usage::DEPTH_STENCIL_ATTACHMENT,
            ..Default::default()
        };
        let image = Image::new(device, &map)?;
        let depth = Image::new(device, &depth)?;
        let layers = (0..views).map(|view| image.subview(0, view)).collect::<Result<_, _>>()?;
        Ok(Self { image, depth, layers, resolution })
    }
}

/// Push constants of `glsl/passes/shadow_map.vert`.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Constants {
    view_index: u32,
}

/// One fabric's ribbons.
struct Ribbons {
    /// Built before they are first drawn.
    pipeline: Option<Pipeline>,
    features: Features,
    layouts: [DescriptorLayout; 2],
    fabric: DescriptorSet,
    pieces: u32,
}

/// The pass over the yarns of all fabrics.
pub struct ShadowMapPass {
    builder: Builder,
    map: ShadowMap,
    views: Buffer,
    frame_set: Option<DescriptorSet>,
    ribbons: Vec<Ribbons>,
    corners: u32,
}

impl ShadowMapPass {
    /// A pass that draws into `map` from `views`, each piece of yarn with `corners` corners.
    pub fn new(builder: &Builder, map: ShadowMap, views: Buffer, corners: u32) -> Self {
        let builder = builder.clone();
        Self { builder, map, views, frame_set: None, ribbons: Vec::new(), corners }
    }

    /// Draws with pipelines of this builder from now on.
    pub fn rebuild(&mut self, builder: &Builder) {
        self.builder = builder.clone();
        self.ribbons.iter_mut().for_each(|ribbons| ribbons.pipeline = None);
    }

    /// Adds a fabric of `pieces` pieces of yarn, with the layouts and sets that the fiber pass reads it by.
    pub fn add_fabric(
        &mut self,
        features: &Features,
        layouts: [&DescriptorLayout; 2],
        sets: [&DescriptorSet; 2],
        pieces: u32,
    ) {
        self.frame_set = Some(sets[0].clone());
        self.ribbons.push(Ribbons {
            pipeline: None,
            features: *features,
            layouts: layouts.map(Clone::clone),
            fabric: sets[1].clone(),
            pieces,
        });
    }

    /// Builds the pipelines that are not there.
    ///
    /// # Errors
    /// Those of the device.
    pub fn plan(&mut self) -> Result<(), VulkanError> {
        for ribbons in self.ribbons.iter_mut().filter(|ribbons| ribbons.pipeline.is_none()) {
            ribbons.pipeline = Some(pipeline(&self.builder, &ribbons.features, &ribbons.layouts.each_ref())?);
        }
        Ok(())
    }

    /// Draws the first `views` views; none where nothing casts a shadow.
    pub fn pass(&self, views: u32) -> Option<Pass<'_>> {
        let depth = (views > 0).then_some(&self.map.depth)?;
        let uses = vec![
            Use::Discard(&self.map.image, ImageState::COLOR_TARGET),
            Use::Discard(depth, ImageState::DEPTH_TARGET),
            Use::Buffer(&self.views, Access::GRAPHICS_READ),
        ];
        let record = move |commands: &Commands<'_>| {
            for (view, layer) in self.map.layers.iter().enumerate().take(views as usize) {
                let rendering = Rendering {
                    extent: [self.map.resolution; 2],
                    color: &[ColorTarget { view: layer, resolve: None, clear: Some([0.0; 4]), store: true }],
                    depth: Some(DepthTarget { view: depth.view(), clear: Some(0.0), store: false }),
                };
                if view > 0 {
                    commands.image_barrier(depth, ImageState::DEPTH_TARGET, ImageState::DEPTH_TARGET);
                }
                commands.render(&rendering, || self.draw(commands, view as u32))?;
            }
            Ok(())
        };
        Some(Pass { name: "shadow_map", uses, record: Box::new(record) })
    }

    fn draw(&self, commands: &Commands<'_>, view_index: u32) -> Result<(), VulkanError> {
        let Some(frame_set) = &self.frame_set else { return Ok(()) };
        for ribbons in &self.ribbons {
            let Some(pipeline) = &ribbons.pipeline else { continue };
            commands.bind_pipeline(pipeline);
            commands.bind_sets(pipeline, &[frame_set, &ribbons.fabric]);
            commands.push_constants(pipeline, &Constants { view_index })?;
            commands.draw(self.corners, ribbons.pieces, 0, 0);
        }
        Ok(())
    }
}

const STAGES: [Stage; 2] = [
    (vk::ShaderStageFlags::VERTEX, "passes/shadow_map.vert"),
    (vk::ShaderStageFlags::FRAGMENT, "passes/shadow_map.frag"),
];

fn pipeline(
    builder: &Builder,
    features: &Features,
    layouts: &[&DescriptorLayout; 2],
) -> Result<Pipeline, VulkanError> {
    let bindings = layouts.map(DescriptorLayout::bindings);
    let what = format!("shadow map {:?} {bindings:?}", features.basis);
    builder.get(&what, &STAGES.map(|(_, path)| path), |cache| {
        let constants = specialization(features, vk::SampleCountFlags::TYPE_1, Manner::AtPixels);
        build(builder, &Stages::new(builder, &STAGES, &constants, layouts)?, layouts, cache)
    })
}

fn build(
    builder: &Builder,
    stages: &Stages<'_>,
    layouts: &[&DescriptorLayout],
    cache: Option<&PipelineCache>,
) -> Result<Pipeline, VulkanError> {
    Pipeline::graphics(
        builder.device(),
        &GraphicsPipelineInfo {
            name: "shadow map",
            stages: &stages.infos(),
            topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
            color_formats: &[MAP_FORMAT],
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
