//! `worsted render`.

use super::job::{RenderJob, report_notes};
use super::open_device;
use super::output::write_text;
use super::progress::{set_share, share_bar};
use crate::bench::clock::host_peak_bytes;
use crate::cli::say::say;
use crate::error::Error;
use crate::frame::stats::Stats;
use crate::frame::{Picture, Renderer};
use crate::motion::mover::Movers;
use crate::vulkan::Device;
use std::sync::Arc;

/// Draws, writes, reports.
///
/// # Errors
/// No device, a device that fails, files that cannot be written, pixels that are not numbers, a budget that cannot
/// be kept or was not.
pub fn run(mut job: RenderJob) -> Result<(), Error> {
    report_notes(&job.scene, &job.common);
    let device = open_device(&job.common)?;
    let budget = job.budget.take();
    if let Some(budget) = &budget {
        budget.settle(&mut job, &device)?;
    }
    let (picture, stats) = draw(&job, &device)?;
    let kept = budget.map_or(Ok(()), |budget| budget.verify(&job, &device, &picture));
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
    kept
}

fn draw(job: &RenderJob, device: &Arc<Device>) -> Result<(Picture, Stats), Error> {
    let mut renderer = renderer(job, device)?;
    let bar = share_bar(&job.common);
    let pictures = f64::from(job.repeat);
    let mut picture = None;
    for index in 0..job.repeat {
        let before = f64::from(index);
        let progress = |share: f64| set_share(&bar, (before + share) / pictures);
        picture = Some(renderer.render(&progress)?);
    }
    bar.finish_and_clear();
    let picture = picture.ok_or_else(|| Error::Failed("expected a picture, found none".into()))?;
    for output in &job.outputs {
        output.write(&picture)?;
    }
    let mut stats = renderer.stats().clone();
    stats.set_gpu_bytes(device);
    stats.host_peak_bytes = host_peak_bytes();
    Ok((picture, stats))
}

/// The job's renderer, with the fabrics where the frame that is asked for has them.
fn renderer(job: &RenderJob, device: &Arc<Device>) -> Result<Renderer, Error> {
    let Some(frame) = job.scene.file.animation.frame else {
        return Ok(Renderer::keeping(device, job.scene.clone(), job.request, &job.kept)?);
    };
    let mut scene = job.scene.clone();
    let mut movers = Movers::open(&scene)?;
    movers.fix_camera(&mut scene, job.request.size)?;
    let mut renderer = Renderer::keeping(device, scene, job.request, &job.kept)?;
    let mut poser = renderer.poser(movers, std::iter::once(frame));
    let posed = poser.next_frame()?;
    let mut posed = posed.ok_or_else(|| Error::Failed(format!("expected frame {frame}, found none")))?;
    renderer.pose(&mut posed)?;
    Ok(renderer)
}

fn explain(stats: &Stats) {
    say!("device: {} ({})", stats.device, stats.driver);
    say!("drawn: {} pieces of yarn, {} fiber curves", stats.yarn_segments, stats.fiber_curves);
    for (what, taken) in &stats.load_ms {
        say!("loaded: {what}, {taken:.1} ms");
    }
    for (what, taken) in &stats.precompute_ms {
        let cached = if stats.precompute_from_cache.contains(what) { "read from the cache" } else { "baked" };
        say!("{cached}: {what}, {taken:.1} ms");
    }
    let given = stats
        .pipelines_from_cache_bytes
        .map_or_else(String::new, |bytes| format!(", the driver given {bytes} bytes of an earlier run"));
    say!("built: {} pipelines, {:.1} ms{given}", stats.pipelines_built, stats.pipelines_ms);
    for (what, bytes) in &stats.gpu_bytes {
        say!("built: {what}, {bytes} bytes");
    }
    say!("on the device: {} bytes", stats.gpu_bytes.values().sum::<u64>());
    if let Some(bytes) = stats.host_peak_bytes {
        say!("on the host: {bytes} bytes at most");
    }
    for (what, why) in &stats.left_out {
        let saved = stats.left_out_bytes.get(what);
        let saved = saved.map_or_else(String::new, |bytes| format!(": {bytes} bytes saved"));
        let bake = stats.left_out_bake_ms.get(what);
        let bake = bake.map_or_else(String::new, |ms| format!("; {ms:.1} ms of baking, as last here"));
        say!("left out: {what}, because {why}{saved}{bake}");
    }
    say!("milliseconds of pictures that this saves: worsted bench --ablate");
    for (what, why) in &stats.left_out_of_frame {
        say!("left out of the picture: {what}, because {why}");
    }
}
