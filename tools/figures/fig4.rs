//! Wu & Yuksel 2019, Fig. 4: which periods of which fibers are migration, loop and hair.

use crate::sheet::Sheet;
use crate::stage::{camera, preset, scene_of, shoot, strand};
use embedded_graphics::text::Alignment;
use glam::DVec3;
use std::sync::Arc;
use toml::{Table, toml};
use worsted::error::Error;
use worsted::scene::file::{DebugTable, DebugView, FibersShown, SceneFile};
use worsted::vulkan::Device;

const SIZE: [u32; 2] = [1400, 260];
const LEGEND: u32 = 30;
/// As many as are in the paper's figure.
const PERIODS: f64 = 4.0;

/// A ply of few fibers that migrate far, so that each can be followed, wide for its length; a tenth of
/// its periods are loops, a seventh hairs.
fn few_fibers() -> Table {
    toml! {
        preset = "cotton1"
        ply_count = 1
        ply_pitch_mm = "untwisted"
        fibers_per_ply = 12
        ellipse_short_mm = 0.5
        ellipse_long_mm = 0.5
        migration_min = 0.3
        fiber_diameter_um = 34
        loop_density_per_mm = 0.33
        loop_radius_mm = [0.85, 0.12]
        hair_density_per_mm = 0.47
        hair_length_mm = [1.6, 0.4]
        hair_radius_start_mm = [0.5, 0.05]
        hair_radius_gain_mm = [0.5, 0.15]
    }
}

/// Draws `docs/figures/fig4.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let yarn = preset("cotton1")?;
    let period_mm = yarn.fiber_pitch_mm.unwrap_or(1.0) / yarn.migration_rate;
    let width_mm = PERIODS * period_mm;
    let file = SceneFile {
        seed: 5,
        yarn: few_fibers(),
        camera: camera(SIZE, width_mm, [0.0; 3]),
        debug: DebugTable { view: DebugView::Kind, fibers: FibersShown::Every },
        ..Default::default()
    };
    let line = strand(0.7 * width_mm, 0.25, |s| DVec3::X * s);
    let picture = shoot(device, scene_of(file, "fig4", vec![line])?, SIZE, 64)?;
    let mut sheet = Sheet::new(SIZE[0], SIZE[1] + LEGEND, [255; 3]);
    sheet.place_on_white(&picture, 0, LEGEND);
    let legend = [("migration", [60, 60, 60]), ("loop", [40, 150, 50]), ("hair", [200, 40, 30])];
    for (i, (text, ink)) in legend.into_iter().enumerate() {
        sheet.write(text, 12 + 110 * i as u32, LEGEND / 2, ink, Alignment::Left);
    }
    sheet.scale_bar(1.0, f64::from(SIZE[0]) / width_mm, [SIZE[0] - 12, LEGEND / 2], [60; 3]);
    sheet.save("fig4")
}
