//! Asks the device where fibers are, through a renderer's own buffers and its own GLSL function.

use crate::frame::Renderer;
use crate::passes::strand_pipeline::{Manner, specialization};
use crate::scene::features::Features;
use crate::shaders;
use crate::vulkan::{
    Access, Binding, Buffer, ComputePipelineInfo, DescriptorLayout, DescriptorSet, Device, MemoryKind,
    Pipeline, Resource, VulkanError, trimmed, vk,
};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// The kernel.
const KERNEL: &str = "test/fiber_point.comp";
/// Invocations of its work group.
const GROUP: u32 = 64;

/// A place on a fiber; `Query` of the kernel.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct Query {
    /// The piece of yarn.
    pub segment: u32,
    /// The fiber of the cross-section.
    pub fiber: u32,
    /// The place on the piece, 0 to 1.
    pub t: f32,
    /// 0.
    pub padding: u32,
}

/// What is there; `Answer` of the kernel. Lengths in mm, relative to the scene's origin.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct Answer {
    /// The fiber's centre.
    pub position: [f32; 3],
    /// Its distance from the yarn's centre line.
    pub center_distance: f32,
    /// Its unit direction.
    pub tangent: [f32; 3],
    /// Number of the period's [`crate::yarn::period::Kind`].
    pub kind: f32,
}

/// The device's answers about a scene's first fabric, whose features are given.
///
/// # Errors
/// Those of the device.
pub fn ask_device(
    device: &Arc<Device>,
    renderer: &Renderer,
    features: &Features,
    queries: &[Query],
) -> Result<Vec<Answer>, VulkanError> {
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let asked = Buffer::upload(device, "queries", storage, queries)?;
    let bytes = size_of::<Answer>() as u64 * queries.len() as u64;
    let answered = Buffer::new(device, "answers", bytes, storage, MemoryKind::Readback)?;
    let binding = |binding| Binding {
        binding,
        kind: vk::DescriptorType::STORAGE_BUFFER,
        stages: vk::ShaderStageFlags::COMPUTE,
    };
    let layout = DescriptorLayout::new(device, "queries", &[binding(0), binding(1)])?;
    let missing = || VulkanError::misuse("a scene without a fabric");
    let [frame_layout, fabric_layout] = renderer.fibers_pass().layouts(0).ok_or_else(missing)?;
    let constants = specialization(features, vk::SampleCountFlags::TYPE_1, Manner::AtPixels);
    let words = shaders::get(KERNEL).ok_or_else(|| VulkanError::misuse(format!("no shader `{KERNEL}`")))?;
    let info = ComputePipelineInfo {
        name: "fiber point",
        spirv: &trimmed(words, &constants)?,
        constants: &constants,
        set_layouts: &[frame_layout, fabric_layout, &layout],
        push_constant_bytes: 0,
        cache: None,
    };
    let pipeline = Pipeline::compute(device, &info)?;
    let bound = [(0, Resource::Storage(&asked)), (1, Resource::Storage(&answered))];
    let set = DescriptorSet::new(&layout, "queries", &bound)?;
    let [frame_set, fabric_set] = renderer.fibers_pass().sets(0).ok_or_else(missing)?;
    device.run_once("fiber point", |commands| {
        commands.bind_pipeline(&pipeline);
        commands.bind_sets(&pipeline, &[frame_set, fabric_set, &set]);
        commands.dispatch([(queries.len() as u32).div_ceil(GROUP), 1, 1]);
        commands.memory_barrier(Access::COMPUTE_WRITE, Access::HOST_READ);
        Ok(())
    })?;
    answered.read()
}
