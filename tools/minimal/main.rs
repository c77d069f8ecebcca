//! What it costs that a minimal scene is drawn by a renderer that can do more: one yarn, one light, simple shading and no
//! shadow, by `Renderer` and by a pipeline that can do nothing else, in turns. Exit code 1 where the renderer takes over
//! 1.1 times the time, or draws something else.

mod bare;
#[path = "../../src/shaders/glsl.rs"]
mod glsl;
mod hand_cut;

use bare::MINIMAL;
use hand_cut::HandCut;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use worsted::bench::clock::timed;
use worsted::error::Error;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::error::FileError;
use worsted::math::spread::Spread;
use worsted::scene::Scene;
use worsted::vulkan::{Device, DeviceChoice, DeviceOptions};

/// Most that the renderer may take, as a share of the other.
const LIMIT: f64 = 1.1;
/// Most by which mean radiance may differ, as a share of it.
const SAME: f64 = 1e-3;
/// Pictures of either kind.
const FRAMES: u32 = 15;
const SIZE: [u32; 2] = [640, 480];
/// A wavy yarn across the picture.
const KNOTS: i32 = 120;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("minimal: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run() -> Result<(), Error> {
    let options = DeviceOptions { choice: DeviceChoice::Auto, ..Default::default() };
    let device = Device::new(&options)?;
    let compared = compare(&device);
    Device::shutdown(device)?;
    compared
}

/// Draws by turns, says what came out, and holds it to the limits.
fn compare(device: &Arc<Device>) -> Result<(), Error> {
    let scene = scene()?;
    let sampling = Sampling::new(1).map_err(Error::Failed)?;
    let request = Request { size: SIZE, sampling, statistics: false, profile: false };
    let mut ours = Renderer::new(device, scene.clone(), request)?;
    let mut hand_cut = HandCut::new(device, &scene, &request)?;
    let (mut by_us, mut by_hand, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let mut radiance = (0.0, 0.0);
    for frame in 0..=FRAMES {
        // Neither is always the first.
        let mut other = (frame % 2 == 1).then(|| timed(|| hand_cut.render())).transpose()?;
        let (picture, us) = timed(|| ours.render(&|_| ()))?;
        let (pixels, hand) = match other.take() {
            Some(done) => done,
            None => timed(|| hand_cut.render())?,
        };
        radiance = (mean(&picture.linear), mean(&pixels));
        // The first of either warms up.
        if frame > 0 {
            by_us.push(1e3 * us.cpu);
            by_hand.push(1e3 * hand.cpu);
            ratios.push(us.cpu / hand.cpu);
        }
    }
    let spread = |values: &[f64]| Spread::of(values).unwrap_or_default();
    let (us, hand, ratio) = (spread(&by_us), spread(&by_hand), spread(&ratios));
    println!("{} ({}), {FRAMES} pictures of {SIZE:?} pixels in turns", device.name(), device.driver());
    println!("| | processor time ms, median | least | most |\n|---|---|---|---|");
    println!("| renderer | {:.1} | {:.1} | {:.1} |", us.median, us.min, us.max);
    println!("| hand-cut | {:.1} | {:.1} | {:.1} |", hand.median, hand.min, hand.max);
    println!("| ratio of each pair | {:.3} | {:.3} | {:.3} |", ratio.median, ratio.min, ratio.max);
    println!("mean radiance: {:.6} and {:.6}", radiance.0, radiance.1);
    // Written so that what is no number fails.
    let same = (radiance.0 - radiance.1).abs() <= SAME * radiance.0;
    if !same {
        return Err(Error::Failed("the two pictures are not the same".into()));
    }
    let holds = ratio.median <= LIMIT;
    println!("limit {LIMIT}: {}", if holds { "holds" } else { "does not hold" });
    if holds { Ok(()) } else { Err(Error::Failed(format!("{:.3} times the time", ratio.median))) }
}

fn mean(pixels: &[[f32; 4]]) -> f64 {
    pixels.iter().flat_map(|p| &p[..3]).map(|&c| f64::from(c)).sum::<f64>() / pixels.len() as f64
}

/// The yarn as a file, so that it is read as any other.
fn scene() -> Result<Scene, Error> {
    let folder = tempfile::tempdir().map_err(|e| FileError::io(&std::env::temp_dir(), "write", &e))?;
    let path = folder.path().join("yarn.obj");
    write_yarn(&path).map_err(|e| FileError::io(&path, "write", &e))?;
    let sets: Vec<String> =
        MINIMAL.iter().chain(&["fabric.mm_per_unit=1.0"]).map(|set| (*set).to_owned()).collect();
    Ok(Scene::load(&path, &sets)?)
}

fn write_yarn(path: &Path) -> std::io::Result<()> {
    let mut text = String::new();
    for knot in 0..KNOTS {
        let u = f64::from(knot);
        text.push_str(&format!("v {} {} {}\n", 0.5 * u, 12.0 * (0.35 * u).sin(), 3.0 * (0.2 * u).cos()));
    }
    let indices: Vec<String> = (1..=KNOTS).map(|knot| knot.to_string()).collect();
    text.push_str(&format!("l {}\n", indices.join(" ")));
    std::fs::write(path, text)
}
