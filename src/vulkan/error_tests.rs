//! Sorting of Vulkan results, exit codes, and the lines that users see.

use super::*;

fn kind(result: vk::Result) -> &'static str {
    match VulkanError::sized("drawing", 12, result) {
        VulkanError::DeviceLost { what } if what == "drawing" => "lost",
        VulkanError::OutOfMemory { what, bytes: 12 } if what == "drawing" => "memory",
        VulkanError::NoDriver { .. } => "driver",
        VulkanError::Other { what, result: kept } if what == "drawing" && kept == result => "other",
        _ => "wrong",
    }
}

#[test]
fn results_are_sorted() {
    assert_eq!(kind(vk::Result::ERROR_DEVICE_LOST), "lost");
    assert_eq!(kind(vk::Result::ERROR_OUT_OF_HOST_MEMORY), "memory");
    assert_eq!(kind(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY), "memory");
    assert_eq!(kind(vk::Result::ERROR_OUT_OF_POOL_MEMORY), "memory");
    assert_eq!(kind(vk::Result::ERROR_INCOMPATIBLE_DRIVER), "driver");
    assert_eq!(kind(vk::Result::ERROR_UNKNOWN), "other");
}

#[test]
fn every_error_is_one_line_with_its_fix_and_exit_code() {
    let text = |text: &str| text.to_string();
    let cases = [
        (VulkanError::NoLoader { reason: text("r") }, 3, "apt-get install libvulkan1 mesa-vulkan-drivers"),
        (VulkanError::NoDriver { reason: text("r") }, 3, "apt-get install libvulkan1 mesa-vulkan-drivers"),
        (VulkanError::NoSuitableDevice { reasons: vec![text("a"), text("b")] }, 3, "a; b; install"),
        (VulkanError::DeviceNotFound { asked: text("7"), available: vec![] }, 3, "`7`: available are none"),
        (
            VulkanError::DeviceNotFound { asked: text("software"), available: vec![text("0: card")] },
            3,
            "0: card; pass one of these to --device, or install the software driver",
        ),
        (VulkanError::MissingFeature { device: text("d"), what: text("w") }, 3, "`d` lacks w: choose"),
        (VulkanError::ValidationLayerMissing, 3, "apt-get install vulkan-validationlayers"),
        (VulkanError::Validation(text("v")), 4, "please report it): v"),
        (VulkanError::DeviceLost { what: text("w") }, 4, "lost during w: try"),
        (VulkanError::OutOfMemory { what: text("w"), bytes: 5 }, 4, "for w (5 bytes): lower"),
        (VulkanError::OutOfMemory { what: text("w"), bytes: 0 }, 4, "for w: lower"),
        (
            VulkanError::TooLarge { what: text("w"), asked: 9, limit_name: "maxW", limit: 8 },
            4,
            "w needs 9, but this device's maxW is 8: split it",
        ),
        (
            VulkanError::Leaked { resources: vec![text("a"), text("b")] },
            4,
            "2 Vulkan resources were never freed",
        ),
        (VulkanError::misuse("w"), 4, "w (a fault of this program"),
        (VulkanError::from_vk("w", vk::Result::ERROR_UNKNOWN), 4, "w failed: "),
    ];
    for (error, code, expected) in cases {
        let line = error.to_string();
        assert!(line.contains(expected) && !line.contains('\n'), "{line}");
        assert_eq!(error.exit_code(), code, "{line}");
    }
}
