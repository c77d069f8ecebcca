//! One device for all tests of a binary that draw, with the validation layer required.

use std::sync::{Arc, OnceLock};

use worsted::vulkan::{Device, DeviceChoice, DeviceOptions, Validation};

/// The CPU device, checked by the validation layer. A layer that is missing fails the test: unchecked
/// calls prove nothing.
pub fn shared_device() -> &'static Arc<Device> {
    static SHARED: OnceLock<Arc<Device>> = OnceLock::new();
    SHARED.get_or_init(|| {
        let validation = Validation::On { required: true, sync: true };
        let options = DeviceOptions { choice: DeviceChoice::Software, validation, ..Default::default() };
        let device = Device::new(&options).expect("a CPU device and the validation layer");
        assert!(device.is_validated(), "tests must run under the validation layer");
        device
    })
}
