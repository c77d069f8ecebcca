//! What can go wrong on the way to a device and on it, each with the line that fixes it.

use ash::vk;

/// The command that installs a loader and a software driver on Debian and Ubuntu.
pub(crate) const INSTALL_DRIVER: &str = "apt-get install libvulkan1 mesa-vulkan-drivers";
/// The command that installs the validation layer on Debian and Ubuntu.
pub(crate) const INSTALL_LAYER: &str = "apt-get install vulkan-validationlayers";

/// Every failure of the Vulkan layer. `Display` is one line that says what was found and what to do.
#[derive(Debug, thiserror::Error)]
pub enum VulkanError {
    /// The Vulkan loader library could not be opened.
    #[error("no Vulkan loader (libvulkan.so.1): install it with `{INSTALL_DRIVER}` ({reason})")]
    NoLoader {
        /// What the system said.
        reason: String,
    },
    /// The loader works but no driver offers a device.
    #[error(
        "no Vulkan driver: the loader found no device; \
         install a driver with `{INSTALL_DRIVER}` ({reason})"
    )]
    NoDriver {
        /// What the loader said.
        reason: String,
    },
    /// Devices exist, but none of the candidates can run the renderer.
    #[error(
        "no suitable Vulkan device: {}; install a newer driver, or the software one with `{INSTALL_DRIVER}`",
        .reasons.join("; ")
    )]
    NoSuitableDevice {
        /// One entry per rejected device: its index, its name and what it lacks.
        reasons: Vec<String>,
    },
    /// The device that was asked for is not there.
    #[error(
        "no Vulkan device matches `{asked}`: available are {}; pass one of these to --device{}",
        list(.available), software_hint(.asked)
    )]
    DeviceNotFound {
        /// The choice as typed.
        asked: String,
        /// Index, name and kind of every device present.
        available: Vec<String>,
    },
    /// The chosen device lacks something that this use needs.
    #[error("Vulkan device `{device}` lacks {what}: choose another with --device, or update its driver")]
    MissingFeature {
        /// Name of the device.
        device: String,
        /// The feature, extension, format or usage.
        what: String,
    },
    /// Validation was required, but `VK_LAYER_KHRONOS_validation` is not installed.
    #[error("VK_LAYER_KHRONOS_validation is not installed: `{INSTALL_LAYER}`, or run without validation")]
    ValidationLayerMissing,
    /// The validation layer reported errors.
    #[error("Vulkan validation failed (a fault of this program, please report it): {0}")]
    Validation(String),
    /// The device stopped answering.
    #[error(
        "the Vulkan device was lost during {what}: try a smaller size, a newer driver, or --device software"
    )]
    DeviceLost {
        /// The operation that noticed.
        what: String,
    },
    /// Host or device memory ran out.
    #[error("out of memory for {what}{}: lower the size or the samples, or use a device with more", bytes_text(*.bytes))]
    OutOfMemory {
        /// Name of the resource or the operation.
        what: String,
        /// Bytes that were asked for; 0 when the failing call does not say.
        bytes: u64,
    },
    /// A resource exceeds a limit of this device.
    #[error(
        "{what} needs {asked}, but this device's {limit_name} is {limit}: split it, shrink it, or use another --device"
    )]
    TooLarge {
        /// Name of the resource.
        what: String,
        /// The size asked for, in the limit's unit (bytes or texels).
        asked: u64,
        /// The Vulkan name of the limit.
        limit_name: &'static str,
        /// The limit's value on this device.
        limit: u64,
    },
    /// Resources were still alive when the device was shut down.
    #[error("{} Vulkan resources were never freed (a fault of this program, please report it): {}", .resources.len(), .resources.join(", "))]
    Leaked {
        /// Kind, name and bytes of every resource.
        resources: Vec<String>,
    },
    /// The Vulkan layer was called in a way that cannot work.
    #[error("{what} (a fault of this program, please report it)")]
    Misuse {
        /// What was wrong, with the name of the resource.
        what: String,
    },
    /// Shaders that are not this build's own do not fit, or the device refuses them.
    #[error("{0}")]
    Shaders(String),
    /// Any other Vulkan result.
    #[error("{what} failed: {result} ({result:?}); `worsted doctor` shows what this driver offers")]
    Other {
        /// The operation.
        what: String,
        /// The result that Vulkan returned.
        result: vk::Result,
    },
}

impl VulkanError {
    /// Sorts a Vulkan result into its error; `what` names the operation and the resource.
    pub fn from_vk(what: impl Into<String>, result: vk::Result) -> Self {
        Self::sized(what, 0, result)
    }

    /// As [`Self::from_vk`], with the bytes that were asked for.
    pub(crate) fn sized(what: impl Into<String>, bytes: u64, result: vk::Result) -> Self {
        let what = what.into();
        match result {
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost { what },
            vk::Result::ERROR_OUT_OF_HOST_MEMORY
            | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY
            | vk::Result::ERROR_OUT_OF_POOL_MEMORY
            | vk::Result::ERROR_FRAGMENTED_POOL => Self::OutOfMemory { what, bytes },
            vk::Result::ERROR_INCOMPATIBLE_DRIVER => Self::NoDriver { reason: format!("{what}: {result:?}") },
            result => Self::Other { what, result },
        }
    }

    pub(crate) fn misuse(what: impl Into<String>) -> Self {
        Self::Misuse { what: what.into() }
    }

    /// The process exit code for this error.
    ///
    /// 3: there is no device that can do the work (also a missing layer or feature).
    /// 4: a device was there and failed: lost, out of memory, over a limit, or used wrongly by this
    /// program (validation errors and leaks), so that no output of the run can be trusted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::NoLoader { .. }
            | Self::NoDriver { .. }
            | Self::NoSuitableDevice { .. }
            | Self::DeviceNotFound { .. }
            | Self::MissingFeature { .. }
            | Self::ValidationLayerMissing => 3,
            Self::Validation(_)
            | Self::DeviceLost { .. }
            | Self::OutOfMemory { .. }
            | Self::TooLarge { .. }
            | Self::Leaked { .. }
            | Self::Misuse { .. }
            | Self::Shaders(_)
            | Self::Other { .. } => 4,
        }
    }
}

/// Attaches the name of the operation to a bare Vulkan result.
pub(crate) trait VkContext<T> {
    /// Turns the error into a [`VulkanError`] about `what`.
    fn during(self, what: &str) -> Result<T, VulkanError>;
}

impl<T> VkContext<T> for Result<T, vk::Result> {
    fn during(self, what: &str) -> Result<T, VulkanError> {
        self.map_err(|result| VulkanError::from_vk(what, result))
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".into() } else { names.join(", ") }
}

fn software_hint(asked: &str) -> String {
    let software = asked == super::select::DeviceChoice::Software.to_string();
    if software { format!(", or install the software driver with `{INSTALL_DRIVER}`") } else { String::new() }
}

fn bytes_text(bytes: u64) -> String {
    if bytes == 0 { String::new() } else { format!(" ({bytes} bytes)") }
}

#[cfg(test)]
#[path = "error_tests.rs"]
mod tests;
