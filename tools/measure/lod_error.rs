//! Error of the default settings against every fiber, close up and at full view.

use crate::pictures::{Shot, save};
use crate::report::{Verdicts, overrides_line, print_columns, print_head};
use crate::stage::{Cloth, DEFAULT_SAMPLES, EVERY_FIBER, Model, Stage, joined, pixel_tangent, request};
use std::path::PathBuf;
use worsted::error::Error;
use worsted::frame::camera;
use worsted::scene::Scene;

/// Most FLIP against every fiber close up, both sides at [`HIGH_SAMPLES`].
const CLOSE_MOST_FLIP: f64 = 0.06;
/// The same at full view.
const FULL_MOST_FLIP: f64 = 0.05;
/// Most FLIP at the default number of samples, as a multiple of what every fiber has at that number.
const MOST_RATIO: f64 = 1.25;
/// Samples a pixel of the reference.
const HIGH_SAMPLES: u32 = 64;

const SIZE: [u32; 2] = [480, 360];
const YARNS: [&str; 2] = ["worsted_3ply", "cotton1"];
const FOV_Y_DEG: f64 = 35.0;
/// Width of a fiber at the target of a close-up, in pixels.
const CLOSE_FIBER_PX: f64 = 1.2;

/// `measure lod-error`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Set a scene key of the default side. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Rows whose name (`worsted_3ply stockinette close`) holds this.
    #[arg(long, value_name = "SUBSTRING")]
    only: Option<String>,
    /// A folder for the pictures.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq)]
enum View {
    Close,
    Full,
}

/// A line of the table.
struct Row {
    name: String,
    yarn: &'static str,
    cloth: Cloth,
    view: View,
}

/// Draws every row four ways, prints their errors and whether the limits hold.
///
/// # Errors
/// Those of scenes and the device; a limit that does not hold.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let wanted = |row: &Row| options.only.as_ref().is_none_or(|part| row.name.contains(part));
    let rows: Vec<Row> = rows().into_iter().filter(wanted).collect();
    if rows.is_empty() {
        let part = options.only.as_deref().unwrap_or_default();
        return Err(Error::Arguments(format!("--only {part}: no row of that name")));
    }
    let [width, height] = SIZE;
    let lines = [
        format!("pictures: {width} x {height}; errors over the pixels that yarn covers in either picture"),
        format!(
            "compared: the default settings at {HIGH_SAMPLES} samples and at {DEFAULT_SAMPLES} (the default), \
             and every fiber at {DEFAULT_SAMPLES}, each with every fiber at {HIGH_SAMPLES}"
        ),
        overrides_line(&options.set),
    ];
    print_head("Error of level of detail", stage.device(), &lines);
    print_columns(&columns());
    let mut verdicts = Verdicts::default();
    for row in &rows {
        measure(stage, row, options, &mut verdicts)?;
    }
    verdicts.finish()
}

fn columns() -> [String; 13] {
    let (high, low) = (HIGH_SAMPLES, DEFAULT_SAMPLES);
    [
        "picture".to_owned(),
        "yarn px".to_owned(),
        "fiber px".to_owned(),
        format!("FLIP at {high}"),
        format!("MSE at {high}"),
        "most FLIP".to_owned(),
        "holds".to_owned(),
        format!("FLIP at {low}"),
        format!("MSE at {low}"),
        format!("every fiber's FLIP at {low}"),
        format!("every fiber's MSE at {low}"),
        format!("FLIP / every fiber's (most {MOST_RATIO})"),
        "holds".to_owned(),
    ]
}

/// Two yarns on two fabrics, two views of each.
fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for yarn in YARNS {
        for view in [View::Close, View::Full] {
            // A close-up shows two loops; more than a few around them would only be culled.
            let (wales, courses, word) = if view == View::Close { (6, 6, "close") } else { (12, 12, "full") };
            let swatch = Cloth::Stockinette { wales, courses };
            for cloth in [swatch, Cloth::Tube { wales: 16, courses }] {
                rows.push(Row { name: format!("{yarn} {} {word}", cloth.name()), yarn, cloth, view });
            }
        }
    }
    rows
}

