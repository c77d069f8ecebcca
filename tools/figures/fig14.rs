//! Wu & Yuksel 2019, Fig. 14: what each component of the physical model adds, and the simple model beside it.

use crate::sheet::{CAPTION, Sheet};
use crate::stage::{COURSE_DIAMETERS, camera, preset, scene_of, shoot};
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::knit::params::KnitParams;
use worsted::knit::tube::tube;
use worsted::scene::Scene;
use worsted::scene::file::{CameraTable, DisplayTable, SceneFile, ShadingModel, ShadingTable};
use worsted::vulkan::Device;

/// The cloth of both rows.
const YARN: &str = "worsted_3ply";
/// Fiber presets, one to a row.
const FIBERS: [&str; 2] = ["silk", "cotton"];
/// Caption, model, diffuse, ambient; highlights are in all of them.
const PANELS: [(&str, ShadingModel, bool, bool); 5] = [
    ("specular", ShadingModel::Physical, false, false),
    ("specular + diffuse", ShadingModel::Physical, true, false),
    ("specular + ambient", ShadingModel::Physical, false, true),
    ("all", ShadingModel::Physical, true, true),
    ("simple model", ShadingModel::Simple, true, true),
];
const SIZE: [u32; 2] = [236, 260];
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
const WALES: u32 = 14;
const COURSES: u32 = 11;
/// Of the picture, in outer diameters of the yarn.
const WIDTH_DIAMETERS: f64 = 30.0;

/// Draws `docs/figures/fig14.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let step = [SIZE[0] + GAP, SIZE[1] + GAP];
    let captions = FIBERS.len() as u32 * step[1] - GAP;
    let mut sheet = Sheet::new(PANELS.len() as u32 * step[0] - GAP, captions + CAPTION, PAPER);
    for (row, fiber) in FIBERS.into_iter().enumerate() {
        for (column, (caption, model, diffuse, ambient)) in PANELS.into_iter().enumerate() {
            let shading = ShadingTable { model, diffuse, ambient, ..Default::default() };
            let [x, y] = [column as u32 * step[0], row as u32 * step[1]];
            sheet.place(&shoot(device, scene(fiber, shading)?, SIZE, 16)?, x, y);
            sheet.write(caption, x + 4, captions + CAPTION / 2, INK, Alignment::Left);
        }
        let middle = row as u32 * step[1] + 12;
        sheet.write(fiber, 7, middle + 1, PAPER, Alignment::Left);
        sheet.write(fiber, 6, middle, INK, Alignment::Left);
    }
    sheet.save("fig14")
}

fn scene(fiber: &str, shading: ShadingTable) -> Result<Scene, Error> {
    let yarn_radius_mm = preset(YARN)?.outer_radius_mm();
    let course_spacing_mm = Some(COURSE_DIAMETERS * 2.0 * yarn_radius_mm);
    let knit = KnitParams {
        courses: COURSES,
        wales: WALES,
        yarn_radius_mm,
        course_spacing_mm,
        ..KnitParams::tube()
    };
    let width_mm = WIDTH_DIAMETERS * 2.0 * yarn_radius_mm;
    let mut file = SceneFile {
        shading,
        camera: CameraTable { yaw_deg: 12.0, pitch_deg: Some(16.0), ..camera(SIZE, width_mm, [0.0; 3]) },
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        ..Default::default()
    };
    file.yarn.insert("preset".into(), YARN.into());
    file.fiber.insert("preset".into(), fiber.into());
    scene_of(file, YARN, tube(&knit)?.curves)
}
