//! What the shaders of fibers read: sets 0 and 1 of `glsl/passes/bindings.glsl`, with no more bindings than features
//! ask for.

use crate::scene::features::Features;
use crate::scene::needs::{Need, any_needs};
use crate::vulkan::{
    Binding, Buffer, DescriptorLayout, DescriptorSet, Device, Image, Resource, Sampler, SamplerInfo,
    VulkanError, vk,
};
use std::sync::Arc;

/// Stages that read a fabric's buffers; compute stands for the test kernels, which share the layout.
const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::ALL_GRAPHICS.as_raw() | vk::ShaderStageFlags::COMPUTE.as_raw(),
);

const UNIFORM: vk::DescriptorType = vk::DescriptorType::UNIFORM_BUFFER;
const STORAGE: vk::DescriptorType = vk::DescriptorType::STORAGE_BUFFER;
const TEXTURE: vk::DescriptorType = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;

/// Set 0: binding, type, and what must be needed for it to be there.
const FRAME_BINDINGS: [(u32, vk::DescriptorType, Option<Need>); 5] = [
    (0, UNIFORM, None),
    (1, STORAGE, Some(Need::Statistics)),
    (2, STORAGE, Some(Need::Lights)),
    (3, STORAGE, Some(Need::ShadowMap)),
    (4, TEXTURE, Some(Need::ShadowMap)),
];
/// Set 1.
const FABRIC_BINDINGS: [(u32, vk::DescriptorType, Option<Need>); 14] = [
    (0, STORAGE, None),
    (1, STORAGE, None),
    (2, STORAGE, None),
    (3, STORAGE, None),
    (4, TEXTURE, Some(Need::CoreTexture)),
    (5, TEXTURE, Some(Need::CoreTexture)),
    (6, TEXTURE, Some(Need::CoreTexture)),
    (7, STORAGE, Some(Need::ScatteringTable)),
    (8, TEXTURE, Some(Need::SelfShadowTable)),
    (9, TEXTURE, Some(Need::OcclusionTexture)),
    (10, STORAGE, Some(Need::Skies)),
    (11, STORAGE, None),
    (12, STORAGE, Some(Need::Neighbours)),
    (13, STORAGE, Some(Need::Neighbours)),
];

/// What the shaders of one fabric, or of a part of it, read: set 1.
pub struct FabricBuffers {
    /// [`crate::gpu_types::ControlPoint`]s.
    pub control_points: Buffer,
    /// [`crate::gpu_types::Piece`]s, and one behind them.
    pub pieces: Buffer,
    /// [`crate::gpu_types::Curve`]s.
    pub curves: Buffer,
    /// One [`crate::gpu_types::Yarn`].
    pub yarn: Buffer,
    /// What is open of the sky at each control point: four halves.
    pub skies: Option<Buffer>,
    /// The control points in the frame before, and in the frame after.
    pub neighbours: Option<[Buffer; 2]>,
    /// What all parts of a fabric read.
    pub shared: SharedBuffers,
}

/// What does not depend on where a fabric's yarns lie.
#[derive(Clone)]
pub struct SharedBuffers {
    /// [`crate::gpu_types::Fiber`]s.
    pub fibers: Buffer,
    /// The core texture: normals, shape and spread.
    pub core: Option<[Image; 3]>,
    /// The physical model's tables, R and then TT: four floats an entry.
    pub scattering: Option<Buffer>,
    /// Optical depth over the yarn's cross-section, by the light's angle: a volume.
    pub self_shadow: Option<Image>,
    /// Ambient light over the yarn's cross-section.
    pub occlusion: Option<Image>,
}

/// What all shaders read of one frame, in the order of set 0's bindings.
pub struct FrameBuffers {
    /// One [`crate::gpu_types::Frame`], uniform.
    pub frame: Buffer,
    /// One [`crate::gpu_types::Statistics`], counted into.
    pub statistics: Option<Buffer>,
    /// [`crate::gpu_types::Light`]s.
    pub lights: Option<Buffer>,
    /// [`crate::gpu_types::ShadowView`]s.
    pub shadow_views: Option<Buffer>,
    /// What they see: two layers at least, so that its view is one of layers.
    pub shadow_map: Option<Image>,
}

/// The bindings of a table that features ask for.
fn bindings(table: &[(u32, vk::DescriptorType, Option<Need>)], features: &[Features]) -> Vec<Binding> {
    let there = |need: &Option<Need>| need.is_none_or(|need| any_needs(features, need));
    table
        .iter()
        .filter(|(.., need)| there(need))
        .map(|&(binding, kind, _)| Binding { binding, kind, stages: STAGES })
        .collect()
}

