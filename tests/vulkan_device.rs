//! The Vulkan layer on a real device, with the validation layer required: what should work works,
//! and what should be caught is caught.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

use std::sync::{Arc, OnceLock};

use worsted::shaders;
use worsted::vulkan::{
    Access, Binding, Blend, Buffer, ColorTarget, ComputePipelineInfo, DepthState, DepthTarget,
    DescriptorLayout, DescriptorSet, Device, DeviceChoice, DeviceOptions, GraphicsPipelineInfo, Image,
    ImageInfo, ImageState, MemoryKind, Pipeline, PipelineCache, Rendering, Resource, Sampler, SamplerInfo,
    ShaderStage, SpecializationConstants, Validation, VulkanError, vk,
};

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;
const CHECKED: Validation = Validation::On { required: true, sync: true };

fn open(choice: DeviceChoice) -> Result<Arc<Device>, VulkanError> {
    Device::new(&DeviceOptions { choice, validation: CHECKED, ..Default::default() })
}

/// One device for all tests that make no deliberate error.
fn device() -> &'static Arc<Device> {
    static SHARED: OnceLock<Arc<Device>> = OnceLock::new();
    SHARED.get_or_init(|| {
        let device = open(DeviceChoice::Auto).expect("a device with validation");
        assert!(device.is_validated(), "tests must run under the validation layer");
        device
    })
}

fn spirv(path: &str) -> &'static [u32] {
    shaders::get(path).expect(path)
}

struct Doubler {
    layout: DescriptorLayout,
    pipeline: Pipeline,
}

fn doubler(
    device: &Arc<Device>,
    constants: &SpecializationConstants,
    cache: Option<&PipelineCache>,
) -> Doubler {
    let binding = |binding| Binding {
        binding,
        kind: vk::DescriptorType::STORAGE_BUFFER,
        stages: vk::ShaderStageFlags::COMPUTE,
    };
    let layout = DescriptorLayout::new(device, "double", &[binding(0), binding(1)]).unwrap();
    let info = ComputePipelineInfo {
        name: "double",
        spirv: spirv("test/double.comp"),
        constants,
        set_layouts: &[&layout],
        push_constant_bytes: 4,
        cache,
    };
    let pipeline = Pipeline::compute(device, &info).unwrap();
    Doubler { layout, pipeline }
}

fn run_doubler(device: &Arc<Device>, constants: &SpecializationConstants, values: &[f32]) -> Vec<f32> {
    let Doubler { layout, pipeline } = doubler(device, constants, None);
    let input = Buffer::upload(device, "values", STORAGE, values).unwrap();
    let bytes = input.bytes();
    let output = Buffer::new(device, "results", bytes, STORAGE, MemoryKind::Readback).unwrap();
    let bound = [(0, Resource::Storage(&input)), (1, Resource::Storage(&output))];
    let set = DescriptorSet::new(&layout, "double", &bound).unwrap();
    let count = u32::try_from(values.len()).unwrap();
    device
        .run_once("double", |cmd| {
            cmd.bind_pipeline(&pipeline);
            cmd.bind_sets(&pipeline, &[&set]);
            cmd.push_constants(&pipeline, &count)?;
            cmd.dispatch([count.div_ceil(64), 1, 1]);
            cmd.memory_barrier(Access::COMPUTE_WRITE, Access::HOST_READ);
            Ok(())
        })
        .unwrap();
    output.read().unwrap()
}

#[test]
fn compute_uses_specialization_constants() {
    let values: Vec<f32> = (0..1000_u16).map(f32::from).collect();
    let doubled = run_doubler(device(), &SpecializationConstants::new(), &values);
    assert!(values.iter().zip(&doubled).all(|(v, d)| v * 2.0 == *d) && doubled.len() == values.len());
    let constants = SpecializationConstants::new().u32(0, 7).u32(0, 3).f32(1, 0.5).bool(2, true);
    let changed = run_doubler(device(), &constants, &values);
    assert!(
        values.iter().zip(&changed).all(|(v, c)| -(v * 3.0 + 0.5) == *c) && changed.len() == values.len()
    );
}

#[test]
fn buffers_keep_their_bytes_by_both_ways() {
    let data: Vec<u32> = (0..10_007_u32).map(|i| i.wrapping_mul(2_654_435_761)).collect();
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let direct = Buffer::upload(device(), "direct", usage, &data).unwrap();
    assert_eq!(direct.read_staged::<u32>().unwrap(), data);
    let bytes = direct.bytes();
    let staged = Buffer::new(device(), "staged", bytes, usage, MemoryKind::Device).unwrap();
    staged.write_staged(&data).unwrap();
    assert_eq!(staged.read_staged::<u32>().unwrap(), data);
}

