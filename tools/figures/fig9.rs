//! Wu & Yuksel 2019, Fig. 9: core fibers, regular fibers, the two together, and every fiber.

use crate::looks::fiber;
use crate::sheet::{CAPTION, Sheet};
use crate::stage::{camera, preset, scene_of, shoot, strand};
use embedded_graphics::text::Alignment;
use glam::DVec3;
use std::sync::Arc;
use worsted::error::Error;
use worsted::scene::Scene;
use worsted::scene::file::{DebugTable, DisplayTable, FibersShown, QualityTable, SceneFile};
use worsted::vulkan::Device;

const YARN: &str = "cotton1";
const SIZE: [u32; 2] = [900, 150];
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
/// Of the picture, in outer diameters of the yarn: a fiber is then about two pixels wide.
const WIDTH_DIAMETERS: f64 = 8.0;
const VISIBLE_SHARE: f64 = 0.3;
const ROWS: [(FibersShown, &str); 4] = [
    (FibersShown::Core, "core fibers"),
    (FibersShown::Regular, "regular fibers"),
    (FibersShown::Both, "regular and core fibers"),
    (FibersShown::Every, "every fiber"),
];

/// Draws `docs/figures/fig9.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let row = SIZE[1] + CAPTION;
    let mut sheet = Sheet::new(SIZE[0], row * ROWS.len() as u32, PAPER);
    let width_mm = 2.0 * preset(YARN)?.outer_radius_mm() * WIDTH_DIAMETERS;
    for (i, (fibers, caption)) in ROWS.into_iter().enumerate() {
        let y = i as u32 * row;
        sheet.place(&shoot(device, scene(fibers, width_mm)?, SIZE, 16)?, 0, y);
        sheet.write(caption, 6, y + SIZE[1] + CAPTION / 2, INK, Alignment::Left);
        let px_per_mm = f64::from(SIZE[0]) / width_mm;
        sheet.scale_bar(1.0, px_per_mm, [SIZE[0] - 8, y + SIZE[1] + CAPTION / 2], INK);
    }
    sheet.save("fig9")
}

/// A straight strand; the seed being the same, the same fibers in every row.
fn scene(fibers: FibersShown, width_mm: f64) -> Result<Scene, Error> {
    let mut file = SceneFile {
        fiber: fiber(YARN),
        camera: camera(SIZE, width_mm, [0.0; 3]),
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        // A core that stands for more than it does by default, to be seen at work.
        quality: QualityTable { core_visible_share: VISIBLE_SHARE, ..Default::default() },
        debug: DebugTable { fibers, ..Default::default() },
        ..Default::default()
    };
    file.yarn.insert("preset".into(), YARN.into());
    // The yarn goes on beyond the picture.
    scene_of(file, YARN, vec![strand(0.7 * width_mm, 0.2, |s| DVec3::X * s)])
}
