//! The device that the tests of one process share.

use std::sync::{Arc, OnceLock};
use worsted::vulkan::{Device, DeviceChoice, DeviceOptions, Validation};

/// The best device present (a CPU device where there is nothing better), under the validation layer.
pub fn shared() -> &'static Arc<Device> {
    static SHARED: OnceLock<Arc<Device>> = OnceLock::new();
    SHARED.get_or_init(|| {
        let validation = Validation::On { required: true, sync: true };
        let device =
            Device::new(&DeviceOptions { choice: DeviceChoice::Auto, validation, ..Default::default() })
                .expect("a device with validation");
        assert!(device.is_validated(), "tests must run under the validation layer");
        device
    })
}
