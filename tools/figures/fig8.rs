//! Wu & Yuksel 2019, Fig. 8: where the fibers are, and what ambient light they leave one another.

use crate::section::{WHITE_DENSITY, density, section, signed};
use crate::sheet::{CAPTION, Sheet};
use crate::stage::preset;
use embedded_graphics::text::Alignment;
use glam::DVec2;
use std::sync::Arc;
use worsted::error::Error;
use worsted::frame::Picture;
use worsted::precompute::occlusion_fit::{distance_occlusion, fit_occlusion};
use worsted::precompute::occlusion_table::{
    OCCLUSION_ACROSS, bake_occlusion_table, occlusion_place, texture_occlusion,
};
use worsted::precompute::optical_depth::CrossSection;
use worsted::vulkan::Device;
use worsted::yarn::density::extinction_per_mm;
use worsted::yarn::params::YarnParams;

const YARNS: [&str; 2] = ["worsted_3ply", "cotton1"];
const SIZE: u32 = 256;
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
const CAPTIONS: [&str; 4] =
    ["(a) fiber density", "(b) occlusion texture", "(c) by distance", "(d) 4 x ((c) - (b))"];

/// Draws `docs/figures/fig8.png`, a row for each yarn.
///
/// # Errors
/// Those of the file system.
pub fn draw(_device: &Arc<Device>) -> Result<(), Error> {
    let (column, row) = (SIZE + GAP, SIZE + CAPTION);
    let mut sheet =
        Sheet::new(CAPTIONS.len() as u32 * column - GAP, YARNS.len() as u32 * row + CAPTION, PAPER);
    for (y, name) in (0..).map(|i| i * row).zip(YARNS) {
        let (pictures, difference) = pictures(&preset(name)?);
        for (x, picture) in (0..).zip(&pictures) {
            sheet.place(picture, x * column, y);
        }
        sheet.write(name, 4, y + SIZE + CAPTION / 2, INK, Alignment::Left);
        sheet.write(&difference, 3 * column + 4, y + SIZE + CAPTION / 2, INK, Alignment::Left);
    }
    for (x, caption) in (0..).zip(CAPTIONS) {
        let middle = YARNS.len() as u32 * row + CAPTION / 2;
        sheet.write(caption, x * column + 4, middle, INK, Alignment::Left);
    }
    sheet.save("fig8")
}

/// The four panels, and what to say of the difference inside the outer circle.
fn pictures(yarn: &YarnParams) -> ([Picture; 4], String) {
    let extinction = extinction_per_mm(yarn);
    let table = bake_occlusion_table(yarn, extinction, OCCLUSION_ACROSS);
    let cross_section = CrossSection::new(yarn);
    let cubic = fit_occlusion(&cross_section, extinction).visibility;
    let by_place = |place: DVec2| texture_occlusion(&table, occlusion_place(place, table.across));
    let by_distance = |place: DVec2| distance_occlusion(cubic, place.length());
    let differs = |place: DVec2| by_distance(place) - by_place(place);
    let pictures = [
        section(SIZE, |place| [density(&cross_section, place) / WHITE_DENSITY; 3]),
        section(SIZE, |place| [by_place(place); 3]),
        section(SIZE, |place| [by_distance(place); 3]),
        section(SIZE, |place| signed(4.0 * differs(place))),
    ];
    let place = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(SIZE) - 1.0;
    let places = (0..SIZE * SIZE).map(|i| DVec2::new(place(i % SIZE), place(i / SIZE)));
    let inside: Vec<f64> = places.filter(|place| place.length() <= 1.0).map(differs).collect();
    let rms = (inside.iter().map(|d| d * d).sum::<f64>() / inside.len() as f64).sqrt();
    let worst = inside.iter().fold(0.0, |worst: f64, d| worst.max(d.abs()));
    (pictures, format!("rms {rms:.2}, worst {worst:.2}"))
}
