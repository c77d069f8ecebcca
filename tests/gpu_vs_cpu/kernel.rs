//! Runs one of `glsl/test/functions` over rows of arguments.

use crate::device::shared;
use crate::scattering_tables;
use bytemuck::{Pod, Zeroable};
use worsted::shaders;
use worsted::vulkan::{
    Access, Binding, Buffer, ComputePipelineInfo, DescriptorLayout, DescriptorSet, DeviceChoice, Image,
    MemoryKind, Pipeline, Resource, Sampler, SpecializationConstants, VulkanError, vk,
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
    run_with(function, rows, result_words, None)
}

/// The same of a function that reads a texture, which its kernel declares as binding 2.
pub fn run_with(
    function: &str,
    rows: &[Vec<u32>],
    result_words: usize,
    texture: Option<(&Image, &Sampler)>,
) -> Result<Vec<Vec<f32>>, VulkanError> {
    let device = shared(DeviceChoice::Auto);
    let input_words = rows.first().map_or(0, Vec::len);
    assert!(rows.iter().all(|row| row.len() == input_words), "{function}: rows differ in length");
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let inputs = Buffer::upload(device, "inputs", storage, &rows.concat())?;
    let bytes = 4 * rows.len() as u64 * result_words as u64;
    // Only the kernels of fiber scattering read them.
    let tables = Buffer::upload(device, "scattering tables", storage, scattering_tables::all())?;
    let results = Buffer::new(device, "results", bytes, storage, MemoryKind::Readback)?;

    let binding = |binding, kind| Binding { binding, kind, stages: vk::ShaderStageFlags::COMPUTE };
    let buffer = vk::DescriptorType::STORAGE_BUFFER;
    let mut bindings = vec![binding(0, buffer), binding(1, buffer), binding(2, buffer)];
    let mut bound = vec![
        (0, Resource::Storage(&inputs)),
        (1, Resource::Storage(&results)),
        (2, Resource::Storage(&tables)),
    ];
    if let Some((image, sampler)) = texture {
        bindings.push(binding(3, vk::DescriptorType::COMBINED_IMAGE_SAMPLER));
        bound.push((3, Resource::Sampled(image.view(), sampler)));
    }
    let layout = DescriptorLayout::new(device, function, &bindings)?;
    let info = ComputePipelineInfo {
        name: function,
        spirv: shaders::get(&path(function)).expect("the completeness test names a missing kernel"),
        constants: &SpecializationConstants::new(),
        set_layouts: &[&layout],
        push_constant_bytes: size_of::<Shape>() as u32,
        cache: None,
    };
    let pipeline = Pipeline::compute(device, &info)?;
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
