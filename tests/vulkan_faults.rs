//! What the Vulkan layer must catch: validation errors, leaks, missing devices, layers and drivers.
//! Each test opens a device of its own, so that no deliberate error reaches another test.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

use std::ffi::CString;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use worsted::shaders;
use worsted::vulkan::{
    Access, Binding, Buffer, ComputePipelineInfo, DescriptorLayout, DescriptorSet, Device, DeviceChoice,
    DeviceOptions, GraphicsPipelineInfo, MemoryKind, Pipeline, PipelineCache, Resource, ShaderStage,
    SpecializationConstants, Validation, VulkanError, inspect, vk,
};

const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::STORAGE_BUFFER;

fn open(choice: DeviceChoice) -> Result<Arc<Device>, VulkanError> {
    let validation = Validation::On { required: true, sync: true };
    Device::new(&DeviceOptions { choice, validation, ..Default::default() })
}

fn device() -> Arc<Device> {
    open(DeviceChoice::Auto).expect("a device with validation")
}

fn storage(device: &Arc<Device>, name: &str, bytes: u64) -> Buffer {
    Buffer::new(device, name, bytes, STORAGE | vk::BufferUsageFlags::TRANSFER_SRC, MemoryKind::Device)
        .unwrap()
}

fn validation_text(error: &VulkanError) -> String {
    assert!(matches!(error, VulkanError::Validation(_)), "expected a validation error, got: {error}");
    let text = error.to_string();
    assert!(!text.contains('\n'), "more than one line: {text}");
    text
}

#[test]
fn a_copy_beyond_the_end_is_a_validation_error() {
    let device = device();
    let (from, to) = (storage(&device, "from", 16), storage(&device, "to", 16));
    let copy = |bytes| {
        device.run_once("copy", |cmd| {
            cmd.copy_buffer(&from, 0, &to, 0, bytes);
            Ok(())
        })
    };
    let text = validation_text(&copy(32).unwrap_err());
    assert!(text.contains("VUID-vkCmdCopyBuffer-size") && text.contains("name = to"), "{text}");
    copy(16).expect("an error is reported once, and good commands run");
    drop((from, to));
    Device::shutdown(device).unwrap();
}

#[test]
fn a_missing_barrier_is_a_validation_error() {
    let device = device();
    let buffer = storage(&device, "results", 256);
    let target =
        Buffer::new(&device, "target", 256, vk::BufferUsageFlags::empty(), MemoryKind::Readback).unwrap();
    let kind = vk::DescriptorType::STORAGE_BUFFER;
    let stages = vk::ShaderStageFlags::COMPUTE;
    let bindings = [Binding { binding: 0, kind, stages }, Binding { binding: 1, kind, stages }];
    let layout = DescriptorLayout::new(&device, "double", &bindings).unwrap();
    let info = ComputePipelineInfo {
        name: "double",
        spirv: shaders::get("test/double.comp").unwrap(),
        constants: &SpecializationConstants::new(),
        set_layouts: &[&layout],
        push_constant_bytes: 4,
        cache: None,
    };
    let pipeline = Pipeline::compute(&device, &info).unwrap();
    let values = storage(&device, "values", 256);
    let bound = [(0, Resource::Storage(&values)), (1, Resource::Storage(&buffer))];
    let set = DescriptorSet::new(&layout, "set", &bound).unwrap();
    let run = |with_barrier: bool| {
        device.run_once("dispatch, then copy", |cmd| {
            cmd.bind_pipeline(&pipeline);
            cmd.bind_sets(&pipeline, &[&set]);
            cmd.push_constants(&pipeline, &64_u32)?;
            cmd.dispatch([1, 1, 1]);
            if with_barrier {
                cmd.memory_barrier(Access::COMPUTE_WRITE, Access::TRANSFER_READ);
            }
            cmd.copy_buffer(&buffer, 0, &target, 0, 256);
            Ok(())
        })
    };
    let text = validation_text(&run(false).unwrap_err());
    assert!(text.contains("SYNC-HAZARD"), "{text}");
    run(true).unwrap();
}

#[test]
fn an_unvalidated_device_works_and_reports_nothing() {
    let device = Device::new(&DeviceOptions::default()).unwrap();
    assert!(!device.is_validated());
    let buffer = storage(&device, "buffer", 16);
    buffer.write_staged(&[5_u32; 4]).unwrap();
    assert_eq!(buffer.read_staged::<u32>().unwrap(), [5; 4]);
    drop(buffer);
    Device::shutdown(device).unwrap();
}

#[test]
fn an_error_of_the_recorder_is_returned_and_nothing_runs() {
    let device = device();
    let buffer = storage(&device, "buffer", 16);
    buffer.write_staged(&[7_u32; 4]).unwrap();
    let result = device.run_once("refused", |cmd| {
        cmd.fill_buffer(&buffer, 0);
        Err(VulkanError::Misuse { what: "enough".into() })
    });
    assert!(matches!(result, Err(VulkanError::Misuse { what }) if what == "enough"));
    assert_eq!(buffer.read_staged::<u32>().unwrap(), [7; 4]);
}

