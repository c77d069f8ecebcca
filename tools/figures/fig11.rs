//! Wu & Yuksel 2019, Fig. 11: knit fabric from near to far without level of detail, with it, and in its
//! heat colours.

use crate::looks::fiber;
use crate::sheet::{CAPTION, Sheet};
use crate::stage::{preset, shoot, swatch};
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::scene::Scene;
use worsted::scene::file::{CameraTable, DebugTable, DebugView, DisplayTable, QualityTable, SceneFile};
use worsted::vulkan::Device;

/// Few fibers, as in the paper's figure.
const YARN: &str = "cotton2";
const SIZE: [u32; 2] = [400, 440];
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
const WALES: u32 = 26;
const COURSES: u32 = 60;
/// The camera stands before the swatch's lower edge and looks up along it.
const PITCH_DEG: f64 = -68.0;
const FOV_Y_DEG: f64 = 40.0;
/// Of the camera from its target, in outer diameters of the yarn.
const DISTANCE_DIAMETERS: f64 = 22.0;
/// Of the target below the swatch's centre, likewise.
const TARGET_DIAMETERS: f64 = 58.0;

/// Draws `docs/figures/fig11.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let panels = [
        (false, DebugView::Shaded, "without level of detail"),
        (true, DebugView::Shaded, "with level of detail"),
        (true, DebugView::LevelOfDetail, "red all, blue core fibers alone"),
    ];
    let step = SIZE[0] + GAP;
    let mut sheet = Sheet::new(panels.len() as u32 * step - GAP, SIZE[1] + CAPTION, PAPER);
    for (i, (level_of_detail, view, caption)) in panels.into_iter().enumerate() {
        let x = i as u32 * step;
        sheet.place(&shoot(device, scene(level_of_detail, view)?, SIZE, 16)?, x, 0);
        sheet.write(caption, x + 6, SIZE[1] + CAPTION / 2, INK, Alignment::Left);
    }
    sheet.save("fig11")
}

fn scene(level_of_detail: bool, view: DebugView) -> Result<Scene, Error> {
    let yarn_radius_mm = preset(YARN)?.outer_radius_mm();
    let diameter_mm = 2.0 * yarn_radius_mm;
    let mut file = SceneFile {
        fiber: fiber(YARN),
        camera: CameraTable {
            pitch_deg: Some(PITCH_DEG),
            distance_mm: Some(DISTANCE_DIAMETERS * diameter_mm),
            target_mm: Some([0.0, -TARGET_DIAMETERS * diameter_mm, 0.0]),
            fov_y_deg: FOV_Y_DEG,
            ..Default::default()
        },
        quality: QualityTable { level_of_detail, ..Default::default() },
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        debug: DebugTable { view, ..Default::default() },
        ..Default::default()
    };
    file.yarn.insert("preset".into(), YARN.into());
    Ok(Scene::stockinette(file, &swatch(yarn_radius_mm, WALES, COURSES))?)
}
