//! One way to draw one picture: drawn, timed, compared.

use super::clock::timed;
use crate::error::Error;
use crate::frame::stats::Stats;
use crate::frame::{Renderer, Request};
use crate::io::picture::{DisplayImage, LinearImage};
use crate::math::spread::Spread;
use crate::scene::Scene;
use crate::vulkan::{Device, Taken};
use std::sync::Arc;
use std::time::Duration;

/// Above so many seconds of a picture fewer are drawn: what is slow is steady.
const SLOW_SECONDS: f64 = 1.0;

/// A measured picture.
pub struct Measured {
    /// Radiance and coverage.
    pub linear: LinearImage,
    /// As displayed.
    pub display: DisplayImage,
    /// Processor time of all threads, ms.
    pub cpu_ms: Spread,
    /// Wall time from every submission to its fence, ms.
    pub wall_ms: Spread,
    /// Between timestamps of the device, ms, where it has a clock of its own.
    pub device_ms: Option<Spread>,
    /// Wall time of the first picture, which is not among the others, ms.
    pub warm_up_ms: f64,
    /// Device memory.
    pub gpu_bytes: u64,
    /// What was counted.
    pub stats: Stats,
}

/// Draws the scene once to warm up, then `frames` times, but only twice where a picture takes seconds.
///
/// # Errors
/// Those of the device; pixels that are no numbers.
pub fn measure(device: &Arc<Device>, scene: Scene, request: Request, frames: u32) -> Result<Measured, Error> {
    let mut renderer = Renderer::new(device, scene, request)?;
    let (_, warm_up) = timed(|| renderer.render(&|_| ()))?;
    let wanted = if warm_up.wall > SLOW_SECONDS { frames.min(2) } else { frames };
    let (mut cpu_ms, mut wall_ms, mut device_ms) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = None;
    for _ in 0..wanted.max(1) {
        let (picture, seconds) = timed(|| renderer.render(&|_| ()))?;
        let frame = renderer.stats().last_frame().unwrap_or(Taken::NOTHING);
        cpu_ms.push(1e3 * seconds.cpu);
        wall_ms.push(ms(frame.wall));
        device_ms.extend(frame.device.map(ms));
        last = Some(picture);
    }
    let mut stats = renderer.stats().clone();
    stats.set_gpu_bytes(device);
    let picture = last.ok_or_else(|| Error::Failed("expected a picture, found none".into()))?;
    if stats.nan_pixels > 0 {
        return Err(Error::Failed(format!("{} pixels are not finite numbers", stats.nan_pixels)));
    }
    let [width, height] = picture.size;
    let spread = |values: &[f64]| Spread::of(values).unwrap_or_default();
    Ok(Measured {
        linear: LinearImage { width, height, pixels: picture.linear },
        display: DisplayImage { width, height, pixels: picture.display },
        cpu_ms: spread(&cpu_ms),
        wall_ms: spread(&wall_ms),
        device_ms: Spread::of(&device_ms),
        warm_up_ms: 1e3 * warm_up.wall,
        gpu_bytes: stats.gpu_bytes.values().sum(),
        stats,
    })
}

fn ms(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}
