//! `worsted render`.

use super::job::RenderJob;
use super::open_device;
use super::output::write_text;
use crate::error::Error;
use crate::frame::Renderer;
use crate::frame::stats::Stats;
use crate::vulkan::Device;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// Draws, writes, reports.
///
/// # Errors
/// No device, a device that fails, files that cannot be written, pixels that are not numbers.
pub fn run(job: &RenderJob) -> Result<(), Error> {
    report_notes(job);
    let device = open_device(&job.common)?;
    let stats = draw(job, &device)?;
    Device::shutdown(device)?;
    if let Some(path) = &job.stats {
        let text =
            serde_json::to_string_pretty(&stats).map_err(|e| Error::Failed(format!("statistics: {e}")))?;
        write_text(path, &text)?;
    }
    if job.explain {
        explain(&stats);
    }
    if stats.nan_pixels > 0 {
        let message = format!("{} pixels are not finite numbers: please report this scene", stats.nan_pixels);
        return Err(Error::Failed(message));
    }
    Ok(())
}

fn draw(job: &RenderJob, device: &std::sync::Arc<Device>) -> Result<Stats, Error> {
    let mut renderer = Renderer::new(device, job.scene.clone(), job.request)?;
    let bar = progress_bar(job);
    let pictures = f64::from(job.repeat);
    let mut picture = None;
    for index in 0..job.repeat {
        let before = f64::from(index);
        let progress = |share: f64| bar.set_position(((before + share) / pictures * 1000.0) as u64);
        picture = Some(renderer.render(&progress)?);
    }
    bar.finish_and_clear();
    if let Some(picture) = &picture {
        for output in &job.outputs {
            output.write(picture)?;
        }
    }
    let mut stats = renderer.stats().clone();
    stats.set_gpu_bytes(device);
    Ok(stats)
}

/// A bar with the time left, on a terminal only.
fn progress_bar(job: &RenderJob) -> ProgressBar {
    if job.common.quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {percent}% {elapsed} (left: {eta})");
    ProgressBar::new(1000).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// What a user should know of how the yarn was read.
fn report_notes(job: &RenderJob) {
    if job.common.quiet {
        return;
    }
    for fabric in &job.scene.fabrics {
        for note in &fabric.notes {
            eprintln!("{}: {note}", fabric.name);
        }
    }
}

fn explain(stats: &Stats) {
    println!("device: {} ({})", stats.device, stats.driver);
    println!("drawn: {} pieces of yarn, {} fiber curves", stats.yarn_segments, stats.fiber_curves);
    for (what, bytes) in &stats.gpu_bytes {
        println!("built: {what}, {bytes} bytes");
    }
    for (what, why) in &stats.left_out {
        println!("left out: {what}, because {why}");
    }
}
