//! `worsted doctor`.

use super::args::Common;
use super::open_device;
use crate::cli::say::say;
use crate::error::Error;
use crate::frame::sampling::Sampling;
use crate::frame::{Renderer, Request};
use crate::knit::params::KnitParams;
use crate::scene::{Scene, SceneFile};
use crate::vulkan::{Device, DeviceFacts, DoctorReport, inspect};
use std::sync::Arc;

/// Prints what this machine's Vulkan offers and checks that it draws what it is asked to.
///
/// # Errors
/// No usable device, or one that draws wrongly.
pub fn run(common: &Common) -> Result<(), Error> {
    let report = inspect(&common.device.parse().unwrap_or_default());
    print_report(&report);
    let device = open_device(common)?;
    let check = draw_caps_agree(&device);
    Device::shutdown(device)?;
    check?;
    say!("self-check: the same picture whatever the size of its draw calls: good");
    Ok(())
}

fn print_report(report: &DoctorReport) {
    match &report.loader {
        Some(version) => say!("Vulkan loader: {version}"),
        None => say!("Vulkan loader: missing"),
    }
    say!("validation layer: {}", if report.validation_layer { "present" } else { "missing" });
    for (index, device) in report.devices.iter().enumerate() {
        print_device(device, report.chosen == Some(index));
    }
    if let Some(problem) = &report.problem {
        say!("problem: {problem}");
    }
    for fix in &report.fixes {
        say!("fix: {fix}");
    }
}

fn print_device(device: &DeviceFacts, chosen: bool) {
    let mark = if chosen { "would be used" } else { "not used" };
    say!("device {}: {} ({}), {mark}", device.index, device.name, device.kind);
    say!(
        "  Vulkan {}, driver {}, {} MiB",
        device.api_version,
        device.driver,
        device.device_memory_bytes >> 20
    );
    for (need, met) in &device.needs {
        say!("  needs {need}: {}", if *met { "yes" } else { "MISSING" });
    }
    for (feature, there) in &device.optional {
        say!("  may use {feature}: {}", if *there { "yes" } else { "no" });
    }
    for (limit, value) in &device.limits {
        say!("  {limit} = {value}");
    }
}

/// Draws one scene with small and with the largest planned draws. Some drivers silently draw a wrong
/// picture when one draw evaluates too many tessellation vertices.
fn draw_caps_agree(device: &Arc<Device>) -> Result<(), Error> {
    let draw = |patches_per_draw: u32| -> Result<Vec<[f32; 4]>, Error> {
        let scene = self_check_scene(patches_per_draw)?;
        let sampling = Sampling::new(1).map_err(Error::Failed)?;
        let request = Request { size: [160, 120], sampling, statistics: false, profile: false };
        let mut renderer = Renderer::new(device, scene, request)?;
        Ok(renderer.render(&|_| ())?.linear)
    };
    let (single, large) = (draw(1)?, draw(1_000_000)?);
    let differing = single.iter().zip(&large).filter(|(a, b)| a != b).count();
    if single.iter().all(|pixel| pixel[3] == 0.0) {
        return Err(Error::Failed("self-check: the device drew nothing".into()));
    }
    // Where two fibers lie at the same depth the order of draws may decide: a handful of pixels.
    if differing > single.len() / 500 {
        return Err(Error::Failed(format!(
            "self-check: {differing} of {} pixels depend on the size of draw calls; this driver cannot be trusted",
            single.len()
        )));
    }
    Ok(())
}

/// A small swatch, generated.
fn self_check_scene(patches_per_draw: u32) -> Result<Scene, Error> {
    let mut file = SceneFile::default();
    file.quality.patches_per_draw = Some(patches_per_draw);
    let knit = KnitParams { courses: 2, wales: 3, ..KnitParams::swatch() };
    Ok(Scene::stockinette(file, &knit)?)
}
