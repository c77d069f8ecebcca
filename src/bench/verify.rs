//! What a promise is held against, measured anew: error against a traced reference, and time.

use super::against;
use super::measure::{Measured, measure};
use super::references::reference;
use super::truth::{Progress, TruthSettings};
use crate::error::Error;
use crate::frame::Request;
use crate::io::cache::Cache;
use crate::io::picture::LinearImage;
use crate::scene::Scene;
use crate::vulkan::Device;
use std::sync::Arc;

/// Samples a pixel of the reference: as many as `worsted bench` has.
pub const SAMPLES: u64 = 64;
/// Pictures of which the median is held against a promised time.
const FRAMES: u32 = 3;

/// Mean FLIP over covered pixels of a picture against the traced reference of the scene, which is that before a budget
/// changed it.
///
/// # Errors
/// Those of the reference; pictures that cannot be compared.
pub fn error(
    cache: &Cache,
    asked_for: &Scene,
    drawn: &LinearImage,
    progress: &mut Progress<'_>,
) -> Result<f64, Error> {
    let settings = TruthSettings { samples: SAMPLES, floors: Vec::new() };
    let truth = reference(cache, asked_for, [drawn.width, drawn.height], &settings, progress)?;
    Ok(against(drawn, &truth.picture.mean)?.error.covered.flip_mean)
}

/// Draws the scene as often as a promised time is verified by: the median counts.
///
/// # Errors
/// Those of the device.
pub fn times(device: &Arc<Device>, scene: Scene, request: Request) -> Result<Measured, Error> {
    measure(device, scene, request, FRAMES)
}