#[test]
fn a_resource_dropped_while_recorded_lives_until_the_fence() {
    let device = device();
    let last = storage(&device, "last", 16);
    device
        .run_once("dropped", |cmd| {
            let first = storage(&device, "first", 16);
            cmd.fill_buffer(&first, 9);
            cmd.memory_barrier(Access::TRANSFER_WRITE, Access::TRANSFER_READ);
            cmd.copy_buffer(&first, 0, &last, 0, 16);
            drop(first);
            assert!(device.memory_bytes().contains_key("first"));
            Ok(())
        })
        .unwrap();
    assert!(!device.memory_bytes().contains_key("first"));
    assert_eq!(last.read_staged::<u32>().unwrap(), [9; 4]);
}

#[test]
fn threads_share_a_device() {
    let device = device();
    std::thread::scope(|scope| {
        for seed in 0..4_u32 {
            let device = &device;
            scope.spawn(move || {
                for round in 0..20 {
                    let data = [seed * 1000 + round; 100];
                    let buffer = storage(device, "shared", 400);
                    buffer.write_staged(&data).unwrap();
                    assert_eq!(buffer.read_staged::<u32>().unwrap(), data);
                }
            });
        }
    });
    Device::shutdown(device).unwrap();
}

#[test]
fn leaks_are_reported_at_shutdown() {
    Device::shutdown(device()).expect("nothing was made, nothing leaks");
    let first = device();
    let kept = storage(&first, "fibers of the left sleeve", 100);
    let error = Device::shutdown(first).unwrap_err();
    assert_eq!(error.exit_code(), 4);
    assert!(error.to_string().contains("buffer `fibers of the left sleeve` ("), "{error}");
    drop(kept);
    let second = device();
    std::mem::forget(storage(&second, "forgotten", 100));
    let error = Device::shutdown(second).unwrap_err();
    assert!(matches!(&error, VulkanError::Leaked { resources } if resources.len() == 1), "{error}");
    let third = device();
    let other = third.clone();
    assert!(matches!(Device::shutdown(third), Err(VulkanError::Leaked { .. })));
    Device::shutdown(other).unwrap();
}

#[test]
fn an_error_raised_by_destruction_surfaces() {
    let device = device();
    let info = vk::BufferCreateInfo::default().size(16).usage(STORAGE);
    // SAFETY: a valid buffer of 16 bytes; that it is never destroyed is the point.
    unsafe { device.raw().create_buffer(&info, None) }.unwrap();
    let error = Device::shutdown(device).unwrap_err();
    assert!(validation_text(&error).contains("vkDestroyDevice"), "{error}");
}

#[test]
fn what_is_not_a_shader_is_refused() {
    let device = device();
    let constants = SpecializationConstants::new();
    let compute = |spirv| {
        let info = ComputePipelineInfo {
            name: "wrong",
            spirv,
            constants: &constants,
            set_layouts: &[],
            push_constant_bytes: 0,
            cache: None,
        };
        Pipeline::compute(&device, &info).err().expect("must be refused").to_string()
    };
    assert!(compute(&[]).contains("is not SPIR-V"));
    assert!(compute(&[1, 2, 3, 4, 5, 6]).contains("found 0x00000001 in 6 words"));
    let spirv = shaders::get("test/band.vert").unwrap();
    let vertex = ShaderStage { stage: vk::ShaderStageFlags::VERTEX, spirv, constants: &constants };
    let graphics = |stages: &[ShaderStage<'_>], topology| {
        let info = GraphicsPipelineInfo { name: "wrong", stages, topology, ..Default::default() };
        Pipeline::graphics(&device, &info).err().expect("must be refused").to_string()
    };
    let points = vk::PrimitiveTopology::POINT_LIST;
    assert!(graphics(&[], points).contains("no vertex stage"));
    assert!(graphics(&[vertex, vertex], points).contains("given twice"));
    assert!(graphics(&[vertex], vk::PrimitiveTopology::PATCH_LIST).contains("PATCH_LIST"));
    let both = ShaderStage { stage: vk::ShaderStageFlags::ALL_GRAPHICS, ..vertex };
    assert!(graphics(&[both], points).contains("is not one graphics stage"));
    Device::shutdown(device).unwrap();
}

#[test]
fn pipeline_caches_survive_a_restart_and_strangers() {
    let device = device();
    let data = PipelineCache::new(&device, &[]).unwrap().data().unwrap();
    assert!(data.len() >= 32, "a cache has a header");
    assert_eq!(PipelineCache::new(&device, &data).unwrap().data().unwrap(), data);
    let mut stranger = data.clone();
    stranger[20] ^= 0xff;
    for wrong in [&stranger[..], &data[..31], &[0xff; 64], b"x"] {
        PipelineCache::new(&device, wrong).expect("starts empty");
    }
    Device::shutdown(device).unwrap();
}

