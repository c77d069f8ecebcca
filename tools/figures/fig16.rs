//! Wu & Yuksel 2019, Fig. 16: fibers close up, as drawn by default and every one of them.

use crate::looks::fiber;
use crate::sheet::{CAPTION, Sheet};
use crate::stage::{camera, preset, shoot, swatch};
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::scene::Scene;
use worsted::scene::file::{CameraTable, DebugTable, DisplayTable, FibersShown, SceneFile};
use worsted::vulkan::Device;

const YARN: &str = "worsted_3ply";
const SIZE: [u32; 2] = [560, 460];
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
const PANELS: [(FibersShown, &str); 2] =
    [(FibersShown::Both, "regular and core fibers"), (FibersShown::Every, "every fiber")];
/// Of the picture, in outer diameters of the yarn: a fiber is then more than two pixels wide.
const WIDTH_DIAMETERS: f64 = 5.0;
/// Loops of a row and rows: a few more than the picture shows.
const LOOPS: u32 = 5;

/// Draws `docs/figures/fig16.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let step = SIZE[0] + GAP;
    let mut sheet = Sheet::new(PANELS.len() as u32 * step - GAP, SIZE[1] + CAPTION, PAPER);
    let width_mm = 2.0 * preset(YARN)?.outer_radius_mm() * WIDTH_DIAMETERS;
    for (i, (fibers, caption)) in PANELS.into_iter().enumerate() {
        let x = i as u32 * step;
        sheet.place(&shoot(device, scene(fibers, width_mm)?, SIZE, 64)?, x, 0);
        sheet.write(caption, x + 6, SIZE[1] + CAPTION / 2, INK, Alignment::Left);
        let px_per_mm = f64::from(SIZE[0]) / width_mm;
        sheet.scale_bar(1.0, px_per_mm, [x + SIZE[0] - 8, SIZE[1] + CAPTION / 2], INK);
    }
    sheet.save("fig16")
}

fn scene(fibers: FibersShown, width_mm: f64) -> Result<Scene, Error> {
    let yarn_radius_mm = preset(YARN)?.outer_radius_mm();
    let face = [0.0, 0.0, yarn_radius_mm];
    let mut file = SceneFile {
        fiber: fiber(YARN),
        camera: CameraTable { yaw_deg: 20.0, pitch_deg: Some(15.0), ..camera(SIZE, width_mm, face) },
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        debug: DebugTable { fibers, ..Default::default() },
        ..Default::default()
    };
    file.yarn.insert("preset".into(), YARN.into());
    Ok(Scene::stockinette(file, &swatch(yarn_radius_mm, LOOPS, LOOPS))?)
}
