//! The device that the tests of one process share.

use std::sync::{Arc, OnceLock};
use worsted::vulkan::{Device, DeviceChoice, DeviceOptions, Validation};

/// A device under the validation layer: what `choice` first asked for in this process. Goldens ask for
/// the CPU device, which draws the same everywhere; other tests for the best present. A layer that is
/// missing fails the test: unchecked calls prove nothing.
pub fn shared(choice: DeviceChoice) -> &'static Arc<Device> {
    static SHARED: OnceLock<Arc<Device>> = OnceLock::new();
    SHARED.get_or_init(|| {
        let validation = Validation::On { required: true, sync: true };
        let options = DeviceOptions { choice, validation, ..Default::default() };
        let device = Device::new(&options).expect("a device and the validation layer");
        assert!(device.is_validated(), "tests must run under the validation layer");
        device
    })
}