#[test]
fn devices_are_found_by_index_name_and_kind() {
    let device = open(DeviceChoice::Software).expect("the software driver is installed for the tests");
    assert!(device.is_cpu() && !device.driver().is_empty());
    let by_name = open(DeviceChoice::Name(device.name()[..4].to_uppercase())).unwrap();
    assert_eq!(by_name.name()[..4], device.name()[..4]);
    assert_eq!(open(DeviceChoice::Index(device.index())).unwrap().name(), device.name());
    for (choice, asked) in
        [(DeviceChoice::Index(99), "`99`"), (DeviceChoice::Name("Voodoo 2".into()), "`Voodoo 2`")]
    {
        let error = open(choice).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, VulkanError::DeviceNotFound { .. }) && error.exit_code() == 3, "{text}");
        let title = format!("{}: {} (cpu)", device.index(), device.name());
        assert!(text.contains(asked) && text.contains(&title) && text.contains("--device"), "{text}");
    }
    let missing = CString::new("VK_KHR_fictional").unwrap();
    let device_extensions = DeviceOptions { device_extensions: vec![missing.clone()], ..Default::default() };
    let instance_extensions = DeviceOptions { instance_extensions: vec![missing], ..Default::default() };
    for options in [device_extensions, instance_extensions] {
        let error = Device::new(&options).unwrap_err();
        assert!(matches!(error, VulkanError::MissingFeature { .. }) && error.exit_code() == 3, "{error}");
        assert!(error.to_string().contains("VK_KHR_fictional"), "{error}");
    }
}

#[test]
fn the_doctor_sees_what_a_run_would_use() {
    let report = inspect(&DeviceChoice::Software);
    assert!(report.loader.as_deref().is_some_and(|v| v.starts_with("1.")) && report.validation_layer);
    let chosen = &report.devices[report.chosen.expect("one would be used")];
    let device = open(DeviceChoice::Software).unwrap();
    assert_eq!((chosen.name.as_str(), chosen.driver.as_str()), (device.name(), device.driver()));
    assert!(chosen.kind == "cpu" && chosen.missing().is_empty() && chosen.device_memory_bytes > 0);
    let range = u64::from(device.limits().max_storage_buffer_range);
    assert!(chosen.limits.contains(&("maxStorageBufferRange", range)));
    assert!((report.exit_code, report.problem, report.fixes.len()) == (0, None, 0));
    let report = inspect(&DeviceChoice::Index(99));
    assert!(report.exit_code == 3 && report.chosen.is_none() && !report.devices.is_empty());
    assert!(report.problem.is_some_and(|p| p.contains("`99`")));
}

/// Runs in a child process, whose environment decides what it finds.
#[test]
#[ignore = "started by the tests below, with another environment"]
fn child() {
    match open(DeviceChoice::Auto) {
        Ok(device) => println!("<{}>", device.name()),
        Err(error) => println!("<{}: {error}>", error.exit_code()),
    }
    let validation = Validation::On { required: false, sync: true };
    if let Ok(device) = Device::new(&DeviceOptions { validation, ..Default::default() }) {
        println!("<optional layer: {}>", device.is_validated());
    }
    let report = inspect(&DeviceChoice::Auto);
    println!("<doctor {}: {}>", report.exit_code, report.fixes.join("; "));
}

/// What a child process says under the given environment.
fn said(variables: &[(&str, &Path)]) -> String {
    let executable = std::env::current_exe().unwrap();
    let mut command = Command::new(executable);
    command.args(["--ignored", "--exact", "--nocapture", "child"]).envs(variables.iter().copied());
    let output = command.output().unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_machine_without_a_driver_is_told_how_to_get_one() {
    let nowhere = Path::new("/nonexistent");
    let text = said(&[("VK_ICD_FILENAMES", nowhere), ("VK_DRIVER_FILES", nowhere)]);
    assert!(text.contains("<3: no Vulkan driver") && text.contains("apt-get install libvulkan1"), "{text}");
    assert!(text.contains("<doctor 3: apt-get install libvulkan1 mesa-vulkan-drivers>"), "{text}");
}

#[test]
fn a_machine_without_a_loader_is_told_how_to_get_one() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("libvulkan.so.1"), "not a library").unwrap();
    let text = said(&[("LD_LIBRARY_PATH", folder.path())]);
    assert!(
        text.contains("<3: no Vulkan loader (libvulkan.so.1)") && text.contains("apt-get install"),
        "{text}"
    );
    assert!(text.contains("<doctor 3: apt-get install libvulkan1"), "{text}");
}

#[test]
fn a_machine_without_the_layer_is_told_how_to_get_it() {
    let text = said(&[("VK_LAYER_PATH", Path::new("/nonexistent"))]);
    assert!(text.contains("<3: VK_LAYER_KHRONOS_validation is not installed"), "{text}");
    assert!(text.contains("<optional layer: false>"), "{text}");
    assert!(text.contains("<doctor 0: apt-get install vulkan-validationlayers>"), "{text}");
}
