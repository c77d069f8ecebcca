//! Pipelines that expand yarn into strands: core fibers or single ones.

use super::pipelines::Builder;
use super::stages::{Stage, Stages};
use super::targets::{DEPTH_FORMAT, RADIANCE_FORMAT};
use crate::scene::features::Features;
use crate::vulkan::{
    DepthState, DescriptorLayout, GraphicsPipelineInfo, Pipeline, PipelineCache, SpecializationConstants,
    VulkanError, vk,
};

/// How strands are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Manner {
    /// As the scene asks, shaded at every pixel.
    AtPixels,
    /// Likewise, shaded at their vertices: pieces of yarn that are thin in the picture.
    AtVertices,
    /// Every fiber at full detail: where level of detail has nothing to simplify.
    Whole,
}

impl Manner {
    /// The features of its pipelines.
    fn features(self, of_fabric: &Features) -> Features {
        match self {
            Self::AtPixels | Self::AtVertices => of_fabric.of_picture(),
            Self::Whole => of_fabric.whole().of_picture(),
        }
    }
}

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Strands {
    /// One core fiber to a ply.
    Core,
    /// Fibers one by one.
    Regular,
}

impl Strands {
    pub(super) fn stages(self) -> [Stage; 5] {
        use vk::ShaderStageFlags as Flags;
        let [control, evaluation, geometry, fragment] = match self {
            Self::Core => ["passes/core.tesc", "passes/core.tese", "passes/core.geom", "passes/core.frag"],
            Self::Regular => {
                ["passes/fibers.tesc", "passes/fibers.tese", "passes/fibers.geom", "passes/fibers.frag"]
            }
        };
        [
            (Flags::VERTEX, "passes/fibers.vert"),
            (Flags::TESSELLATION_CONTROL, control),
            (Flags::TESSELLATION_EVALUATION, evaluation),
            (Flags::GEOMETRY, geometry),
            (Flags::FRAGMENT, fragment),
        ]
    }
}

/// The pipeline for frames of `samples`.
///
/// # Errors
/// Those of the device.
pub fn strand_pipeline(
    builder: &Builder,
    features: &Features,
    (strands, manner): (Strands, Manner),
    samples: vk::SampleCountFlags,
    layouts: &[&DescriptorLayout; 2],
) -> Result<Pipeline, VulkanError> {
    let bindings = layouts.map(DescriptorLayout::bindings);
    let what = format!("{strands:?} {manner:?} {features:?} {samples:?} {bindings:?}");
    let stages = strands.stages();
    builder.get(&what, &stages.map(|(_, path)| path), |cache| {
        let constants = specialization(&manner.features(features), samples, manner);
        let stages = Stages::new(builder, &stages, &constants, layouts)?;
        build(builder, &stages, (strands, manner), samples, layouts, cache)
    })
}

fn build(
    builder: &Builder,
    stages: &Stages<'_>,
    (strands, manner): (Strands, Manner),
    samples: vk::SampleCountFlags,
    layouts: &[&DescriptorLayout],
    cache: Option<&PipelineCache>,
) -> Result<Pipeline, VulkanError> {
    Pipeline::graphics(
        builder.device(),
        &GraphicsPipelineInfo {
            name: match (strands, manner) {
                (Strands::Core, _) => "core fibers",
                (Strands::Regular, Manner::AtPixels) => "fibers",
                (Strands::Regular, Manner::Whole) => "every fiber",
                (Strands::Regular, Manner::AtVertices) => "fibers, shaded at vertices",
            },
            stages: &stages.infos(),
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
            set_layouts: layouts,
            cache,
            ..Default::default()
        },
    )
}

/// The features as specialization constants.
pub fn specialization(
    features: &Features,
    samples: vk::SampleCountFlags,
    manner: Manner,
) -> SpecializationConstants {
    features
        .specialization(samples.as_raw(), manner == Manner::AtVertices)
        .into_iter()
        .fold(SpecializationConstants::new(), |constants, (id, value)| constants.u32(id as u32, value))
}
