//! Mip levels uploaded from the host, as a shader then reads them.

use worsted::shaders;
use worsted::vulkan::{
    Access, Binding, Buffer, ComputePipelineInfo, DescriptorLayout, DescriptorSet, DeviceChoice, Image,
    ImageInfo, ImageState, MemoryKind, Pipeline, Resource, Sampler, SamplerInfo, SpecializationConstants,
    VulkanError, vk,
};

#[path = "support/device.rs"]
mod device;
use device::shared;

/// Odd sides, so that a level's sides are not simply half of those before: 5 x 3, then 2 x 1.
const EXTENT: [u32; 3] = [5, 3, 1];
const LAYERS: u32 = 2;
/// Texels of both layers at each level.
const TEXELS: [usize; 2] = [30, 4];

fn texture() -> Result<Image, VulkanError> {
    let info = ImageInfo {
        name: "mips",
        format: vk::Format::R32_SFLOAT,
        extent: EXTENT,
        layers: LAYERS,
        mip_levels: TEXELS.len() as u32,
        usage: vk::ImageUsageFlags::TRANSFER_DST | vk::ImageUsageFlags::SAMPLED,
        ..Default::default()
    };
    Image::new(shared(DeviceChoice::Auto), &info)
}

/// All texels of a texture as a shader reads them: levels, layers, rows.
fn read_by_shader(image: &Image, texels: usize) -> Result<Vec<f32>, VulkanError> {
    let device = shared(DeviceChoice::Auto);
    let binding = |binding, kind| Binding { binding, kind, stages: vk::ShaderStageFlags::COMPUTE };
    let kinds = [vk::DescriptorType::COMBINED_IMAGE_SAMPLER, vk::DescriptorType::STORAGE_BUFFER];
    let layout = DescriptorLayout::new(device, "mips", &[binding(0, kinds[0]), binding(1, kinds[1])])?;
    let info = ComputePipelineInfo {
        name: "mips",
        spirv: shaders::get("test/mips.comp").expect("the kernel is embedded"),
        constants: &SpecializationConstants::new(),
        set_layouts: &[&layout],
        push_constant_bytes: 0,
        cache: None,
    };
    let pipeline = Pipeline::compute(device, &info)?;
    let nearest = SamplerInfo { filter: vk::Filter::NEAREST, ..Default::default() };
    let sampler = Sampler::new(device, "mips", &nearest)?;
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let results = Buffer::new(device, "texels", 4 * texels as u64, storage, MemoryKind::Readback)?;
    let bound = [(0, Resource::Sampled(image.view(), &sampler)), (1, Resource::Storage(&results))];
    let set = DescriptorSet::new(&layout, "mips", &bound)?;
    device.run_once("mips", |commands| {
        commands.bind_pipeline(&pipeline);
        commands.bind_sets(&pipeline, &[&set]);
        commands.dispatch([1, 1, 1]);
        commands.memory_barrier(Access::COMPUTE_WRITE, Access::HOST_READ);
        Ok(())
    })?;
    results.read()
}

#[test]
fn every_level_of_every_layer_is_what_was_uploaded() {
    let all: Vec<f32> = (1..=34_u8).map(f32::from).collect();
    let (whole, half) = all.split_at(TEXELS[0]);
    let image = texture().unwrap();
    image.upload_mips(&[whole, half], ImageState::SAMPLED_COMPUTE).unwrap();
    assert_eq!(read_by_shader(&image, all.len()).unwrap(), all);
    shared(DeviceChoice::Auto).check_validation().unwrap();
}

#[test]
fn levels_that_do_not_fit_are_refused() {
    let image = texture().unwrap();
    let (whole, half) = ([0.0_f32; TEXELS[0]], [0.0_f32; TEXELS[1]]);
    let cases: [(&[&[f32]], &str); 5] = [
        (&[&whole, &half, &half], "image `mips` has 2 mip levels, 3 given"),
        (&[&whole[1..], &half], "image `mips` takes 120 bytes at level 0, 116 given"),
        (&[&whole, &half[1..]], "image `mips` takes 16 bytes at level 1, 12 given"),
        (&[&whole, &whole], "image `mips` takes 16 bytes at level 1, 120 given"),
        (&[&half, &whole], "image `mips` takes 120 bytes at level 0, 16 given"),
    ];
    for (levels, expected) in cases {
        let error = image.upload_mips(levels, ImageState::SAMPLED_COMPUTE).unwrap_err();
        assert!(matches!(error, VulkanError::Misuse { .. }), "{error}");
        assert!(error.to_string().contains(expected), "{error}");
    }
    // The first level alone is enough; what the others hold is then undefined.
    image.upload_mips(&[&whole], ImageState::SAMPLED_COMPUTE).unwrap();
    shared(DeviceChoice::Auto).check_validation().unwrap();
}
