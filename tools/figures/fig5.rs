//! Wu & Yuksel 2019, Fig. 5: the channels of a core fiber's texture.

use crate::sheet::{CAPTION, Sheet};
use crate::stage::preset;
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::frame::Picture;
use worsted::precompute::core_texture::{CoreTexture, Moments, bake_core};
use worsted::vulkan::Device;
use worsted::yarn::detail::CORE_LEVELS;
use worsted::yarn::table::fiber_table;

const YARN: &str = "cotton1";
/// Texels across: twice the default, to be looked at.
const ROWS: u32 = 128;
/// What the core hides in this figure; more than the default, so that it stands for many fibers.
const VISIBLE_SHARE: f64 = 0.4;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];

/// A channel: its caption, and the colour of what is seen, in [0, 1].
type Channel = (&'static str, fn(&Moments) -> [f64; 3]);

const CHANNELS: [Channel; 3] = [
    ("height: black where nothing is", |m| [0.5 + 0.5 * m.shape[1]; 3]),
    ("normal: up and down red and blue, facing the viewer green", |m| {
        [0.5 + 0.5 * m.normals[0], m.normals[1], 0.5 - 0.5 * m.normals[0]]
    }),
    ("direction: upward red, toward the viewer green", |m| {
        [0.5 + 0.5 * m.shape[2], 0.5 + 0.5 * m.shape[3], 0.5]
    }),
];

/// Draws `docs/figures/fig5.png`: left the core at full detail, right the whole ply, for which it stands alone.
///
/// # Errors
/// Those of the file system.
pub fn draw(_device: &Arc<Device>) -> Result<(), Error> {
    let yarn = preset(YARN)?;
    let texture = bake_core(&yarn, &fiber_table(&yarn, 0), ROWS, VISIBLE_SHARE);
    let columns = texture.mips[0].columns;
    let (width, row) = (columns + 8, ROWS + CAPTION);
    let mut sheet = Sheet::new(2 * width, row * CHANNELS.len() as u32, PAPER);
    for (y, (caption, color)) in (0..).zip(CHANNELS) {
        for (x, level) in [(0, 0), (1, CORE_LEVELS - 1)] {
            sheet.place(&picture(&texture, level, color), x * width + 4, y * row);
        }
        sheet.write(caption, 6, y * row + ROWS + CAPTION / 2, INK, Alignment::Left);
    }
    sheet.save("fig5")
}

/// One level of the first ply.
fn picture(texture: &CoreTexture, level: u32, color: fn(&Moments) -> [f64; 3]) -> Picture {
    let mip = &texture.mips[0];
    let size = (mip.columns * mip.rows) as usize;
    let texels = &mip.texels[level as usize * size..][..size];
    let shown = |texel: &Moments| {
        let coverage = texel.shape[0];
        let mean = *texel * (1.0 / coverage.max(1e-6));
        let [r, g, b] = color(&mean).map(|c| (255.0 * (coverage * c).clamp(0.0, 1.0)).round() as u8);
        [r, g, b, 255]
    };
    // Row 0 of the texture is at the bottom.
    let display = texels.chunks_exact(mip.columns as usize).rev().flatten().map(shown).collect();
    Picture { size: [mip.columns, mip.rows], linear: Vec::new(), display, layers: None }
}
