//! Wu & Yuksel 2019, Fig. 12: what the shadow map, self-shadows and ambient occlusion add, and each alone.

use crate::looks::fiber;
use crate::sheet::{CAPTION, Sheet};
use crate::stage::{camera, preset, shoot, swatch};
use embedded_graphics::text::Alignment;
use std::sync::Arc;
use worsted::error::Error;
use worsted::frame::Picture;
use worsted::math::color::srgb_from_linear;
use worsted::scene::Scene;
use worsted::scene::file::{CameraTable, DebugTable, DebugView, DisplayTable, OcclusionMode, OcclusionTable};
use worsted::scene::file::{SceneFile, ShadingModel, ShadingTable};
use worsted::scene::shadow::ShadowTable;
use worsted::vulkan::Device;

const YARN: &str = "worsted_3ply";
const SIZE: [u32; 2] = [260, 220];
const SAMPLES: u32 = 16;
const GAP: u32 = 6;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [205, 205, 200];
/// Behind shares of light, which are gray.
const BEHIND: [f64; 3] = [0.02, 0.06, 0.13];
/// So that neither the picture without shadows is too bright nor the one with all of them too dark.
const EXPOSURE_STOPS: f64 = 0.6;
/// Loops of a row that the picture shows.
const LOOPS_SEEN: f64 = 5.0;

/// What dims light in a picture.
#[derive(Clone, Copy)]
struct Dimmed {
    between_yarns: bool,
    inside: bool,
    ambient: bool,
}

const NOTHING: Dimmed = Dimmed { between_yarns: false, inside: false, ambient: false };
const BETWEEN: Dimmed = Dimmed { between_yarns: true, ..NOTHING };
const INSIDE: Dimmed = Dimmed { inside: true, ..NOTHING };
const BOTH: Dimmed = Dimmed { inside: true, ..BETWEEN };
const ALL: Dimmed = Dimmed { ambient: true, ..BOTH };

const SHADED: [(Dimmed, &str); 4] = [
    (NOTHING, "(a) no shadow"),
    (BETWEEN, "(b) + shadow map"),
    (BOTH, "(c) + self-shadows"),
    (ALL, "(d) + ambient occlusion"),
];
const COMPONENTS: [&str; 4] =
    ["(e) full shadow", "(f) shadow map", "(g) self-shadows", "(h) ambient occlusion"];

/// Draws `docs/figures/fig12.png`.
///
/// # Errors
/// Those of the device and of the file system.
pub fn draw(device: &Arc<Device>) -> Result<(), Error> {
    let [column, row] = [SIZE[0] + GAP, SIZE[1] + CAPTION];
    let mut sheet = Sheet::new(SHADED.len() as u32 * column - GAP, 2 * row, PAPER);
    let mut place = |picture: &Picture, [x, y]: [u32; 2], caption: &str| {
        sheet.place(picture, x * column, y * row);
        sheet.write(caption, x * column + 4, y * row + SIZE[1] + CAPTION / 2, INK, Alignment::Left);
    };
    for (x, (dimmed, caption)) in (0..).zip(SHADED) {
        place(&shoot(device, scene(dimmed)?, SIZE, SAMPLES)?, [x, 0], caption);
    }
    for (x, (picture, caption)) in (0..).zip(components(device)?.iter().zip(COMPONENTS)) {
        place(picture, [x, 1], caption);
    }
    sheet.save("fig12")
}

