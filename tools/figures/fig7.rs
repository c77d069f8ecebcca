//! Wu & Yuksel 2019, Fig. 7: a straight yarn with both kinds of ambient occlusion.

use crate::looks::fiber;
use crate::section::signed;
use crate::sheet::{CAPTION, Sheet};
use crate::stage::{camera, preset, scene_of, shoot, strand};
use embedded_graphics::text::Alignment;
use glam::DVec3;
use std::sync::Arc;
use worsted::error::Error;
use worsted::frame::Picture;
use worsted::scene::Scene;
use worsted::scene::file::{DebugTable, DebugView, DisplayTable, OcclusionMode, OcclusionTable, SceneFile};
use worsted::vulkan::Device;

const YARN: &str = "worsted_3ply";
const SIZE: [u32; 2] = [460, 170];
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
/// Of the picture, in outer diameters of the yarn.
const WIDTH_DIAMETERS: f64 = 3.4;
const ROWS: [(OcclusionMode, &str); 3] = [
    (OcclusionMode::None, "no occlusion"),
    (OcclusionMode::Distance, "by distance"),
    (OcclusionMode::Texture, "by texture"),
];

/// Draws `docs/figures/fig7.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let [column, row] = [SIZE[0] + GAP, SIZE[1] + CAPTION];
    let mut sheet = Sheet::new(2 * column - GAP, 4 * row, PAPER);
    let mut place = |picture: &Picture, [x, y]: [u32; 2], caption: &str| {
        sheet.place(picture, x * column, y * row);
        sheet.write(caption, x * column + 4, y * row + SIZE[1] + CAPTION / 2, INK, Alignment::Left);
    };
    let mut lit = Vec::new();
    let mut visibility = Vec::new();
    for (y, (mode, caption)) in (0..).zip(ROWS) {
        let picture = shoot(device, scene(DebugView::Shaded, mode)?, SIZE, 64)?;
        place(&picture, [0, y], &format!("ambient light alone, {caption}"));
        lit.push(picture);
        let picture = shoot(device, scene(DebugView::Occlusion, mode)?, SIZE, 64)?;
        place(&picture, [1, y], &format!("share of ambient light, {caption}"));
        visibility.push(picture);
    }
    for (x, pictures) in [(0, &lit), (1, &visibility)] {
        place(&difference(&pictures[1], &pictures[2]), [x, 3], "4 x (by distance - by texture)");
    }
    sheet.save("fig7")
}

/// Four times by how much the first picture is brighter than the second.
fn difference(first: &Picture, second: &Picture) -> Picture {
    let pixel = |(a, b): (&[f32; 4], &[f32; 4])| {
        let mean = |pixel: &[f32; 4]| f64::from(pixel[0] + pixel[1] + pixel[2]) / 3.0;
        let [r, g, b] = signed(4.0 * (mean(a) - mean(b))).map(|c| (255.0 * c.min(1.0)).round() as u8);
        [r, g, b, 255]
    };
    let display = first.linear.iter().zip(&second.linear).map(pixel).collect();
    Picture { size: first.size, linear: Vec::new(), display, layers: None }
}

/// A straight strand in ambient light alone.
fn scene(view: DebugView, mode: OcclusionMode) -> Result<Scene, Error> {
    let width_mm = 2.0 * preset(YARN)?.outer_radius_mm() * WIDTH_DIAMETERS;
    let mut file = SceneFile {
        fiber: fiber(YARN),
        light: Some(Vec::new()),
        occlusion: OcclusionTable { mode, ..Default::default() },
        camera: camera(SIZE, width_mm, [0.0; 3]),
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        debug: DebugTable { view, ..Default::default() },
        ..Default::default()
    };
    file.ambient.radiance = Some([1.0; 3]);
    file.yarn.insert("preset".into(), YARN.into());
    // The yarn goes on beyond the picture.
    scene_of(file, YARN, vec![strand(0.7 * width_mm, 0.2, |s| DVec3::X * s)])
}
