//! Bindings and push constants: what shaders declare against what the passes make.

use crate::constants::everything;
use crate::device::shared;
use crate::reflection::{self, Descriptor, Layout, Member, Reflected};
use crate::structs::differences;
use crate::text_of;
use spirq::ty::DescriptorType;
use worsted::gpu_types::{Frame, Light, ShadowView, Statistics};
use worsted::passes::fiber_sets::{FrameBuffers, fabric_layout, frame_set};
use worsted::passes::shadow_map::ShadowMap;
use worsted::vulkan::{Binding, Buffer, DeviceChoice, MemoryKind, vk};

/// The Vulkan type of a descriptor that a shader declares.
fn vulkan_type(kind: &DescriptorType) -> Option<vk::DescriptorType> {
    Some(match kind {
        DescriptorType::UniformBuffer() => vk::DescriptorType::UNIFORM_BUFFER,
        DescriptorType::StorageBuffer(_) => vk::DescriptorType::STORAGE_BUFFER,
        DescriptorType::StorageImage(_) => vk::DescriptorType::STORAGE_IMAGE,
        DescriptorType::CombinedImageSampler() => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        _ => return None,
    })
}

/// What is wrong with a shader's descriptor, given the layouts of the sets in order.
fn mismatch(descriptor: &Descriptor, sets: &[Vec<Binding>]) -> Option<String> {
    let Descriptor { set, binding, kind } = descriptor;
    let made = sets.get(*set as usize).and_then(|set| set.iter().find(|made| made.binding == *binding));
    match made {
        None => Some(format!("set {set} has no binding {binding}")),
        Some(made) if Some(made.kind) != vulkan_type(kind) => {
            Some(format!("set {set}, binding {binding}: {kind:?} in GLSL, {:?} in the layout", made.kind))
        }
        Some(_) => None,
    }
}

/// Sets 0 and 1 as the fiber pass makes them.
fn fiber_sets() -> Vec<Vec<Binding>> {
    let device = shared(DeviceChoice::Auto);
    let uniform = vk::BufferUsageFlags::UNIFORM_BUFFER;
    let frame = Buffer::new(device, "frame", size_of::<Frame>() as u64, uniform, MemoryKind::Upload)
        .expect("a small buffer");
    let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let statistics =
        Buffer::upload(device, "statistics", storage, &[Statistics::default()]).expect("a small buffer");
    let lights = Buffer::upload(device, "lights", storage, &[Light::default()]).expect("a small buffer");
    let shadow_views =
        Buffer::upload(device, "shadow views", storage, &[ShadowView::default()]).expect("a small buffer");
    let shadow_map = ShadowMap::new(device, 1, 1).expect("a small image").image;
    let buffers = FrameBuffers {
        frame,
        statistics: Some(statistics),
        lights: Some(lights),
        shadow_views: Some(shadow_views),
        shadow_map: Some(shadow_map),
    };
    let all = everything();
    let (frame, _) = frame_set(device, &buffers, &[all]).expect("the set");
    let fabric = fabric_layout(device, &all).expect("the layout");
    [frame, fabric].map(|layout| layout.bindings().to_vec()).to_vec()
}

/// The shaders that read the sets of the fiber pass: those of single fibers, of cores and of ribbons.
fn draws_strands(shader: &Reflected) -> bool {
    ["passes/fibers.", "passes/core.", "passes/layers.", "passes/shadow_map."]
        .iter()
        .any(|pass| shader.path.starts_with(pass))
}

#[test]
fn bindings_of_the_fiber_shaders_are_those_of_the_pass() {
    let sets = fiber_sets();
    assert_eq!(sets.iter().map(Vec::len).collect::<Vec<_>>(), [5, 14]);
    let mut seen = Vec::new();
    for shader in reflection::all().iter().filter(|shader| draws_strands(shader)) {
        for descriptor in &shader.descriptors {
            assert_eq!(mismatch(descriptor, &sets), None, "{}", shader.path);
            seen.push((descriptor.set, descriptor.binding));
        }
    }
    for (set, bindings) in (0..).zip(&sets) {
        for made in bindings {
            assert!(
                seen.contains(&(set, made.binding)),
                "set {set}, binding {}: no shader reads it",
                made.binding
            );
        }
    }
}

