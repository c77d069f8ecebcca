//! CPU and wall time of pictures of one model, drawn several ways in one process.

use crate::report::{overrides_line, print_columns, print_head};
use crate::stage::{DEFAULT_SAMPLES, Stage, joined, request};
use std::path::PathBuf;
use worsted::bench::clock::{Seconds, timed};
use worsted::error::Error;
use worsted::frame::{Renderer, Request};
use worsted::scene::Scene;

/// What a command that compares costs is asked.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// A yarn file (`.bcc`, `.obj`) or a scene (`.toml`), drawn in full view.
    model: PathBuf,
    /// Width and height in pixels.
    #[arg(long, default_value = "1280x960", value_name = "WxH", value_parser = parse_size)]
    size: [u32; 2],
    /// Samples per pixel: 1, 4, 16, 36, 64 ...
    #[arg(long, default_value_t = DEFAULT_SAMPLES)]
    samples: u32,
    /// Set a scene key of every picture. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// A way to draw: what it is called, and its settings.
pub type Way<'a> = (&'a str, &'a [&'a str]);

/// One way's times.
pub struct Cost {
    load: Seconds,
    build: Seconds,
    pub render: Seconds,
}

/// Draws the model every way and prints the times.
///
/// # Errors
/// Those of the scene and the device.
pub fn compare(stage: &Stage, options: &Options, title: &str, ways: &[Way<'_>]) -> Result<Vec<Cost>, Error> {
    let request = request(options.size, options.samples, false)?;
    let [width, height] = options.size;
    let name = options.model.file_name().unwrap_or_default().to_string_lossy();
    let lines = [
        format!("model: {name}, full view; {width} x {height}, {} samples a pixel", options.samples),
        "CPU: user and system time of this process, all threads; each picture is drawn once".to_owned(),
        overrides_line(&options.set),
    ];
    print_head(title, stage.device(), &lines);
    print_columns(&[
        "drawn with",
        "render CPU s",
        "render wall s",
        "CPU / first",
        "wall / first",
        "load wall s",
        "build wall s",
        "build CPU s",
    ]);
    let mut costs: Vec<Cost> = Vec::new();
    for (way, sets) in ways {
        let cost = measure(stage, options, sets, request)?;
        let first = costs.first().unwrap_or(&cost).render;
        let Cost { load, build, render } = &cost;
        println!(
            "| {way} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} |",
            render.cpu,
            render.wall,
            render.cpu / first.cpu,
            render.wall / first.wall,
            load.wall,
            build.wall,
            build.cpu
        );
        costs.push(cost);
    }
    Ok(costs)
}

fn measure(stage: &Stage, options: &Options, sets: &[&str], request: Request) -> Result<Cost, Error> {
    let own: Vec<String> = ["camera.fit=true"].iter().chain(sets).map(|set| (*set).to_owned()).collect();
    let sets = joined(&options.set, &own);
    let (scene, load) = timed(|| Scene::load(&options.model, &sets))?;
    let (mut renderer, build) = timed(|| Renderer::new(stage.device(), scene, request))?;
    let (_, render) = timed(|| renderer.render(&|_| {}))?;
    Ok(Cost { load, build, render })
}

/// `1280x960`.
fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.parse::<u32>().ok().filter(|n| (1..=16_384).contains(n));
    let parsed = text.split_once('x').and_then(|(w, h)| Some([side(w)?, side(h)?]));
    parsed.ok_or_else(|| "expected WxH with sides of 1 to 16384 pixels".to_owned())
}
