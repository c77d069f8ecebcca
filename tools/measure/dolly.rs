//! A dolly from 5 cm to 5 m: nothing pops from one frame to the next, and the mean colour holds.

use crate::pictures::Shot;
use crate::report::{Verdicts, overrides_line, print_columns, print_head};
use crate::stage::{Cloth, EVERY_FIBER, FrameOptions, Model, Stage, pixel_tangent, request, shoot};
use worsted::error::Error;
use worsted::frame::Renderer;
use worsted::scene::file::CameraTable;

/// Most FLIP of two successive frames, as a multiple of the median of its neighbours.
const MOST_JUMP: f64 = 2.0;
/// Neighbours of a pair of frames, on either side.
const NEIGHBORS: usize = 5;
/// Most relative change of the mean colour against every fiber.
const MOST_COLOR_CHANGE: f64 = 0.03;

const NEAREST_MM: f64 = 50.0;
const FARTHEST_MM: f64 = 5000.0;
/// Narrow, so that level of detail goes all the way: at the nearest distance a fiber of 34 micrometres is 1.04
/// pixels wide, at the farthest the whole yarn is half a pixel.
const FOV_Y_DEG: f64 = 9.0;
const SIZE: [u32; 2] = [320, 240];
const YARN: &str = "worsted_3ply";
/// About 62 x 63 mm: more than the nearest picture shows, 19 x 19 pixels of the farthest.
const CLOTH: Cloth = Cloth::Stockinette { wales: 9, courses: 13 };
/// Distances at which the mean colour is compared with that of every fiber.
const COLOR_DISTANCES: usize = 8;
/// Samples a pixel of those pictures. The farthest swatch is 260 pixels, and samples of thin fibers deviate by
/// two thirds of their mean: by sampling alone both sides err by 1% at 16 samples, by 0.5% at 64.
const COLOR_SAMPLES: u32 = 64;

/// `measure dolly`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Frames from the nearest to the farthest distance.
    #[arg(long, default_value_t = 120, value_parser = clap::value_parser!(u32).range(3..=2000))]
    frames: u32,
    #[command(flatten)]
    common: FrameOptions,
}

/// Draws the dolly, prints both tables and whether the limits hold.
///
/// # Errors
/// Those of the scene and the device; a limit that does not hold.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let [width, height] = SIZE;
    let lines = [
        format!(
            "stockinette of {YARN}, {} frames of {width} x {height} at {} samples a pixel, from {NEAREST_MM} to \
             {FARTHEST_MM} mm in equal ratios, field of view {FOV_Y_DEG} degrees",
            options.frames, options.common.samples
        ),
        "FLIP of a frame and the one before, as displayed, over the pixels that yarn covers in either"
            .to_owned(),
        overrides_line(&options.common.set),
    ];
    print_head("Dolly", stage.device(), &lines);
    let model = stage.model(YARN, CLOTH)?;
    let mut verdicts = Verdicts::default();
    let flips = print_frames(stage, &model, options)?;
    judge_jumps(&flips, options.frames, &mut verdicts);
    compare_colors(stage, &model, options, &mut verdicts)?;
    verdicts.finish()
}

/// Distance of a frame in mm.
fn distance_mm(frame: u32, frames: u32) -> f64 {
    NEAREST_MM * (FARTHEST_MM / NEAREST_MM).powf(f64::from(frame) / f64::from(frames - 1))
}

fn camera(model: &Model, distance_mm: f64) -> CameraTable {
    CameraTable {
        fov_y_deg: FOV_Y_DEG,
        yaw_deg: 20.0,
        pitch_deg: Some(15.0),
        distance_mm: Some(distance_mm),
        target_mm: Some([0.0, 0.0, model.front_mm]),
        ..Default::default()
    }
}

/// Draws the frames and gives the FLIP of every frame and the one before it.
fn print_frames(stage: &Stage, model: &Model, options: &Options) -> Result<Vec<f64>, Error> {
    print_columns(&["frame", "distance mm", "fiber px", "mean radiance", "FLIP to the frame before"]);
    let mut flips = Vec::new();
    let mut before: Option<Shot> = None;
    let common = &options.common;
    let request = request(SIZE, common.samples, false)?;
    let mut renderer = stage.renderer(&model.path, &common.set, request)?;
    for frame in 0..options.frames {
        let distance_mm = distance_mm(frame, options.frames);
        renderer.set_camera(camera(model, distance_mm));
        let shot = shoot(&mut renderer)?;
        shot.save(common.output.as_deref(), &format!("{frame:04}"))?;
        let fiber_px = 2.0 * model.yarn.fiber_radius_mm() / (distance_mm * pixel_tangent(FOV_Y_DEG, SIZE[1]));
        let mut cell = String::new();
        if let Some(before) = &before {
            let flip = shot.displayed_flip(before)?;
            cell = format!("{flip:.4}");
            flips.push(flip);
        }
        let mean = rgb(shot.mean_radiance()?);
        println!("| {frame} | {distance_mm:.1} | {fiber_px:.3} | {mean} | {cell} |");
        before = Some(shot);
    }
    Ok(flips)
}

