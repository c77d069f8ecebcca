//! Pipelines that expand yarn into strands: core fibers or single ones.

use super::found;
use super::pipelines::Pipelines;
use super::targets::{DEPTH_FORMAT, RADIANCE_FORMAT};
use crate::scene::features::Features;
use crate::shaders::ShaderSet;
use crate::vulkan::{
    DepthState, DescriptorLayout, GraphicsPipelineInfo, Pipeline, ShaderStage, SpecializationConstants,
    VulkanError, trimmed, vk,
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
    pub(super) fn stages(self) -> [(vk::ShaderStageFlags, &'static str); 5] {
        use vk::ShaderStageFlags as Stage;
        let [control, evaluation, geometry, fragment] = match self {
            Self::Core => ["passes/core.tesc", "passes/core.tese", "passes/core.geom", "passes/core.frag"],
            Self::Regular => {
                ["passes/fibers.tesc", "passes/fibers.tese", "passes/fibers.geom", "passes/fibers.frag"]
            }
        };
        [
            (Stage::VERTEX, "passes/fibers.vert"),
            (Stage::TESSELLATION_CONTROL, control),
            (Stage::TESSELLATION_EVALUATION, evaluation),
            (Stage::GEOMETRY, geometry),
            (Stage::FRAGMENT, fragment),
        ]
    }
}

/// Builds a pipeline of `shaders` for frames of `samples`.
///
/// # Errors
/// Those of the device.
pub fn strand_pipeline(
    pipelines: &Pipelines,
    shaders: &ShaderSet,
    features: &Features,
    (strands, manner): (Strands, Manner),
    samples: vk::SampleCountFlags,
    layouts: &[&DescriptorLayout],
) -> Result<Pipeline, VulkanError> {
    let constants = specialization(&manner.features(features), samples, manner);
    let stages = strands
        .stages()
        .iter()
        .map(|&(stage, file)| Ok((stage, trimmed(found(file, shaders.get(file))?, &constants)?)))
        .collect::<Result<Vec<_>, VulkanError>>()?;
    let stages: Vec<_> = stages
        .iter()
        .map(|(stage, spirv)| ShaderStage { stage: *stage, spirv, constants: &constants })
        .collect();
    Pipeline::graphics(
        pipelines.device(),
        &GraphicsPipelineInfo {
            name: match (strands, manner) {
                (Strands::Core, _) => "core fibers",
                (Strands::Regular, Manner::AtPixels) => "fibers",
                (Strands::Regular, Manner::Whole) => "every fiber",
                (Strands::Regular, Manner::AtVertices) => "fibers, shaded at vertices",
            },
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
            set_layouts: layouts,
            cache: pipelines.cache(),
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
