//! Every way a command can end badly, with its exit code.

use crate::io::error::FileError;
use crate::knit::error::KnitError;
use crate::scene::SceneError;
use crate::vulkan::VulkanError;

/// Exit code of a comparison, probe line or stress verdict that failed, and of a picture with pixels
/// that are no numbers.
pub const EXIT_FAILED: u8 = 1;
/// Exit code of bad input or arguments.
pub const EXIT_BAD_INPUT: u8 = 2;

/// Exit code where no device can be used, or no display.
pub const EXIT_NO_DEVICE: u8 = 3;

/// Why a command failed; each is one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file is missing, unreadable, wrong, or cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A scene that cannot be.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Fabric that cannot be knitted.
    #[error(transparent)]
    Knit(#[from] KnitError),
    /// The device.
    #[error(transparent)]
    Vulkan(#[from] VulkanError),
    /// No display to open a window on.
    #[error("{0}")]
    NoDisplay(String),
    /// Arguments that do not fit together.
    #[error("{0}")]
    Arguments(String),
    /// A check that this program makes of its own work did not hold.
    #[error("{0}")]
    Failed(String),
}

impl Error {
    /// The process's exit code: 1 a check failed, 2 bad input or arguments, 3 no usable device, 4 device
    /// lost or out of memory.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::File(_) | Self::Scene(_) | Self::Knit(_) | Self::Arguments(_) => EXIT_BAD_INPUT,
            Self::Vulkan(error) => error.exit_code(),
            Self::Failed(_) => EXIT_FAILED,
            Self::NoDisplay(_) => EXIT_NO_DEVICE,
        }
    }
}