fn measure(stage: &Stage, row: &Row, options: &Options, verdicts: &mut Verdicts) -> Result<(), Error> {
    let model = stage.model(row.yarn, row.cloth)?;
    let view = camera_sets(row.view, &model);
    let default = joined(&view, &options.set);
    let every = joined(&view, &[EVERY_FIBER.to_owned()]);
    let draw = |sets: &[String], samples: u32, what: &str| -> Result<Shot, Error> {
        let shot = stage.draw(&model.path, sets, request(SIZE, samples, false)?)?;
        shot.save(options.output.as_deref(), &file_name(&row.name, &format!("{what}-{samples}")))?;
        Ok(shot)
    };
    // Overrides first: one that cannot be must not wait for the long picture of every fiber.
    let low = draw(&default, DEFAULT_SAMPLES, "default")?;
    let high = draw(&default, HIGH_SAMPLES, "default")?;
    let floor = draw(&every, DEFAULT_SAMPLES, "every")?;
    let truth = draw(&every, HIGH_SAMPLES, "every")?;
    let high = high.against(&truth)?;
    save(&high.flip.heatmap(), options.output.as_deref(), &file_name(&row.name, "flip"))?;
    let (low, floor) = (low.against(&truth)?.error.covered, floor.against(&truth)?.error.covered);
    let high = high.error.covered;

    let most = if row.view == View::Close { CLOSE_MOST_FLIP } else { FULL_MOST_FLIP };
    let ratio = low.flip_mean / floor.flip_mean;
    let high_holds = verdicts.at_most(&format!("{}: FLIP at {HIGH_SAMPLES}", row.name), high.flip_mean, most);
    let ratio_holds = verdicts.at_most(&format!("{}: ratio", row.name), ratio, MOST_RATIO);
    let [yarn_px, fiber_px] = widths_px(&model, &view)?;
    println!(
        "| {} | {yarn_px:.1} | {fiber_px:.2} | {:.4} | {:.2e} | {most} | {high_holds} | {:.4} | {:.2e} | {:.4} \
         | {:.2e} | {ratio:.2} | {ratio_holds} |",
        row.name, high.flip_mean, high.mse, low.flip_mean, low.mse, floor.flip_mean, floor.mse
    );
    Ok(())
}

/// The camera as overrides.
fn camera_sets(view: View, model: &Model) -> Vec<String> {
    let mut sets = vec![
        format!("camera.fov_y_deg={FOV_Y_DEG:?}"),
        "camera.yaw_deg=20".to_owned(),
        "camera.pitch_deg=15".to_owned(),
    ];
    match view {
        View::Full => sets.push("camera.fit=true".to_owned()),
        View::Close => {
            let fiber_mm = 2.0 * model.yarn.fiber_radius_mm();
            let distance_mm = fiber_mm / CLOSE_FIBER_PX / pixel_tangent(FOV_Y_DEG, SIZE[1]);
            sets.push(format!("camera.distance_mm={distance_mm:?}"));
            sets.push(format!("camera.target_mm=[0.0, 0.0, {:?}]", model.front_mm));
        }
    }
    sets
}

/// Widths of the yarn and of a fiber at the camera's target, in pixels.
fn widths_px(model: &Model, view: &[String]) -> Result<[f64; 2], Error> {
    let camera = camera(&Scene::load(&model.path, view)?, SIZE);
    let mm_per_px = camera.eye_world.distance(camera.target_world) * camera.pixel_tangent(SIZE);
    let radii_mm = [model.yarn.outer_radius_mm(), model.yarn.fiber_radius_mm()];
    Ok(radii_mm.map(|radius_mm| 2.0 * radius_mm / mm_per_px))
}

fn file_name(row: &str, what: &str) -> String {
    format!("{}-{what}", row.replace(' ', "-"))
}
