//! Wu & Yuksel 2019, Fig. 6: slices of the density, and the optical depth from a light at the left.

use crate::section::{WHITE_DENSITY, density, section};
use crate::sheet::{CAPTION, Sheet};
use crate::stage::preset;
use embedded_graphics::text::Alignment;
use glam::DVec2;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use worsted::error::Error;
use worsted::precompute::optical_depth::CrossSection;
use worsted::precompute::self_shadow::{SelfShadowSize, bake_self_shadow};
use worsted::precompute::self_shadow::{self_shadow_depth, self_shadow_light, self_shadow_place};
use worsted::vulkan::Device;
use worsted::yarn::density::extinction_per_mm;

const YARN: &str = "worsted_3ply";
const SLICES: u32 = 6;
const SIZE: u32 = 168;
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];

/// Draws `docs/figures/fig6.png`: below each density what the table of the default size reads there.
///
/// # Errors
/// Those of the file system.
pub fn draw(_device: &Arc<Device>) -> Result<(), Error> {
    let yarn = preset(YARN)?;
    let cross_section = CrossSection::new(&yarn);
    let table = bake_self_shadow(&yarn, SelfShadowSize::default());
    let (largest, extinction) = (table.largest(), extinction_per_mm(&yarn) * yarn.outer_radius_mm());
    let captions = [
        format!("optical depth from the left, white is {largest:.2} outer radii of density 1"),
        format!("share of light, exp(-{extinction:.1} depth)"),
    ];
    let row = SIZE + CAPTION;
    let mut sheet = Sheet::new(SLICES * (SIZE + GAP) - GAP, 3 * row, PAPER);
    for slice in 0..SLICES {
        let angle = TAU / f64::from(yarn.ply_count * SLICES) * f64::from(slice);
        let toward = DVec2::from_angle(angle);
        // The light stays at the left, and the yarn turns.
        let from_picture = DVec2::from_angle(angle - PI);
        let depth = |place: DVec2| {
            let position = from_picture.rotate(place);
            self_shadow_depth(&table, self_shadow_place(position, toward, yarn.ply_count, table.size))
        };
        let pictures = [
            section(SIZE, |place| [density(&cross_section, from_picture.rotate(place)) / WHITE_DENSITY; 3]),
            section(SIZE, |place| [depth(place) / largest; 3]),
            section(SIZE, |place| [self_shadow_light(depth(place), extinction, 1.0); 3]),
        ];
        let x = slice * (SIZE + GAP);
        for (y, picture) in (0..).zip(&pictures) {
            sheet.place(picture, x, y * row);
        }
        let caption = format!("light at {:.0} deg", angle.to_degrees());
        sheet.write(&caption, x + 4, SIZE + CAPTION / 2, INK, Alignment::Left);
    }
    for (y, caption) in (1..).zip(&captions) {
        sheet.write(caption, 4, y * row + SIZE + CAPTION / 2, INK, Alignment::Left);
    }
    sheet.save("fig6")
}
