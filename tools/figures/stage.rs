//! What stands before the camera, and the camera.

use glam::DVec3;
use std::sync::Arc;
use worsted::error::Error;
use worsted::frame::{Picture, Renderer, Request};
use worsted::io::curves::{Basis, Curve, CurveSet, UpAxis};
use worsted::io::yarn_file::Loaded;
use worsted::knit::params::KnitParams;
use worsted::scene::file::{CameraTable, FabricTable, SceneFile};
use worsted::scene::{Fabric, Scene};
use worsted::vulkan::Device;
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

/// Narrow, so that a strand is as thick at the picture's edge as in its middle.
const FOV_Y_DEG: f64 = 12.0;
/// Between courses, in yarn diameters: closer than the generator's default, as hand knitting is.
pub const COURSE_DIAMETERS: f64 = 2.4;

/// The preset of that name.
///
/// # Errors
/// No such preset.
pub fn preset(name: &str) -> Result<YarnParams, Error> {
    presets::yarn(name).ok_or_else(|| Error::Failed(format!("no yarn preset `{name}`")))
}

/// A camera along -Z that sees `width_mm` of the plane through `target_mm`, in a picture of `size` pixels.
pub fn camera(size: [u32; 2], width_mm: f64, target_mm: [f64; 3]) -> CameraTable {
    let height_mm = width_mm * f64::from(size[1]) / f64::from(size[0]);
    CameraTable {
        pitch_deg: Some(0.0),
        distance_mm: Some(0.5 * height_mm / (0.5 * FOV_Y_DEG.to_radians()).tan()),
        target_mm: Some(target_mm),
        fov_y_deg: FOV_Y_DEG,
        ..Default::default()
    }
}

/// A swatch of stockinette in a yarn of that outer radius.
pub fn swatch(yarn_radius_mm: f64, wales: u32, courses: u32) -> KnitParams {
    let course_spacing_mm = Some(COURSE_DIAMETERS * 2.0 * yarn_radius_mm);
    KnitParams { courses, wales, yarn_radius_mm, course_spacing_mm, ..KnitParams::swatch() }
}

/// A scene of one fabric whose centre lines are given in mm.
///
/// # Errors
/// Yarn parameters out of range.
pub fn scene_of(file: SceneFile, name: &str, curves: Vec<Curve>) -> Result<Scene, Error> {
    let curves = CurveSet { basis: Basis::CatmullRom, up_axis: Some(UpAxis::Y), curves };
    let loaded = Loaded::of_curves(curves, "figure");
    let table = FabricTable { mm_per_unit: Some(1.0), ..Default::default() };
    let fabric = Fabric::from_loaded(&file, &table, &loaded, name)?;
    Ok(Scene { file, fabrics: vec![fabric], origin_mm: DVec3::ZERO, environment: None })
}

/// An open strand through `at(s)` for s from -`half_mm` to `half_mm`, control points about `step_mm` apart.
pub fn strand(half_mm: f64, step_mm: f64, at: impl Fn(f64) -> DVec3) -> Curve {
    let steps = (half_mm / step_mm).ceil() as i32;
    let place = |i: i32| at(half_mm * f64::from(i) / f64::from(steps));
    Curve { points: (-steps..=steps).map(place).collect(), closed: false }
}

/// Draws a scene with `samples` samples a pixel.
///
/// # Errors
/// Those of the device.
pub fn shoot(device: &Arc<Device>, scene: Scene, size: [u32; 2], samples: u32) -> Result<Picture, Error> {
    let sampling = worsted::frame::sampling::Sampling::new(samples).map_err(Error::Failed)?;
    let request = Request { size, sampling, statistics: false, profile: false };
    Ok(Renderer::new(device, scene, request)?.render(&|_| {})?)
}
