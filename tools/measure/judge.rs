//! Pictures against the traced reference of every fiber: how far they are from it, and which approximation is to
//! blame.

use crate::pictures::{Shot, save};
use crate::report::{overrides_line, print_columns, print_head};
use crate::stage::{Cloth, EVERY_FIBER, Model, Stage, joined, pixel_tangent, request};
use std::path::PathBuf;
use worsted::bench::against;
use worsted::bench::truth::{first_and_seconds, tracer};
use worsted::error::Error;
use worsted::io::picture::LinearImage;
use worsted::reference::display::displayed;
use worsted::reference::integrator::TraceSettings;
use worsted::reference::rendering::Rendering;
use worsted::scene::Scene;

const YARNS: [&str; 2] = ["worsted_3ply", "rayon1"];
const CLOTH: Cloth = Cloth::Stockinette { wales: 8, courses: 10 };
const FOV_Y_DEG: f64 = 35.0;
/// Widths of a fiber at the camera's target, in pixels: nearly every fiber is drawn, some are, cores alone.
const DISTANCES: [(&str, f64); 3] = [("close", 1.2), ("middle", 0.4), ("far", 0.12)];

/// Parts of the light, by what is left out of the scene.
const PARTS: [(&str, &[&str]); 3] = [
    ("all light", &[]),
    ("the lamp alone", &["ambient.radiance=[0.0, 0.0, 0.0]"]),
    ("ambient light alone", &["light=[]"]),
];
/// What leaves out every shadow of the fast path.
const UNSHADOWED: [&str; 3] = ["shadow.map=false", "shadow.self=false", "occlusion.mode=none"];
/// What is changed about each approximation, one by one.
const SWITCHES: [(&str, &[&str]); 9] = [
    ("default", &[]),
    ("every fiber, no level of detail", &[EVERY_FIBER]),
    ("straight pieces within 0.02 pixel", &["quality.subdivision_tolerance_px=0.02"]),
    ("occlusion by texture", &["occlusion.mode=texture"]),
    ("no occlusion by other yarns", &["occlusion.yarns=false"]),
    ("no occlusion", &["occlusion.mode=none"]),
    ("shadow map of 4096", &["shadow.resolution=4096"]),
    ("no shadow map", &["shadow.map=false"]),
    ("no self-shadows", &["shadow.self=false"]),
];

/// `measure judge`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Samples per pixel of both sides.
    #[arg(long, default_value_t = 64)]
    samples: u32,
    /// Height of the pictures in pixels; they are 4 wide for 3 high.
    #[arg(long, default_value_t = 150, value_parser = clap::value_parser!(u32).range(30..=2160))]
    height: u32,
    /// Judge one straight yarn instead of fabric.
    #[arg(long)]
    straight: bool,
    /// Set a scene key of the judged side. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Rows whose name (`worsted_3ply close`) holds this.
    #[arg(long, value_name = "SUBSTRING")]
    only: Option<String>,
    /// A folder for the pictures.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Two independent pictures of the same thing: the second says how far the first is from it by noise alone.
struct Truth {
    first: LinearImage,
    second: LinearImage,
}

/// Prints both tables: the default pictures, and close up what each approximation does.
///
/// # Errors
/// Those of scenes and the device; a name that no row has.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let [width, height] = size(options);
    let lines = [
        format!(
            "{}, {width} x {height} pixels; errors over the pixels that yarn covers in either picture",
            cloth(options).name()
        ),
        format!(
            "reference: every fiber traced with shadows by fibers and no bounces; {} samples a pixel on both sides",
            options.samples
        ),
        "floor: another traced picture with as many samples against the reference".to_owned(),
        overrides_line(&options.set),
    ];
    print_head("Against the traced reference", stage.device(), &lines);
    let rows: Vec<(&str, &str, f64)> = YARNS
        .iter()
        .flat_map(|yarn| DISTANCES.iter().map(move |(word, fiber_px)| (*yarn, *word, *fiber_px)))
        .filter(|(yarn, word, _)| {
            options.only.as_ref().is_none_or(|part| format!("{yarn} {word}").contains(part))
        })
        .collect();
    if rows.is_empty() {
        let part = options.only.as_deref().unwrap_or_default();
        return Err(Error::Arguments(format!("--only {part}: no row of that name")));
    }
    print_columns(&[
        "picture",
        "light",
        "FLIP",
        "MSE",
        "floor FLIP",
        "floor MSE",
        "mean / reference's (red, green, blue)",
    ]);
    let mut blamed = Vec::new();
    for (yarn, word, fiber_px) in rows {
        let model = stage.model(yarn, cloth(options))?;
        let view = view(&model, fiber_px, options);
        let name = format!("{yarn} {word}");
        let [all, rest @ ..] = PARTS;
        let truth = print_row(stage, &model, (&view, all.1), &name, all.0, options)?;
        for (part, sets) in rest {
            print_row(stage, &model, (&view, sets), &name, part, options)?;
        }
        blamed.push((name, model, view, truth));
    }
    println!(
        "\nEach approximation changed or left out by itself, the last one against a reference without shadows:\n"
    );
    print_columns(&["picture", "changed", "FLIP", "MSE", "mean / reference's (red, green, blue)"]);
    for (name, model, view, truth) in &blamed {
        print_switches(stage, (name, model), view, truth, options)?;
    }
    Ok(())
}

