//! Pipelines that expand yarn into strands: core fibers or single ones.

use super::found;
use super::targets::{DEPTH_FORMAT, RADIANCE_FORMAT};
use crate::scene::features::Features;
use crate::shaders::ShaderSet;
use crate::vulkan::{
    DepthState, DescriptorLayout, Device, GraphicsPipelineInfo, Pipeline, ShaderStage,
    SpecializationConstants, VulkanError, trimmed, vk,
};
use std::sync::Arc;

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Strands {
    /// One core fiber to a ply.
    Core,
    /// Fibers one by one.
    Regular,
}

impl Strands {
    fn stages(self) -> [(vk::ShaderStageFlags, &'static str); 5] {
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
    device: &Arc<Device>,
    shaders: &ShaderSet,
    features: &Features,
    strands: Strands,
    samples: vk::SampleCountFlags,
    layouts: &[&DescriptorLayout],
) -> Result<Pipeline, VulkanError> {
    let constants = specialization(features, samples);
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
        device,
        &GraphicsPipelineInfo {
            name: match strands {
                Strands::Core => "core fibers",
                Strands::Regular => "fibers",
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
            ..Default::default()
        },
    )
}

/// The features as specialization constants.
pub fn specialization(features: &Features, samples: vk::SampleCountFlags) -> SpecializationConstants {
    features
        .specialization(samples.as_raw())
        .into_iter()
        .fold(SpecializationConstants::new(), |constants, (id, value)| constants.u32(id as u32, value))
}
