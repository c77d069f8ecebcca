//! A turn around a tube so close that pieces of yarn come and go: culling must not show.

use crate::report::{Verdicts, overrides_line, print_columns, print_head};
use crate::stage::{Cloth, FrameOptions, Stage, joined, request, shoot};
use worsted::error::Error;
use worsted::scene::file::CameraTable;

/// Most FLIP of a frame with culling against the same without.
const MOST_FLIP: f64 = 0.002;

const SIZE: [u32; 2] = [400, 300];
const YARN: &str = "worsted_3ply";
const CLOTH: Cloth = Cloth::Tube { wales: 12, courses: 9 };
/// Of the camera from the point it turns around, in radii of the tube: most of it lies outside the picture.
const DISTANCE_RADII: f64 = 1.5;
/// Of that point from the tube's axis, in radii, so that the camera comes near and goes far in one turn.
const OFFSET_RADII: f64 = 0.3;

/// `measure turntable`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Frames of one turn.
    #[arg(long, default_value_t = 24, value_parser = clap::value_parser!(u32).range(2..=2000))]
    frames: u32,
    #[command(flatten)]
    common: FrameOptions,
}

/// Draws the turn with culling and without, prints the table and whether the limit holds.
///
/// # Errors
/// Those of the scene and the device; a limit that does not hold; a turn in which nothing comes or goes.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let [width, height] = SIZE;
    let common = &options.common;
    let lines = [
        format!(
            "tube of {YARN}, {} frames of {width} x {height}, both sides at {} samples a pixel",
            options.frames, common.samples
        ),
        "FLIP of the frame with culling against the frame without, as displayed, over covered pixels"
            .to_owned(),
        overrides_line(&common.set),
    ];
    print_head("Culling on a turntable", stage.device(), &lines);
    print_columns(&["frame", "yaw deg", "pieces drawn", "pieces culled", "FLIP", "holds"]);
    let model = stage.model(YARN, CLOTH)?;
    let mut verdicts = Verdicts::default();
    let mut culled = Vec::new();
    let renderer = |culling: bool| {
        let sets = joined(&common.set, &[format!("quality.culling={culling}")]);
        stage.renderer(&model.path, &sets, request(SIZE, common.samples, true)?)
    };
    let (mut culling, mut whole) = (renderer(true)?, renderer(false)?);
    for frame in 0..options.frames {
        let yaw_deg = 360.0 * f64::from(frame) / f64::from(options.frames);
        let camera = CameraTable {
            yaw_deg,
            pitch_deg: Some(12.0),
            distance_mm: Some(DISTANCE_RADII * model.reach_mm),
            target_mm: Some([OFFSET_RADII * model.reach_mm, 0.0, 0.0]),
            ..Default::default()
        };
        culling.set_camera(camera.clone());
        whole.set_camera(camera);
        let (with, without) = (shoot(&mut culling)?, shoot(&mut whole)?);
        with.save(common.output.as_deref(), &format!("{frame:04}"))?;
        let flip = with.displayed_flip(&without)?;
        let holds = verdicts.at_most(&format!("FLIP of frame {frame}"), flip, MOST_FLIP);
        let [drawn, gone] =
            [with.stats.patches_drawn, with.stats.patches_culled].map(Option::unwrap_or_default);
        println!("| {frame} | {yaw_deg:.1} | {drawn} | {gone} | {flip:.5} | {holds} |");
        culled.push(gone);
    }
    // A turn in which the same pieces are culled throughout would prove nothing.
    culled.sort_unstable();
    culled.dedup();
    verdicts.at_least("different numbers of culled pieces", culled.len() as f64, 2.0);
    verdicts.finish()
}