#[test]
fn a_moved_or_retyped_binding_is_found() {
    let sets = fiber_sets();
    let shaders = reflection::all();
    let frame = shaders.iter().flat_map(|shader| &shader.descriptors).find(|d| (d.set, d.binding) == (0, 0));
    let segments = shaders
        .iter()
        .find(|shader| shader.path == "passes/fibers.tesc")
        .and_then(|shader| shader.descriptors.iter().find(|d| (d.set, d.binding) == (1, 1)));
    let texture = shaders
        .iter()
        .find(|shader| shader.path == "passes/core.frag")
        .and_then(|shader| shader.descriptors.iter().find(|d| (d.set, d.binding) == (1, 4)));
    let (frame, segments, texture) = (frame.expect("used"), segments.expect("used"), texture.expect("used"));
    assert_eq!(mismatch(segments, &sets), None);
    assert_eq!(mismatch(texture, &sets), None);
    let moved = [(2, 1, segments), (1, 4, segments), (0, 0, segments), (1, 0, frame)];
    for (set, binding, kind) in
        moved.into_iter().chain([(1, 10, texture), (1, 3, texture), (0, 3, texture), (0, 4, segments)])
    {
        let wrong = Descriptor { set, binding, kind: kind.kind.clone() };
        assert!(mismatch(&wrong, &sets).is_some(), "{wrong:?} passed");
    }
}

/// The fields of `struct Constants { ... }` in a pass's source, laid out as `repr(C)` does with members
/// of 4-byte alignment.
fn rust_constants(source: &str) -> Option<Layout> {
    let (_, rest) = source.split_once("#[repr(C)]\nstruct Constants {\n")?;
    let (body, _) = rest.split_once('}')?;
    let mut offset = 0;
    let mut members = Vec::new();
    for line in body.lines() {
        let Some((name, kind)) = line.trim().trim_end_matches(',').split_once(": ") else { continue };
        let (kind, bytes) = match kind {
            "f32" => ("float", 4),
            "u32" => ("uint", 4),
            "i32" => ("int", 4),
            "[f32; 2]" => ("vec2", 8),
            "[f32; 3]" => ("vec3", 12),
            "[f32; 4]" => ("vec4", 16),
            _ => return None,
        };
        members.push(Member { name: name.to_owned(), offset, kind: kind.to_owned() });
        offset += bytes;
    }
    Some(Layout { name: "Constants".to_owned(), stride: offset, members })
}

#[test]
fn push_constants_are_the_structs_of_their_passes() {
    let mut compared = 0;
    for shader in reflection::all().iter().filter(|shader| shader.path.starts_with("passes/")) {
        let Some(block) = &shader.push_constants else { continue };
        let pass = shader.path.split(['/', '.']).nth(1).expect("a file name");
        let source = text_of(&format!("src/passes/{pass}.rs"));
        let rust = rust_constants(&source)
            .unwrap_or_else(|| panic!("src/passes/{pass}.rs: no `Constants` of plain 4-byte members"));
        assert_eq!(differences(&rust, block), Vec::<String>::new(), "{}", shader.path);
        compared += 1;
    }
    assert!(compared >= 3, "compared only {compared} blocks");
}

#[test]
fn different_push_constants_are_found() {
    let shaders = reflection::all();
    let tonemap = shaders.iter().find(|shader| shader.path == "passes/tonemap.comp").expect("embedded");
    let block = tonemap.push_constants.as_ref().expect("it has push constants");
    let source = text_of("src/passes/tonemap.rs");
    for (from, to) in [
        ("background: [f32; 3]", "background: [f32; 4]"),
        ("exposure_scale: f32", "exposure: f32"),
        ("scale: f32", "scale: u32"),
    ] {
        let edited = source.replace(from, to);
        assert_ne!(edited, source);
        let wrong = rust_constants(&edited).expect("still parses");
        assert!(!differences(&wrong, block).is_empty(), "{to} passed");
    }
    assert_eq!(rust_constants("struct Other {}"), None);
}
