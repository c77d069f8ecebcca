//! Wu & Yuksel 2019, Fig. 13: one fabric in four yarns, with the same shading and light.

use crate::sheet::{CAPTION, Sheet};
use crate::stage::{COURSE_DIAMETERS, camera, preset, scene_of, shoot};
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::knit::params::KnitParams;
use worsted::knit::tube::{inner_radius_mm, tube};
use worsted::scene::Scene;
use worsted::scene::file::{CameraTable, DisplayTable, SceneFile};
use worsted::vulkan::Device;

const YARNS: [&str; 4] = ["worsted_3ply", "mercerised_2ply_cotton", "silk1", "mohair"];
const FULL: [u32; 2] = [290, 330];
const CLOSE: [u32; 2] = [290, 220];
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
const WALES: u32 = 16;
const COURSES: u32 = 16;
/// Of the pictures, in outer diameters of the yarn.
const FULL_WIDTH_DIAMETERS: f64 = 42.0;
const CLOSE_WIDTH_DIAMETERS: f64 = 9.5;

/// Draws `docs/figures/fig13.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let step = FULL[0] + GAP;
    let captions = FULL[1] + GAP + CLOSE[1];
    let mut sheet = Sheet::new(YARNS.len() as u32 * step - GAP, captions + CAPTION, PAPER);
    for (i, yarn) in YARNS.into_iter().enumerate() {
        let x = i as u32 * step;
        let diameter_mm = 2.0 * preset(yarn)?.outer_radius_mm();
        let full_mm = FULL_WIDTH_DIAMETERS * diameter_mm;
        sheet.place(&shoot(device, scene(yarn, camera(FULL, full_mm, [0.0; 3]))?, FULL, 16)?, x, 0);
        let close_mm = CLOSE_WIDTH_DIAMETERS * diameter_mm;
        let close = camera(CLOSE, close_mm, [0.0, 0.0, front_mm(yarn)?]);
        sheet.place(&shoot(device, scene(yarn, close)?, CLOSE, 16)?, x, FULL[1] + GAP);
        sheet.write(yarn, x + 2, captions + CAPTION / 2, INK, Alignment::Left);
        let px_per_mm = f64::from(CLOSE[0]) / close_mm;
        sheet.scale_bar(1.0, px_per_mm, [x + CLOSE[0] - 2, captions + CAPTION / 2], INK);
    }
    sheet.save("fig13")
}

/// The same tube in every yarn's own size: all lengths are in proportion to its outer radius.
fn knit(yarn: &str) -> Result<KnitParams, Error> {
    let yarn_radius_mm = preset(yarn)?.outer_radius_mm();
    let course_spacing_mm = Some(COURSE_DIAMETERS * 2.0 * yarn_radius_mm);
    Ok(KnitParams { courses: COURSES, wales: WALES, yarn_radius_mm, course_spacing_mm, ..KnitParams::tube() })
}

/// Of the tube's face from its axis: about one diameter before the innermost centre lines.
fn front_mm(yarn: &str) -> Result<f64, Error> {
    let knit = knit(yarn)?;
    Ok(inner_radius_mm(&knit) + 2.0 * knit.yarn_radius_mm)
}

/// The yarn in the fiber's default look.
fn scene(yarn: &str, camera: CameraTable) -> Result<Scene, Error> {
    let mut file = SceneFile {
        camera: CameraTable { yaw_deg: 12.0, pitch_deg: Some(16.0), ..camera },
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        ..Default::default()
    };
    file.yarn.insert("preset".into(), yarn.into());
    scene_of(file, yarn, tube(&knit(yarn)?)?.curves)
}