/// FLIP `i` is that of frames `i` and `i + 1`.
fn judge_jumps(flips: &[f64], frames: u32, verdicts: &mut Verdicts) {
    println!();
    print_columns(&["frame", "distance mm", "FLIP", "/ median of its neighbours"]);
    let mut largest = (0.0, NEAREST_MM);
    for (i, flip) in flips.iter().enumerate() {
        let distance_mm = distance_mm(i as u32 + 1, frames);
        let jump = jump(flips, i);
        println!("| {} | {distance_mm:.1} | {flip:.4} | {jump:.3} |", i + 1);
        // What is not a number must not pass as small.
        if jump > largest.0 || jump.is_nan() {
            largest = (jump, distance_mm);
        }
    }
    let (jump, distance_mm) = largest;
    let holds = verdicts.at_most(&format!("jump at {distance_mm:.1} mm"), jump, MOST_JUMP);
    println!("\nLargest jump {jump:.3} at {distance_mm:.1} mm; at most {MOST_JUMP}: {holds}.\n");
}

/// FLIP `i` as a multiple of the median of those around it, fewer at the ends.
fn jump(flips: &[f64], i: usize) -> f64 {
    let around = i.saturating_sub(NEIGHBORS)..(i + NEIGHBORS + 1).min(flips.len());
    let mut others: Vec<f64> = around.filter(|&j| j != i).map(|j| flips[j]).collect();
    others.sort_by(f64::total_cmp);
    let Some(last) = others.len().checked_sub(1) else { return f64::NAN };
    let median = 0.5 * (others[last / 2] + others[others.len() / 2]);
    // Frames that are all alike do not jump.
    if flips[i] == 0.0 { 0.0 } else { flips[i] / median }
}

fn compare_colors(
    stage: &Stage,
    model: &Model,
    options: &Options,
    verdicts: &mut Verdicts,
) -> Result<(), Error> {
    println!(
        "Mean radiance of the yarn (red, green, blue), both sides at {COLOR_SAMPLES} samples a pixel:\n"
    );
    print_columns(&["distance mm", "default", "every fiber", "largest relative change"]);
    let request = request(SIZE, COLOR_SAMPLES, false)?;
    let mut defaults = stage.renderer(&model.path, &options.common.set, request)?;
    let mut everies = stage.renderer(&model.path, &[EVERY_FIBER.to_owned()], request)?;
    let mut largest = (0.0, NEAREST_MM);
    for i in 0..COLOR_DISTANCES {
        let distance_mm = distance_mm(i as u32, COLOR_DISTANCES as u32);
        let mean = |renderer: &mut Renderer| -> Result<[f64; 3], Error> {
            renderer.set_camera(camera(model, distance_mm));
            shoot(renderer)?.mean_radiance()
        };
        let (default, every) = (mean(&mut defaults)?, mean(&mut everies)?);
        let change = largest_change(default, every);
        println!("| {distance_mm:.1} | {} | {} | {change:.4} |", rgb(default), rgb(every));
        if change > largest.0 || change.is_nan() {
            largest = (change, distance_mm);
        }
    }
    let (change, distance_mm) = largest;
    let holds =
        verdicts.at_most(&format!("change of mean colour at {distance_mm:.1} mm"), change, MOST_COLOR_CHANGE);
    println!("\nLargest change {change:.4} at {distance_mm:.1} mm; at most {MOST_COLOR_CHANGE}: {holds}.");
    Ok(())
}

/// Largest relative difference of the channels; NaN where one of `reference` is 0.
fn largest_change(test: [f64; 3], reference: [f64; 3]) -> f64 {
    let changes = (0..3)
        .map(|c| if reference[c] > 0.0 { (test[c] - reference[c]).abs() / reference[c] } else { f64::NAN });
    changes.fold(
        0.0,
        |most: f64, change| if change.is_nan() || most.is_nan() { f64::NAN } else { most.max(change) },
    )
}

fn rgb([r, g, b]: [f64; 3]) -> String {
    format!("{r:.4}, {g:.4}, {b:.4}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_is_told_from_a_slope() {
        let mut flips: Vec<f64> = (0..30).map(|i| 0.02 + 0.001 * f64::from(i)).collect();
        assert!((0..30).all(|i| jump(&flips, i) < 1.2));
        flips[12] *= 3.0;
        assert!(jump(&flips, 12) > MOST_JUMP && jump(&flips, 13) < 1.2);
        flips[12] = f64::NAN;
        assert!(jump(&flips, 12).is_nan());
        assert_eq!(jump(&[0.0, 0.0, 0.0], 1), 0.0);
        assert_eq!(jump(&[0.0, 0.1, 0.0], 1), f64::INFINITY);
        assert!(jump(&[0.1], 0).is_nan(), "nothing to compare with");
    }

    #[test]
    fn the_largest_channel_counts_and_black_is_no_reference() {
        assert!((largest_change([1.0, 2.1, 3.0], [1.0, 2.0, 3.0]) - 0.05).abs() < 1e-12);
        assert!(largest_change([1.0; 3], [1.0, 0.0, 1.0]).is_nan());
    }

    #[test]
    fn the_dolly_ends_where_it_should() {
        assert!((distance_mm(0, 120) - NEAREST_MM).abs() < 1e-9);
        assert!((distance_mm(119, 120) - FARTHEST_MM).abs() < 1e-6);
    }
}
