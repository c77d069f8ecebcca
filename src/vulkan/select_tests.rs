//! Selection among made-up devices.

use super::*;

fn candidate(index: usize, name: &str, kind: vk::PhysicalDeviceType, lacks: &[&'static str]) -> Candidate {
    let needs = ["Vulkan 1.3", "tessellationShader", "geometryShader"];
    Candidate {
        index,
        handle: vk::PhysicalDevice::null(),
        name: name.into(),
        kind,
        api_version: vk::API_VERSION_1_3,
        driver: "made up".into(),
        limits: vk::PhysicalDeviceLimits::default(),
        max_buffer_bytes: 0,
        max_allocation_bytes: 0,
        memory: vk::PhysicalDeviceMemoryProperties::default(),
        pipeline_cache_uuid: [0; vk::UUID_SIZE],
        vendor_id: 0,
        device_id: 0,
        optional: OptionalFeatures::default(),
        needs: needs.iter().map(|need| (*need, !lacks.contains(need))).collect(),
        queue_family: Some(0),
    }
}

fn machine() -> Vec<Candidate> {
    use vk::PhysicalDeviceType as Kind;
    vec![
        candidate(0, "llvmpipe", Kind::CPU, &[]),
        candidate(1, "Guest Adapter", Kind::VIRTUAL_GPU, &[]),
        candidate(2, "Laptop Graphics", Kind::INTEGRATED_GPU, &[]),
        candidate(3, "Old Card", Kind::DISCRETE_GPU, &["Vulkan 1.3", "geometryShader"]),
        candidate(4, "Big Card", Kind::DISCRETE_GPU, &[]),
        candidate(5, "Big Card", Kind::DISCRETE_GPU, &[]),
    ]
}

fn chosen(candidates: &[Candidate], choice: DeviceChoice) -> Option<usize> {
    choose(candidates, &choice).ok().map(|c| c.index)
}

#[test]
fn the_best_suitable_kind_wins_and_ties_go_to_the_first() {
    let mut machine = machine();
    for expected in [4, 5, 2, 1, 0] {
        assert_eq!(chosen(&machine, DeviceChoice::Auto), Some(expected));
        machine.retain(|c| c.index != expected);
    }
    let error = choose(&machine, &DeviceChoice::Auto).map(|c| c.index).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("3: Old Card (discrete) lacks Vulkan 1.3, geometryShader"), "{text}");
    assert_eq!(error.exit_code(), 3);
}

#[test]
fn names_match_parts_in_any_case_and_never_fall_back() {
    let machine = machine();
    assert_eq!(chosen(&machine, DeviceChoice::Name("big".into())), Some(4));
    assert_eq!(chosen(&machine, DeviceChoice::Name("CARD".into())), Some(4));
    assert_eq!(chosen(&machine, DeviceChoice::Software), Some(0));
    assert_eq!(chosen(&machine, DeviceChoice::Index(5)), Some(5));
    for unsuitable in [DeviceChoice::Index(3), DeviceChoice::Name("old".into())] {
        let error = choose(&machine, &unsuitable).map(|c| c.index).unwrap_err();
        assert!(matches!(&error, VulkanError::NoSuitableDevice { reasons } if reasons.len() == 1), "{error}");
    }
    for absent in [DeviceChoice::Index(6), DeviceChoice::Name("radeon".into())] {
        let error = choose(&machine, &absent).map(|c| c.index).unwrap_err();
        assert!(matches!(&error, VulkanError::DeviceNotFound { available, .. } if available.len() == 6));
    }
    assert!(matches!(
        choose(&machine[1..], &DeviceChoice::Software),
        Err(VulkanError::DeviceNotFound { .. })
    ));
}

#[test]
fn choices_are_read_as_typed() {
    for (text, choice) in [
        ("auto", DeviceChoice::Auto),
        (" Software ", DeviceChoice::Software),
        ("12", DeviceChoice::Index(12)),
        ("GTX 1080", DeviceChoice::Name("GTX 1080".into())),
        ("-1", DeviceChoice::Name("-1".into())),
    ] {
        assert_eq!(text.parse(), Ok(choice));
    }
}
