//! CPU and wall time of one picture with level of detail and without, in one process.

use crate::report::{Verdicts, overrides_line, print_columns, print_head};
use crate::stage::{DEFAULT_SAMPLES, EVERY_FIBER, Stage, joined, request};
use rustix::time::{ClockId, clock_gettime};
use std::path::PathBuf;
use std::time::Instant;
use worsted::error::Error;
use worsted::frame::{Renderer, Request};
use worsted::scene::Scene;

/// Least CPU time without level of detail, as a multiple of that with it: set for the trellis pattern in full
/// view at 1280 x 960 on a software device.
const LEAST_GAIN: f64 = 8.0;

/// What is drawn, in this order. The first comes again at the end, so that what changes as a process warms up
/// shows as a difference between the two.
const WAYS: [(&str, &str); 4] = [
    ("level of detail", "quality.level_of_detail=true"),
    ("no level of detail", "quality.level_of_detail=false"),
    ("every fiber", EVERY_FIBER),
    ("level of detail again", "quality.level_of_detail=true"),
];

/// `measure lod-cost`.
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

/// Seconds of two clocks.
#[derive(Clone, Copy)]
struct Seconds {
    cpu: f64,
    wall: f64,
}

/// One way's times.
struct Cost {
    load: Seconds,
    build: Seconds,
    render: Seconds,
}

/// Draws the model every way, prints the times and whether the gain is enough.
///
/// # Errors
/// Those of the scene and the device; too little gain.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let request = request(options.size, options.samples, false)?;
    let [width, height] = options.size;
    let name = options.model.file_name().unwrap_or_default().to_string_lossy();
    let lines = [
        format!("model: {name}, full view; {width} x {height}, {} samples a pixel", options.samples),
        "CPU: user and system time of this process, all threads; each picture is drawn once".to_owned(),
        overrides_line(&options.set),
    ];
    print_head("Cost of level of detail", stage.device(), &lines);
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
    for (way, set) in WAYS {
        let cost = measure(stage, options, set, request)?;
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
    verdict(&costs)
}

/// Judges by the slower of the two pictures with level of detail.
fn verdict(costs: &[Cost]) -> Result<(), Error> {
    let [first, without, _, last] = costs else {
        return Err(Error::Failed(format!("expected 4 pictures, found {}", costs.len())));
    };
    let gain = without.render.cpu / first.render.cpu.max(last.render.cpu);
    let mut verdicts = Verdicts::default();
    let holds = verdicts.at_least("gain in CPU time", gain, LEAST_GAIN);
    println!("\nWithout level of detail {gain:.2} times the CPU time; at least {LEAST_GAIN}: {holds}.");
    verdicts.finish()
}

fn measure(stage: &Stage, options: &Options, set: &str, request: Request) -> Result<Cost, Error> {
    let full = ["camera.fit=true".to_owned(), set.to_owned()];
    let sets = joined(&options.set, &full);
    let (scene, load) = timed(|| Ok(Scene::load(&options.model, &sets)?))?;
    let (mut renderer, build) = timed(|| Ok(Renderer::new(stage.device(), scene, request)?))?;
    let (_, render) = timed(|| Ok(renderer.render(&|_| {})?))?;
    Ok(Cost { load, build, render })
}

/// Does `work` and says what it took.
fn timed<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<(T, Seconds), Error> {
    let (cpu, wall) = (cpu_seconds(), Instant::now());
    let done = work()?;
    Ok((done, Seconds { cpu: cpu_seconds() - cpu, wall: wall.elapsed().as_secs_f64() }))
}

/// User and system time of this process so far, all threads together.
fn cpu_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// `1280x960`.
fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.parse::<u32>().ok().filter(|n| (1..=16_384).contains(n));
    let parsed = text.split_once('x').and_then(|(w, h)| Some([side(w)?, side(h)?]));
    parsed.ok_or_else(|| "expected WxH with sides of 1 to 16384 pixels".to_owned())
}
