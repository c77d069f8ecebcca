//! Wu & Yuksel 2019, Fig. 16: fibers close up in both shading models, and every one of them.

use crate::sheet::{CAPTION, Sheet};
use crate::stage::{camera, preset, shoot, swatch};
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::scene::Scene;
use worsted::scene::file::{CameraTable, DebugTable, DisplayTable, FibersShown, SceneFile};
use worsted::scene::file::{ShadingModel, ShadingTable};
use worsted::vulkan::Device;

const YARN: &str = "worsted_3ply";
/// Fiber presets, one to a row.
const FIBERS: [&str; 2] = ["silk", "cotton"];
const SIZE: [u32; 2] = [400, 330];
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
const PANELS: [(ShadingModel, FibersShown, &str); 3] = [
    (ShadingModel::Physical, FibersShown::Both, "physical, regular and core fibers"),
    (ShadingModel::Physical, FibersShown::Every, "physical, every fiber"),
    (ShadingModel::Simple, FibersShown::Both, "simple, regular and core fibers"),
];
/// Of the picture, in outer diameters of the yarn: a fiber is then nearly two pixels wide.
const WIDTH_DIAMETERS: f64 = 4.6;
/// Loops of a row and rows: a few more than the picture shows.
const LOOPS: u32 = 5;

/// Draws `docs/figures/fig16.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let step = [SIZE[0] + GAP, SIZE[1] + GAP];
    let captions = FIBERS.len() as u32 * step[1] - GAP;
    let mut sheet = Sheet::new(PANELS.len() as u32 * step[0] - GAP, captions + CAPTION, PAPER);
    let width_mm = 2.0 * preset(YARN)?.outer_radius_mm() * WIDTH_DIAMETERS;
    let px_per_mm = f64::from(SIZE[0]) / width_mm;
    for (column, (model, shown, caption)) in PANELS.into_iter().enumerate() {
        let x = column as u32 * step[0];
        for (row, fiber) in FIBERS.into_iter().enumerate() {
            let picture = shoot(device, scene(fiber, model, shown, width_mm)?, SIZE, 64)?;
            sheet.place(&picture, x, row as u32 * step[1]);
        }
        let middle = captions + CAPTION / 2;
        sheet.write(caption, x + 6, middle, INK, Alignment::Left);
        sheet.scale_bar(1.0, px_per_mm, [x + SIZE[0] - 8, middle], INK);
    }
    for (row, fiber) in FIBERS.into_iter().enumerate() {
        let middle = row as u32 * step[1] + 12;
        sheet.write(fiber, 7, middle + 1, PAPER, Alignment::Left);
        sheet.write(fiber, 6, middle, INK, Alignment::Left);
    }
    sheet.save("fig16")
}

fn scene(fiber: &str, model: ShadingModel, fibers: FibersShown, width_mm: f64) -> Result<Scene, Error> {
    let yarn_radius_mm = preset(YARN)?.outer_radius_mm();
    let face = [0.0, 0.0, yarn_radius_mm];
    let mut file = SceneFile {
        shading: ShadingTable { model, ..Default::default() },
        camera: CameraTable { yaw_deg: 20.0, pitch_deg: Some(15.0), ..camera(SIZE, width_mm, face) },
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        debug: DebugTable { fibers, ..Default::default() },
        ..Default::default()
    };
    file.yarn.insert("preset".into(), YARN.into());
    file.fiber.insert("preset".into(), fiber.into());
    Ok(Scene::stockinette(file, &swatch(yarn_radius_mm, LOOPS, LOOPS))?)
}