#[test]
fn odd_and_empty_buffers_work() {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC | STORAGE;
    let odd = Buffer::upload(device(), "odd", usage, &[1_u8, 2, 3, 4, 5]).unwrap();
    assert_eq!((odd.bytes(), odd.read_staged::<u8>().unwrap()), (5, vec![1, 2, 3, 4, 5]));
    assert_eq!(odd.read_staged::<u32>().unwrap().len(), 1, "a trailing part of a word is left out");
    let empty = Buffer::upload::<f32>(device(), "empty", usage, &[]).unwrap();
    assert_eq!((empty.bytes(), empty.read_staged::<f32>().unwrap()), (0, vec![]));
    empty.write_staged::<f32>(&[]).unwrap();
    device()
        .run_once("fill", |cmd| {
            cmd.fill_buffer(&empty, 1);
            Ok(())
        })
        .unwrap();
}

#[test]
fn host_access_out_of_range_is_refused() {
    let buffer =
        Buffer::new(device(), "small", 8, vk::BufferUsageFlags::empty(), MemoryKind::Upload).unwrap();
    buffer.write(4, &[1_u32]).unwrap();
    for (offset, len) in [(4, 2), (8, 1), (9, 0), (u64::MAX, 1)] {
        let error = buffer.write(offset, &vec![0_u32; len]).unwrap_err();
        assert!(error.to_string().contains("past the end of buffer `small` (8 bytes)"), "{error}");
    }
    buffer.write::<u32>(8, &[]).unwrap();
    assert!(buffer.read::<u32>().unwrap_err().to_string().contains("needs Readback memory, it is Upload"));
    let device_only = Buffer::upload(device(), "device", STORAGE, &[1_u32]).unwrap();
    assert!(device_only.write(0, &[1_u32]).unwrap_err().to_string().contains("needs Upload memory"));
    assert!(device_only.replace(&[1_u32, 2]).unwrap_err().to_string().contains("past the end"));
    assert!(device_only.write_staged(&[1_u32, 2]).unwrap_err().to_string().contains("past the end"));
}

#[test]
fn absurd_allocations_are_errors() {
    let none = vk::BufferUsageFlags::empty();
    for bytes in [1 << 42, u64::MAX - 7, u64::MAX] {
        for kind in [MemoryKind::Device, MemoryKind::Upload, MemoryKind::Readback] {
            let error = Buffer::new(device(), "absurd", bytes, none, kind).unwrap_err();
            assert!(matches!(&error, VulkanError::OutOfMemory { bytes: b, .. } if *b == bytes), "{error}");
            assert_eq!(error.exit_code(), 4);
        }
    }
    let limit = u64::from(device().limits().max_storage_buffer_range);
    let error = Buffer::new(device(), "fibers", limit + 1, STORAGE, MemoryKind::Device).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("`fibers`") && text.contains(&format!("maxStorageBufferRange is {limit}")),
        "{text}"
    );
    let size = device().limits().max_image_dimension2_d + 1;
    let info = ImageInfo {
        name: "poster",
        extent: [size, 1, 1],
        usage: vk::ImageUsageFlags::SAMPLED,
        ..Default::default()
    };
    let error = Image::new(device(), &info).err().expect("too wide");
    assert!(matches!(error, VulkanError::TooLarge { limit_name: "maxImageDimension2D", .. }), "{error}");
    let info = ImageInfo { extent: [4, 0, 1], ..info };
    assert!(matches!(Image::new(device(), &info), Err(VulkanError::Misuse { .. })));
    device().check_validation().unwrap();
}

#[test]
fn memory_is_counted_by_name_until_it_is_freed() {
    let make = || Buffer::new(device(), "counted", 1000, STORAGE, MemoryKind::Device).unwrap();
    let (first, second) = (make(), make());
    assert!(device().memory_bytes()["counted"] >= 2000);
    let kept = first.clone();
    drop((first, second));
    assert!((1000..2000).contains(&device().memory_bytes()["counted"]));
    drop(kept);
    assert!(!device().memory_bytes().contains_key("counted"));
}

