//! Asks the device where fibers are, through the renderer's own buffers and its own GLSL function.

use crate::device::shared;
use bytemuck::{Pod, Zeroable};
use worsted::frame::Renderer;
use worsted::passes::strand_pipeline::specialization;
use worsted::scene::features::Features;
use worsted::shaders;
use worsted::vulkan::{
    Access, Binding, Buffer, ComputePipelineInfo, DescriptorLayout, DescriptorSet, DeviceChoice, MemoryKind,
    Pipeline, Resource, VulkanError, vk,
};

/// `Query` of `glsl/test/fiber_point.comp`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Query {
    pub segment: u32,
    pub fiber: u32,
    pub t: f32,
    pub padding: u32,
}

/// `Answer` of `glsl/test/fiber_point.comp`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct Answer {
    pub position: [f32; 3],
    pub center_distance: f32,
    pub tangent: [f32; 3],
    /// [`Kind`] of the period.
    pub kind: f32,
}

/// The device's answers, through sets 0 and 1 as the picture's passes bind them.
pub fn ask_device(
    renderer: &Renderer,
    features: &Features,
    queries: &[Query],
) -> Result<Vec<Answer>, VulkanError> {
    let device = shared(DeviceChoice::Auto);
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
    let [frame_layout, fabric_layout] = renderer.fibers_pass().layouts();
    let info = ComputePipelineInfo {
        name: "fiber point",
        spirv: shaders::get("test/fiber_point.comp").expect("the kernel is embedded"),
        constants: &specialization(features, vk::SampleCountFlags::TYPE_1),
        set_layouts: &[frame_layout, fabric_layout, &layout],
        push_constant_bytes: 0,
        cache: None,
    };
    let pipeline = Pipeline::compute(device, &info)?;
    let bound = [(0, Resource::Storage(&asked)), (1, Resource::Storage(&answered))];
    let set = DescriptorSet::new(&layout, "queries", &bound)?;
    let [frame_set, fabric_set] = renderer.fibers_pass().sets(0).expect("the scene has a fabric");
    device.run_once("fiber point", |commands| {
        commands.bind_pipeline(&pipeline);
        commands.bind_sets(&pipeline, &[frame_set, fabric_set, &set]);
        commands.dispatch([(queries.len() as u32).div_ceil(64), 1, 1]);
        commands.memory_barrier(Access::COMPUTE_WRITE, Access::HOST_READ);
        Ok(())
    })?;
    answered.read()
}
