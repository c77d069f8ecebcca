//! Runs one of `glsl/test/functions` over rows of arguments.

use crate::device::shared;
use crate::scattering_tables;
use bytemuck::{Pod, Zeroable};
use worsted::shaders;
use worsted::vulkan::{
    Access, Binding, Buffer, ComputePipelineInfo, DescriptorLayout, DescriptorSet, DeviceChoice, MemoryKind,
    Pipeline, Resource, SpecializationConstants, VulkanError, vk,
};

/// Push constants of `glsl/test/kernel.glsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Shape {
    rows: u32,
    input_words: u32,
    result_words: u32,
}

/// The kernel of a GLSL function.
pub fn path(function: &str) -> String {
    format!("test/functions/{function}.comp")
}

/// What the function returned for each row of argument words, `result_words` floats each.
pub fn run(function: &str, rows: &[Vec<u32>], result_words: usize) -> Result<Vec<Vec<f32>>, VulkanError> {
    let device = shared(DeviceChoice::Auto);
    let input_words = rows.first().map_or(0, Vec::len);
    assert!(rows.iter().all(|row| row.len() == input_words), "{function}: rows differ in length");
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let inputs = Buffer::upload(device, "inputs", storage, &rows.concat())?;
    let bytes = 4 * rows.len() as u64 * result_words as u64;
    // Only the kernels of fiber scattering read them.
    let tables = Buffer::upload(device, "scattering tables", storage, scattering_tables::all())?;
    let results = Buffer::new(device, "results", bytes, storage, MemoryKind::Readback)?;

    let binding = |binding| Binding {
        binding,
        kind: vk::DescriptorType::STORAGE_BUFFER,
        stages: vk::ShaderStageFlags::COMPUTE,
    };
    let layout = DescriptorLayout::new(device, function, &[binding(0), binding(1), binding(2)])?;
    let info = ComputePipelineInfo {
        name: function,
        spirv: shaders::get(&path(function)).expect("the completeness test names a missing kernel"),
        constants: &SpecializationConstants::new(),
        set_layouts: &[&layout],
        push_constant_bytes: size_of::<Shape>() as u32,
        cache: None,
    };
    let pipeline = Pipeline::compute(device, &info)?;
    let bound = [&inputs, &results, &tables].map(Resource::Storage);
    let bound: Vec<_> = (0..).zip(bound).collect();
    let set = DescriptorSet::new(&layout, function, &bound)?;
    let shape =
        Shape { rows: rows.len() as u32, input_words: input_words as u32, result_words: result_words as u32 };
    device.run_once(function, |commands| {
        commands.bind_pipeline(&pipeline);
        commands.bind_sets(&pipeline, &[&set]);
        commands.push_constants(&pipeline, &shape)?;
        commands.dispatch([shape.rows.div_ceil(64), 1, 1]);
        commands.memory_barrier(Access::COMPUTE_WRITE, Access::HOST_READ);
        Ok(())
    })?;
    let flat: Vec<f32> = results.read()?;
    Ok(flat.chunks(result_words).map(<[f32]>::to_vec).collect())
}
