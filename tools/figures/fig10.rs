//! Wu & Yuksel 2019, Fig. 10: loops and hairs as parts of fibers, above the generator of Zhao et al. 2016,
//! whose fly-aways are fibers of their own.

use crate::looks::fiber;
use crate::sheet::{CAPTION, Sheet};
use crate::stage::{camera, preset, scene_of, shoot, strand};
use embedded_graphics::text::Alignment;
use glam::DVec3;
use std::sync::Arc;
use toml::{Table, toml};
use worsted::error::Error;
use worsted::math::curve::Curve;
use worsted::scene::Scene;
use worsted::scene::file::{DebugTable, DisplayTable, FibersShown, OcclusionMode, OcclusionTable, SceneFile};
use worsted::scene::shadow::ShadowTable;
use worsted::vulkan::Device;
use worsted::yarn::zhao::{FiberCurve, zhao_fibers};

const YARNS: [&str; 3] = ["cotton1", "rayon1", "silk1"];
const SIZE: [u32; 2] = [900, 168];
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
/// Between points along the reference's fibers.
const STEP_MM: f64 = 0.1;
/// Of the picture, in outer diameters of the yarn.
const WIDTH_DIAMETERS: f64 = 9.0;

/// Draws `docs/figures/fig10.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let row = SIZE[1] + CAPTION;
    let mut sheet = Sheet::new(SIZE[0], row * 2 * YARNS.len() as u32, PAPER);
    for (i, name) in YARNS.into_iter().enumerate() {
        let width_mm = 2.0 * preset(name)?.outer_radius_mm() * WIDTH_DIAMETERS;
        let ours = ours(name, width_mm)?;
        let reference = reference(name, width_mm, &ours)?;
        for (j, (scene, what)) in [(ours, "ours"), (reference, "reference")].into_iter().enumerate() {
            let y = (2 * i + j) as u32 * row;
            sheet.place(&shoot(device, scene, SIZE, 16)?, 0, y);
            sheet.write(&format!("{name}: {what}"), 6, y + SIZE[1] + CAPTION / 2, INK, Alignment::Left);
            let px_per_mm = f64::from(SIZE[0]) / width_mm;
            sheet.scale_bar(1.0, px_per_mm, [SIZE[0] - 8, y + SIZE[1] + CAPTION / 2], INK);
        }
    }
    sheet.save("fig10")
}

fn file(name: &str, width_mm: f64) -> SceneFile {
    SceneFile {
        fiber: fiber(name),
        camera: camera(SIZE, width_mm, [0.0; 3]),
        display: DisplayTable { background: [0.02, 0.021, 0.024], ..Default::default() },
        // What is compared is fibers: no core may stand for any.
        debug: DebugTable { fibers: FibersShown::Every, ..Default::default() },
        // The reference's fibers know no yarn to be occluded by: so neither do ours.
        occlusion: OcclusionTable { mode: OcclusionMode::None, ..Default::default() },
        shadow: ShadowTable { map: false, inside: false, ..Default::default() },
        ..Default::default()
    }
}

/// The yarn, turned so that plies and fibers start as the generator's do: a scene gives each curve a random
/// turn of its own.
fn ours(name: &str, width_mm: f64) -> Result<Scene, Error> {
    let mut yarn = Table::new();
    yarn.insert("preset".into(), name.into());
    let line = strand(half_length_mm(width_mm), 0.2, |s| DVec3::X * s);
    let mut scene = scene_of(SceneFile { yarn, ..file(name, width_mm) }, name, vec![line])?;
    let strands = &mut scene.fabrics[0].strands;
    strands.curves.iter_mut().for_each(|curve| curve.phases = [0.0; 3]);
    let start = strands.pieces[0].turns;
    for piece in &mut strands.pieces {
        piece.turns.ply.start -= start.ply.start;
        piece.turns.fiber.start -= start.fiber.start;
        piece.turns.migration.start -= start.migration.start;
    }
    Ok(scene)
}

/// The same yarn's fibers as the generator makes them, each a strand of its own. The regular ones are the
/// very fibers of [`ours`]: same table, same start, same turn.
fn reference(name: &str, width_mm: f64, ours: &Scene) -> Result<Scene, Error> {
    let strands = &ours.fabrics[0].strands;
    let normal = strands.knot_normals(&strands.pieces[0])[0];
    let binormal = DVec3::X.cross(normal);
    let half_mm = half_length_mm(width_mm);
    let placed = |p: DVec3| DVec3::X * (p.z - half_mm) + normal * p.x + binormal * p.y;
    let fibers = zhao_fibers(&preset(name)?, 2.0 * half_mm, STEP_MM, ours.file.seed);
    let curve =
        |fiber: FiberCurve| Curve { points: fiber.points.into_iter().map(placed).collect(), closed: false };
    let yarn = single_fiber(preset(name)?.fiber_diameter_um);
    scene_of(SceneFile { yarn, ..file(name, width_mm) }, name, fibers.into_iter().map(curve).collect())
}

/// A yarn that is one fiber on the centre line.
fn single_fiber(fiber_diameter_um: f64) -> Table {
    let mut yarn = toml! {
        ply_count = 1
        fibers_per_ply = 1
        yarn_radius_mm = 0
        ply_pitch_mm = "untwisted"
        fiber_pitch_mm = "untwisted"
        ellipse_short_mm = 1e-6
        ellipse_long_mm = 1e-6
        loop_density_per_mm = 0
        hair_density_per_mm = 0
    };
    yarn.insert("fiber_diameter_um".into(), fiber_diameter_um.into());
    yarn
}

/// Half of the yarn's length: it goes on beyond the picture.
fn half_length_mm(width_mm: f64) -> f64 {
    0.7 * width_mm
}