/// Shares of light that come through: of light from everywhere and from the lamp together, as they arrive in
/// this scene; of the lamp's, by each kind of shadow; of light from everywhere.
fn components(device: &Arc<Device>) -> Result<[Picture; 4], Error> {
    let lamp = |dimmed| shoot(device, lamp_alone(dimmed)?, SIZE, SAMPLES);
    let undimmed = lamp(NOTHING)?;
    let [both, between, inside] = [lamp(BOTH)?, lamp(BETWEEN)?, lamp(INSIDE)?];
    let occlusion = shoot(device, ambient_occlusion()?, SIZE, SAMPLES)?;
    let lamp_share = |picture: &Picture, i: usize| {
        let all = f64::from(undimmed.linear[i][1]);
        if all > 0.0 { f64::from(picture.linear[i][1]) / all } else { 1.0 }
    };
    let cover = |i: usize| f64::from(occlusion.linear[i][3]);
    let ambient_share = |i: usize| f64::from(occlusion.linear[i][1]) / cover(i).max(1e-6);
    let file = SceneFile::default();
    let lamp_strength: f64 = file.light().iter().map(|light| light.strength().y).sum();
    let ambient_strength = std::f64::consts::PI * file.ambient.radiance().y;
    let weight = lamp_strength / (lamp_strength + ambient_strength);
    let full = |i| weight * lamp_share(&both, i) + (1.0 - weight) * ambient_share(i);
    Ok([
        gray(full, cover),
        gray(|i| lamp_share(&between, i), cover),
        gray(|i| lamp_share(&inside, i), cover),
        gray(ambient_share, cover),
    ])
}

/// A picture of shares in [0, 1].
fn gray(share: impl Fn(usize) -> f64, cover: impl Fn(usize) -> f64) -> Picture {
    let pixel = |i: usize| {
        let [r, g, b] = BEHIND.map(|behind| {
            let linear = cover(i) * share(i) + (1.0 - cover(i)) * behind;
            (255.0 * srgb_from_linear(linear.clamp(0.0, 1.0))).round() as u8
        });
        [r, g, b, 255]
    };
    let display = (0..SIZE[0] as usize * SIZE[1] as usize).map(pixel).collect();
    Picture { size: SIZE, linear: Vec::new(), display, layers: None }
}

fn scene(dimmed: Dimmed) -> Result<Scene, Error> {
    knit(file(dimmed)?)
}

/// The lamp's light alone, on fibers that send nearly as much of it to the eye wherever they point and face: over
/// such a picture without shadows, one with them is the share of light that they let through.
fn lamp_alone(dimmed: Dimmed) -> Result<Scene, Error> {
    let mut file = file(dimmed)?;
    file.shading = ShadingTable { diffuse: false, ambient: false, ..file.shading };
    file.fiber.insert("specular".into(), vec![1.0; 3].into());
    file.fiber.insert("specular_width_deg".into(), 90.0.into());
    knit(file)
}

fn ambient_occlusion() -> Result<Scene, Error> {
    let debug = DebugTable { view: DebugView::Occlusion, ..Default::default() };
    knit(SceneFile { debug, ..file(ALL)? })
}

fn file(dimmed: Dimmed) -> Result<SceneFile, Error> {
    let occlusion = if dimmed.ambient { OcclusionMode::default() } else { OcclusionMode::None };
    let yarn_radius_mm = preset(YARN)?.outer_radius_mm();
    let [wale_mm, _] = swatch(yarn_radius_mm, WALES, COURSES).spacing_mm();
    let mut file = SceneFile {
        fiber: fiber(YARN),
        shading: ShadingTable { model: ShadingModel::Simple, ..Default::default() },
        shadow: ShadowTable { map: dimmed.between_yarns, inside: dimmed.inside, ..Default::default() },
        occlusion: OcclusionTable { mode: occlusion, ..Default::default() },
        camera: CameraTable {
            yaw_deg: 14.0,
            pitch_deg: Some(12.0),
            ..camera(SIZE, LOOPS_SEEN * wale_mm, [0.0, 0.0, yarn_radius_mm])
        },
        display: DisplayTable {
            background: [0.02, 0.021, 0.024],
            exposure_stops: EXPOSURE_STOPS,
            ..Default::default()
        },
        ..Default::default()
    };
    file.yarn.insert("preset".into(), YARN.into());
    Ok(file)
}

/// A little more than the picture shows.
const WALES: u32 = 10;
const COURSES: u32 = 14;

fn knit(file: SceneFile) -> Result<Scene, Error> {
    Ok(Scene::stockinette(file, &swatch(preset(YARN)?.outer_radius_mm(), WALES, COURSES))?)
}
