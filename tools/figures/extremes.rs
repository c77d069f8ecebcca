//! Ten pictures at the ends of what can be drawn (`worsted stress` counts what is wrong with them; this is for the
//! eye).

use crate::sheet::{CAPTION, Sheet};
use crate::stage::shoot;
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::stress::extremes::EXTREMES;
use worsted::vulkan::Device;

const SIZE: [u32; 2] = [384, 288];
const COLUMNS: u32 = 4;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];

/// Draws `docs/figures/extremes.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let row = SIZE[1] + CAPTION;
    let rows = (EXTREMES.len() as u32).div_ceil(COLUMNS);
    let mut sheet = Sheet::new(SIZE[0] * COLUMNS, row * rows, PAPER);
    for (index, extreme) in EXTREMES.iter().enumerate() {
        let [x, y] = [index as u32 % COLUMNS * SIZE[0], index as u32 / COLUMNS * row];
        sheet.place(&shoot(device, extreme.scene()?, SIZE, 16)?, x, y);
        sheet.write(extreme.name, x + 6, y + SIZE[1] + CAPTION / 2, INK, Alignment::Left);
    }
    sheet.save("extremes")
}