/// Set 0 of a scene with fabrics of these features.
///
/// # Errors
/// Those of the device; buffers that are there without need, or needed and not there.
pub fn frame_set(
    device: &Arc<Device>,
    frame: &FrameBuffers,
    features: &[Features],
) -> Result<(DescriptorLayout, DescriptorSet), VulkanError> {
    let layout = DescriptorLayout::new(device, "frame", &bindings(&FRAME_BINDINGS, features))?;
    // Bits, not numbers: nothing to blend.
    let nearest = SamplerInfo { filter: vk::Filter::NEAREST, ..Default::default() };
    let exact =
        frame.shadow_map.as_ref().map(|_| Sampler::new(device, "shadow map", &nearest)).transpose()?;
    let mut resources = vec![(0, Resource::Uniform(&frame.frame))];
    let buffers = [(1, &frame.statistics), (2, &frame.lights), (3, &frame.shadow_views)];
    resources.extend(buffers.into_iter().filter_map(|(i, b)| Some((i, Resource::Storage(b.as_ref()?)))));
    let map = frame.shadow_map.as_ref().zip(exact.as_ref());
    resources.extend(map.map(|(map, exact)| (4, Resource::Sampled(map.view(), exact))));
    let set = DescriptorSet::new(&layout, "frame", &resources)?;
    Ok((layout, set))
}

/// The layout of set 1 of a fabric with these features.
///
/// # Errors
/// Those of the device.
pub fn fabric_layout(device: &Arc<Device>, features: &Features) -> Result<DescriptorLayout, VulkanError> {
    DescriptorLayout::new(device, "fabric", &bindings(&FABRIC_BINDINGS, std::slice::from_ref(features)))
}

/// How fabrics read their textures; each sampler is made for the first one that has such a texture.
#[derive(Default)]
pub struct FabricSamplers {
    core: Option<Sampler>,
    table: Option<Sampler>,
}

impl FabricSamplers {
    /// Makes those that this fabric reads by.
    fn make(&mut self, device: &Arc<Device>, buffers: &SharedBuffers) -> Result<(), VulkanError> {
        if buffers.core.is_some() && self.core.is_none() {
            // Along the core the texture tiles.
            let [repeat, clamp] = [vk::SamplerAddressMode::REPEAT, vk::SamplerAddressMode::CLAMP_TO_EDGE];
            let sampling = SamplerInfo { address: [repeat, clamp, clamp], ..Default::default() };
            self.core = Some(Sampler::new(device, "core", &sampling)?);
        }
        if self.table.is_none() && (buffers.self_shadow.is_some() || buffers.occlusion.is_some()) {
            self.table = Some(Sampler::new(device, "table", &SamplerInfo::default())?);
        }
        Ok(())
    }

    /// Set 1 of a fabric.
    ///
    /// # Errors
    /// Those of the device; buffers that are there without need, or needed and not there.
    pub fn fabric_set(
        &mut self,
        device: &Arc<Device>,
        layout: &DescriptorLayout,
        buffers: &FabricBuffers,
    ) -> Result<DescriptorSet, VulkanError> {
        let shared = &buffers.shared;
        self.make(device, shared)?;
        let mut resources = vec![
            (0, Resource::Storage(&buffers.control_points)),
            (1, Resource::Storage(&buffers.pieces)),
            (2, Resource::Storage(&shared.fibers)),
            (3, Resource::Storage(&buffers.yarn)),
            (11, Resource::Storage(&buffers.curves)),
        ];
        if let Some((core, sampler)) = shared.core.as_ref().zip(self.core.as_ref()) {
            resources.extend((4..).zip(core.iter().map(|image| Resource::Sampled(image.view(), sampler))));
        }
        let tables = [(7, &shared.scattering), (10, &buffers.skies)];
        resources.extend(tables.into_iter().filter_map(|(i, b)| Some((i, Resource::Storage(b.as_ref()?)))));
        let neighbours = (12..).zip(buffers.neighbours.iter().flatten());
        resources.extend(neighbours.map(|(binding, points)| (binding, Resource::Storage(points))));
        for (binding, image) in [(8, &shared.self_shadow), (9, &shared.occlusion)] {
            let read = image.as_ref().zip(self.table.as_ref());
            resources.extend(read.map(|(image, table)| (binding, Resource::Sampled(image.view(), table))));
        }
        DescriptorSet::new(layout, "fabric", &resources)
    }
}