fn image(name: &str, format: vk::Format, samples: vk::SampleCountFlags, usage: vk::ImageUsageFlags) -> Image {
    let info = ImageInfo { name, format, extent: [32, 32, 1], samples, usage, ..Default::default() };
    Image::new(device(), &info).unwrap()
}

fn band_pipeline(samples: vk::SampleCountFlags, compare: vk::CompareOp, blend: Blend) -> Pipeline {
    let none = SpecializationConstants::new();
    let depth = SpecializationConstants::new().f32(0, 0.25).f32(1, 0.5);
    let half = SpecializationConstants::new().f32(0, 0.5);
    let stage = |stage, path, constants| ShaderStage { stage, spirv: spirv(path), constants };
    let stages = [
        stage(vk::ShaderStageFlags::VERTEX, "test/band.vert", &none),
        stage(vk::ShaderStageFlags::TESSELLATION_CONTROL, "test/band.tesc", &none),
        stage(vk::ShaderStageFlags::TESSELLATION_EVALUATION, "test/band.tese", &depth),
        stage(vk::ShaderStageFlags::GEOMETRY, "test/band.geom", &half),
        stage(vk::ShaderStageFlags::FRAGMENT, "test/band.frag", &none),
    ];
    let info = GraphicsPipelineInfo {
        name: "band",
        stages: &stages,
        topology: vk::PrimitiveTopology::PATCH_LIST,
        color_formats: &[vk::Format::R8G8B8A8_UNORM],
        depth: Some(DepthState { format: vk::Format::D32_SFLOAT, compare, write: true, bias: None }),
        samples,
        blend,
        push_constant_bytes: 32,
        ..Default::default()
    };
    Pipeline::graphics(device(), &info).unwrap()
}

/// Two bands at half height, red at depth 0.25 and then green at 0.75, over blue; the picture's bytes.
fn draw_bands(compare: vk::CompareOp, clear_depth: f32, blend: Blend) -> Vec<[u8; 4]> {
    let four = vk::SampleCountFlags::TYPE_4;
    let attachment = vk::ImageUsageFlags::COLOR_ATTACHMENT;
    let samples = image("samples", vk::Format::R8G8B8A8_UNORM, four, attachment);
    let resolved = image(
        "resolved",
        vk::Format::R8G8B8A8_UNORM,
        vk::SampleCountFlags::TYPE_1,
        attachment | vk::ImageUsageFlags::TRANSFER_SRC,
    );
    let depth = image("depth", vk::Format::D32_SFLOAT, four, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT);
    let pipeline = band_pipeline(four, compare, blend);
    let colors: [[f32; 4]; 2] = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]];
    device()
        .run_once("bands", |cmd| {
            cmd.image_barrier(&samples, ImageState::UNDEFINED, ImageState::COLOR_TARGET);
            cmd.image_barrier(&resolved, ImageState::UNDEFINED, ImageState::COLOR_TARGET);
            cmd.image_barrier(&depth, ImageState::UNDEFINED, ImageState::DEPTH_TARGET);
            let color = [ColorTarget {
                view: samples.view(),
                resolve: Some(resolved.view()),
                clear: Some([0.0, 0.0, 1.0, 1.0]),
                store: false,
            }];
            let depth = Some(DepthTarget { view: depth.view(), clear: Some(clear_depth), store: false });
            cmd.render(&Rendering { extent: [32, 32], color: &color, depth }, || {
                cmd.bind_pipeline(&pipeline);
                cmd.push_constants(&pipeline, &colors)?;
                cmd.draw(2, 1, 0, 0);
                Ok(())
            })
        })
        .unwrap();
    resolved.read(ImageState::COLOR_TARGET).unwrap()
}

/// The colour at the middle of the band, after checking that the band is where it belongs.
fn band_color(picture: &[[u8; 4]]) -> [u8; 4] {
    let row = |y: usize| &picture[y * 32..][..32];
    for y in (0..8).chain(24..32) {
        assert!(row(y).iter().all(|p| *p == [0, 0, 255, 255]), "row {y}: {:?}", row(y));
    }
    let color = row(16)[16];
    for y in 8..24 {
        assert!(row(y).iter().all(|p| *p == color), "row {y}: {:?}", row(y));
    }
    color
}

#[test]
fn every_graphics_stage_depth_resolve_and_blend() {
    let (greater, less) = (vk::CompareOp::GREATER, vk::CompareOp::LESS);
    assert_eq!(band_color(&draw_bands(greater, 0.0, Blend::Replace)), [0, 255, 0, 255]);
    assert_eq!(band_color(&draw_bands(less, 1.0, Blend::Replace)), [255, 0, 0, 255]);
    assert_eq!(band_color(&draw_bands(greater, 0.0, Blend::Add)), [255, 255, 255, 255]);
    assert_eq!(band_color(&draw_bands(greater, 0.9, Blend::Replace)), [0, 0, 255, 255]);
}

