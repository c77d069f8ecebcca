//! Every yarn preset, close up and at arm's length.

use crate::looks::fiber;
use crate::sheet::{CAPTION, Sheet};
use crate::stage::{camera, preset, scene_of, shoot, strand, swatch};
use embedded_graphics::text::Alignment;
use glam::DVec3;
use std::sync::Arc;
use toml::Table;
use worsted::error::Error;
use worsted::scene::Scene;
use worsted::scene::file::{DisplayTable, SceneFile};
use worsted::vulkan::Device;
use worsted::yarn::flyaway::Flyaways;
use worsted::yarn::presets::yarn_names;

const COLUMNS: u32 = 4;
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
const CLOSE: [u32; 2] = [296, 222];
const SWATCH: [u32; 2] = [296, 252];
/// Angle of each of the crossing strands to the horizontal.
const CROSSING_DEG: f64 = 24.0;
/// Loops of a swatch.
const COURSES: u32 = 11;
const WALES: u32 = 7;

/// Draws `docs/figures/presets-close.png` and `docs/figures/presets-swatch.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    sheet(device, "presets-close", CLOSE, close_up)?;
    sheet(device, "presets-swatch", SWATCH, whole_swatch)
}

/// A scene and how many mm of it the picture's width shows.
type Framed = (Scene, f64);

fn sheet(
    device: &Arc<Device>,
    title: &str,
    size: [u32; 2],
    framed: impl Fn(&str) -> Result<Framed, Error>,
) -> Result<(), Error> {
    let names: Vec<_> = yarn_names().collect();
    let rows = (names.len() as u32).div_ceil(COLUMNS);
    let cell = [size[0] + GAP, size[1] + CAPTION + GAP];
    let mut sheet = Sheet::new(COLUMNS * cell[0] + GAP, rows * cell[1] + GAP, PAPER);
    for (i, name) in names.iter().enumerate() {
        let (scene, width_mm) = framed(name)?;
        let picture = shoot(device, scene, size, 16)?;
        let [x, y] = [GAP + (i as u32 % COLUMNS) * cell[0], GAP + (i as u32 / COLUMNS) * cell[1]];
        sheet.place(&picture, x, y);
        sheet.write(name, x + 2, y + size[1] + CAPTION / 2, INK, Alignment::Left);
        let bar_mm = if width_mm > 12.0 { 5.0 } else { 1.0 };
        let end = [x + size[0] - 2, y + size[1] + CAPTION / 2];
        sheet.scale_bar(bar_mm, f64::from(size[0]) / width_mm, end, INK);
    }
    sheet.save(title)
}

fn file(name: &str) -> SceneFile {
    let mut yarn = Table::new();
    yarn.insert("preset".into(), name.into());
    let display = DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() };
    SceneFile { yarn, fiber: fiber(name), display, ..Default::default() }
}

/// Two strands, one over the other.
fn close_up(name: &str) -> Result<Framed, Error> {
    let yarn = preset(name)?;
    let outer_mm = yarn.outer_radius_mm();
    // Room for the halo of a brushed yarn.
    let halo = Flyaways::new(&yarn).reach_mm / outer_mm;
    let width_mm = 2.0 * outer_mm * if halo > 4.0 { 11.0 } else { 5.0 };
    let line = |side: f64| {
        let (sin, cos) = (side * CROSSING_DEG).to_radians().sin_cos();
        strand(0.9 * width_mm, 0.5 * outer_mm, move |s| {
            let lift = outer_mm * (-(s / (4.0 * outer_mm)).powi(2)).exp();
            DVec3::new(s * cos, s * sin, side * lift)
        })
    };
    let mut file = file(name);
    file.camera = camera(CLOSE, width_mm, [0.0; 3]);
    Ok((scene_of(file, name, vec![line(1.0), line(-1.0)])?, width_mm))
}

/// A small piece of stockinette, whole.
fn whole_swatch(name: &str) -> Result<Framed, Error> {
    let knit = swatch(preset(name)?.outer_radius_mm(), WALES, COURSES);
    let [wale_mm, _] = knit.spacing_mm();
    let width_mm = (f64::from(WALES) + 2.2) * wale_mm;
    let mut file = file(name);
    file.camera = camera(SWATCH, width_mm, [0.0; 3]);
    Ok((Scene::stockinette(file, &knit)?, width_mm))
}