fn cloth(options: &Options) -> Cloth {
    if options.straight { Cloth::Straight } else { CLOTH }
}

fn size(options: &Options) -> [u32; 2] {
    [options.height * 4 / 3, options.height]
}

fn owned(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|set| (*set).to_owned()).collect()
}

fn view(model: &Model, fiber_px: f64, options: &Options) -> Vec<String> {
    let fiber_mm = 2.0 * model.yarn.fiber_radius_mm();
    let distance_mm = fiber_mm / fiber_px / pixel_tangent(FOV_Y_DEG, options.height);
    vec![
        format!("camera.fov_y_deg={FOV_Y_DEG:?}"),
        "camera.yaw_deg=20".to_owned(),
        "camera.pitch_deg=15".to_owned(),
        format!("camera.distance_mm={distance_mm:?}"),
        format!("camera.target_mm=[0.0, 0.0, {:?}]", model.front_mm),
    ]
}

fn print_row(
    stage: &Stage,
    model: &Model,
    (view, part): (&[String], &[&str]),
    name: &str,
    light: &str,
    options: &Options,
) -> Result<Truth, Error> {
    let lit = joined(view, &owned(part));
    let scene = Scene::load(&model.path, &lit)?;
    let truth = traced(&scene, true, options)?;
    let shot = stage.draw(
        &model.path,
        &joined(&lit, &options.set),
        request(size(options), options.samples, false)?,
    )?;
    let file = format!("{name} {light}").replace(' ', "-");
    shot.save(options.output.as_deref(), &file)?;
    let shown = displayed(&truth.first, &scene.file.display);
    save(&shown, options.output.as_deref(), &format!("{file}-reference"))?;
    let (found, floor) = (against(&shot.linear, &truth.first)?, against(&truth.second, &truth.first)?);
    save(&found.flip.heatmap(), options.output.as_deref(), &format!("{file}-flip"))?;
    let (found, floor) = (found.error.covered, floor.error.covered);
    println!(
        "| {name} | {light} | {:.4} | {:.2e} | {:.4} | {:.2e} | {} |",
        found.flip_mean,
        found.mse,
        floor.flip_mean,
        floor.mse,
        ratios(&shot, &truth.first)
    );
    Ok(truth)
}

fn print_switches(
    stage: &Stage,
    (name, model): (&str, &Model),
    view: &[String],
    truth: &Truth,
    options: &Options,
) -> Result<(), Error> {
    let row = |sets: &[&str], word: &str, truth: &Truth| -> Result<(), Error> {
        let sets = joined(&joined(view, &options.set), &owned(sets));
        let shot = stage.draw(&model.path, &sets, request(size(options), options.samples, false)?)?;
        let found = against(&shot.linear, &truth.first)?.error.covered;
        let mean = ratios(&shot, &truth.first);
        println!("| {name} | {word} | {:.4} | {:.2e} | {mean} |", found.flip_mean, found.mse);
        Ok(())
    };
    for (word, sets) in SWITCHES {
        row(sets, word, truth)?;
    }
    let bare = traced(&Scene::load(&model.path, view)?, false, options)?;
    row(&UNSHADOWED, "nothing shadowed", &bare)?;
    row(&[&UNSHADOWED[..], &[EVERY_FIBER]].concat(), "nothing shadowed, every fiber", &bare)
}

/// Traces the scene twice, with samples of its own each time.
fn traced(scene: &Scene, shadows: bool, options: &Options) -> Result<Truth, Error> {
    let settings = TraceSettings { shadows, ..Default::default() };
    let (tracer, _) = tracer(scene, size(options), settings)?;
    let mut rendering = Rendering::new(size(options));
    let samples = u64::from(options.samples);
    let (first, seconds) = first_and_seconds(&tracer, &mut rendering, samples, &[samples], |_| Ok(()))?;
    let second = seconds.into_iter().next();
    let second = second.ok_or_else(|| Error::Failed("expected a second picture, found none".into()))?;
    Ok(Truth { first: first.mean, second })
}

/// Light of the whole picture over the reference's.
fn ratios(shot: &Shot, reference: &LinearImage) -> String {
    let sum = |image: &LinearImage, c: usize| image.pixels.iter().map(|p| f64::from(p[c])).sum::<f64>();
    let ratio = |c: usize| sum(&shot.linear, c) / sum(reference, c);
    format!("{:.3}, {:.3}, {:.3}", ratio(0), ratio(1), ratio(2))
}
