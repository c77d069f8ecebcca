//! What stands before the camera: knitted fabrics as scene files, so that overrides are read and checked as
//! those of `worsted render` are; and pictures of them.

use crate::looks;
use crate::pictures::Shot;
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;
use worsted::error::Error;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::bcc::write_bcc;
use worsted::io::curves::{Basis, Curve, CurveSet};
use worsted::io::error::FileError;
use worsted::knit::params::KnitParams;
use worsted::knit::stockinette::stockinette;
use worsted::knit::tube::tube;
use worsted::scene::Scene;
use worsted::scene::file::{FabricTable, SceneFile};
use worsted::vulkan::{Device, DeviceOptions};
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

/// Samples a pixel of `worsted render` where nothing is said.
pub const DEFAULT_SAMPLES: u32 = 4;
/// Draws every fiber and no core, at full detail: what level of detail approximates.
pub const EVERY_FIBER: &str = "debug.fibers=every";
/// How far from the middle of a fabric its front is looked for, in yarn diameters: over half a loop.
const FRONT_DIAMETERS: f64 = 2.5;

/// Generated fabric.
#[derive(Clone, Copy, Debug)]
pub enum Cloth {
    /// A flat swatch.
    Stockinette {
        /// Loops of a row.
        wales: u32,
        /// Rows of loops.
        courses: u32,
    },
    /// Knit in the round.
    Tube {
        /// Loops around.
        wales: u32,
        /// Rounds of loops.
        courses: u32,
    },
    /// One straight yarn, which nothing but its own fibers shadows.
    Straight,
}

impl Cloth {
    /// Its pattern's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stockinette { .. } => "stockinette",
            Self::Tube { .. } => "tube",
            Self::Straight => "straight yarn",
        }
    }

    fn knit(self, yarn_radius_mm: f64) -> Result<CurveSet, Error> {
        Ok(match self {
            Self::Stockinette { wales, courses } => {
                stockinette(&KnitParams { wales, courses, yarn_radius_mm, ..KnitParams::swatch() })?
            }
            Self::Tube { wales, courses } => {
                tube(&KnitParams { wales, courses, yarn_radius_mm, ..KnitParams::tube() })?
            }
            Self::Straight => straight(yarn_radius_mm),
        })
    }
}

/// Along X, longer than any close view is wide.
fn straight(yarn_radius_mm: f64) -> CurveSet {
    let points = (-100..=100).map(|i| DVec3::new(f64::from(i) * yarn_radius_mm, 0.0, 0.0)).collect();
    let curve = Curve { points, closed: false };
    CurveSet { basis: Basis::CatmullRom, up_axis: None, curves: vec![curve] }
}

/// A fabric as a scene file.
pub struct Model {
    /// The scene file.
    pub path: PathBuf,
    /// Its yarn.
    pub yarn: YarnParams,
    /// Height in mm of the fabric's front above the plane through its middle, along +Z.
    pub front_mm: f64,
    /// Largest distance in mm of a centre line from the Y axis.
    pub reach_mm: f64,
}

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
        let params =
            presets::yarn(yarn).ok_or_else(|| Error::Arguments(format!("no yarn preset `{yarn}`")))?;
        let curves = cloth.knit(params.outer_radius_mm())?;
        let points = || curves.curves.iter().flat_map(|curve| &curve.points);
        let near_mm = FRONT_DIAMETERS * 2.0 * params.outer_radius_mm();
        let in_the_middle = points().filter(|p| p.x.abs() < near_mm && p.y.abs() < near_mm);
        let front_mm = in_the_middle.fold(0.0, |most: f64, p| most.max(p.z)) + params.outer_radius_mm();
        let reach_mm = points().fold(0.0, |most: f64, p| most.max(p.x.hypot(p.z)));

        let model = format!("{yarn}-{}.bcc", cloth.name()).replace(' ', "-");
        write_bcc(&self.folder.path().join(&model), &curves)?;
        let mut file = SceneFile { fiber: looks::fiber(yarn), ..Default::default() };
        file.yarn.insert("preset".into(), yarn.into());
        file.fabric = vec![FabricTable { model, mm_per_unit: Some(1.0), ..Default::default() }];
        let text = toml::to_string(&file).map_err(|e| Error::Failed(format!("scene file: {e}")))?;
        let path = self.folder.path().join(format!("{yarn}-{}.toml", cloth.name()));
        std::fs::write(&path, text).map_err(|e| FileError::io(&path, "write", &e))?;
        Ok(Model { path, yarn: params, front_mm, reach_mm })
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