#[test]
fn images_keep_their_texels() {
    let info = ImageInfo {
        name: "volume",
        format: vk::Format::R32_SFLOAT,
        extent: [5, 3, 4],
        usage: vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST
            | vk::ImageUsageFlags::SAMPLED,
        ..Default::default()
    };
    let volume = Image::new(device(), &info).unwrap();
    let texels: Vec<f32> = (0..60_u8).map(|i| f32::from(i) * 0.25).collect();
    volume.upload(&texels, ImageState::SAMPLED_GRAPHICS).unwrap();
    assert_eq!(volume.read::<f32>(ImageState::SAMPLED_GRAPHICS).unwrap(), texels);
    let error = volume.upload(&texels[1..], ImageState::SAMPLED_GRAPHICS).unwrap_err().to_string();
    assert!(error.contains("takes 240 bytes at level 0, 236 given"), "{error}");
    assert!(volume.subview(1, 0).is_err());
    let flat =
        Image::new(device(), &ImageInfo { name: "layers", extent: [5, 3, 1], layers: 4, ..info }).unwrap();
    flat.upload(&texels, ImageState::SAMPLED_GRAPHICS).unwrap();
    assert_eq!(flat.read::<f32>(ImageState::SAMPLED_GRAPHICS).unwrap(), texels);
    flat.subview(0, 3).unwrap();
    let stencil = ImageInfo { format: vk::Format::D24_UNORM_S8_UINT, ..info };
    assert!(Image::new(device(), &stencil).err().expect("refused").to_string().contains("stencil"));
    let samples = ImageInfo { samples: vk::SampleCountFlags::TYPE_64, layers: 1, extent: [4, 4, 1], ..info };
    assert!(matches!(Image::new(device(), &samples), Err(VulkanError::MissingFeature { .. })));
    let depth_color = ImageInfo {
        format: vk::Format::D32_SFLOAT,
        usage: vk::ImageUsageFlags::COLOR_ATTACHMENT,
        extent: [4, 4, 1],
        ..info
    };
    assert!(matches!(Image::new(device(), &depth_color), Err(VulkanError::MissingFeature { .. })));
}

#[test]
fn descriptor_sets_must_match_their_layout() {
    let Doubler { layout, .. } = doubler(device(), &SpecializationConstants::new(), None);
    let usage = STORAGE | vk::BufferUsageFlags::UNIFORM_BUFFER;
    let buffer = Buffer::upload(device(), "data", usage, &[0_u32; 4]).unwrap();
    let storage = Resource::Storage(&buffer);
    let cases: [(&[(u32, Resource<'_>)], &str); 4] = [
        (&[(0, storage)], "binding 1 (STORAGE_BUFFER) is not given"),
        (&[(0, storage), (0, storage)], "binding 0 is given twice"),
        (&[(0, storage), (1, storage), (2, storage)], "binding 2 (`data`) is not in the layout"),
        (&[(0, storage), (1, Resource::Uniform(&buffer))], "binding 1 is declared as STORAGE_BUFFER"),
    ];
    for (resources, expected) in cases {
        let error = DescriptorSet::new(&layout, "wrong", resources).err().expect(expected).to_string();
        assert!(error.contains(expected), "{error}");
    }
    let texture =
        image("t", vk::Format::R8_UNORM, vk::SampleCountFlags::TYPE_1, vk::ImageUsageFlags::SAMPLED);
    let sampler = Sampler::new(device(), "s", &SamplerInfo::default()).unwrap();
    let binding = |binding, kind| Binding { binding, kind, stages: vk::ShaderStageFlags::FRAGMENT };
    let kinds = [vk::DescriptorType::COMBINED_IMAGE_SAMPLER, vk::DescriptorType::UNIFORM_BUFFER];
    let both =
        DescriptorLayout::new(device(), "both", &[binding(0, kinds[0]), binding(4, kinds[1])]).unwrap();
    let resources = [(4, Resource::Uniform(&buffer)), (0, Resource::Sampled(texture.view(), &sampler))];
    DescriptorSet::new(&both, "both", &resources).unwrap();
    device().check_validation().unwrap();
}
