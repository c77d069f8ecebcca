//! What stands before the camera: knitted fabrics as scene files, so that overrides are read and checked as
//! those of `worsted render` are; and pictures of them.

use crate::looks;
use crate::pictures::Shot;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;
pub use worsted::bench::cloth::{Cloth, Model};
pub use worsted::bench::settings::{DEFAULT_SAMPLES, EVERY_FIBER};
use worsted::error::Error;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::error::FileError;
use worsted::scene::Scene;
use worsted::vulkan::{Device, DeviceOptions};

/// The device, and a folder for models.
pub struct Stage {
    device: Arc<Device>,
    folder: TempDir,
}

impl Stage {
    /// Opens the device of that name or index.
    ///
    /// # Errors
    /// No such device; no folder for temporary files.
    pub fn new(device: &str) -> Result<Self, Error> {
        let choice = device.parse().unwrap_or_default();
        let folder = tempfile::tempdir().map_err(|e| FileError::io(&std::env::temp_dir(), "write", &e))?;
        Ok(Self { device: Device::new(&DeviceOptions { choice, ..Default::default() })?, folder })
    }

    /// The device everything is drawn on.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Gives the device back.
    ///
    /// # Errors
    /// What the device still holds against it.
    pub fn close(self) -> Result<(), Error> {
        Ok(Device::shutdown(self.device)?)
    }

    /// Knits `cloth` in the preset `yarn`, at that yarn's own outer radius, in that yarn's dye.
    ///
    /// # Errors
    /// No such preset; files that cannot be written.
    pub fn model(&self, yarn: &str, cloth: Cloth) -> Result<Model, Error> {
        Model::write(self.folder.path(), yarn, cloth, looks::fiber(yarn))
    }

    /// Draws the scene at `path`, with scene keys overridden in the order given.
    ///
    /// # Errors
    /// Those of the scene and of the device; pixels that are no numbers.
    pub fn draw(&self, path: &Path, sets: &[String], request: Request) -> Result<Shot, Error> {
        shoot(&mut self.renderer(path, sets, request)?)
    }

    /// What draws the scene at `path` again and again, with scene keys overridden in the order given.
    ///
    /// # Errors
    /// Those of the scene and of the device.
    pub fn renderer(&self, path: &Path, sets: &[String], request: Request) -> Result<Renderer, Error> {
        Ok(Renderer::new(&self.device, Scene::load(path, sets)?, request)?)
    }
}

/// Draws one picture.
///
/// # Errors
/// Those of the device; pixels that are no numbers.
pub fn shoot(renderer: &mut Renderer) -> Result<Shot, Error> {
    let picture = renderer.render(&|_| {})?;
    let stats = renderer.stats().clone();
    if stats.nan_pixels > 0 {
        return Err(Error::Failed(format!("{} pixels are not finite numbers", stats.nan_pixels)));
    }
    Ok(Shot::new(picture, stats))
}

/// What the measurements of many frames are told alike.
#[derive(Debug, clap::Args)]
pub struct FrameOptions {
    /// Samples per pixel of the frames: 1, 4, 16, 36, 64 ...
    #[arg(long, default_value_t = DEFAULT_SAMPLES)]
    pub samples: u32,
    /// Set a scene key of what is measured, the camera's apart. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// A folder for the frames.
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// A picture of `size` pixels and `samples` samples a pixel.
///
/// # Errors
/// A number of samples that is not to be had.
pub fn request(size: [u32; 2], samples: u32, statistics: bool) -> Result<Request, Error> {
    let sampling = Sampling::new(samples).map_err(Error::Arguments)?;
    Ok(Request { size, sampling, statistics, profile: false })
}

/// Size of a pixel in mm at a distance of 1 mm.
pub fn pixel_tangent(fov_y_deg: f64, height_px: u32) -> f64 {
    2.0 * (0.5 * fov_y_deg.to_radians()).tan() / f64::from(height_px)
}

/// `first` and then `second`, which has the last word.
pub fn joined(first: &[String], second: &[String]) -> Vec<String> {
    [first, second].concat()
}
