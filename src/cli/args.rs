//! What can be typed.

use super::bench_args::{Bench, Budget};
use super::play_args::{LayersArgs, Play};
#[cfg(feature = "viewer")]
use super::view_args::View;
use crate::frame::sampling::Sampling;
use crate::knit::params::KnitParams;
use crate::probe;
use crate::reference::fibers::RealiseSettings;
use clap::builder::PossibleValuesParser;
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Fiber-level knitwear, in real time.
#[derive(Debug, Parser)]
#[command(version, about, after_help = EXIT_CODES)]
pub struct Args {
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 good; 1 a check failed; 2 bad input or arguments; 3 no usable device; \
                          4 device lost or out of memory.";

/// Options of every command.
#[derive(Clone, Debug, ClapArgs)]
pub struct Common {
    /// Device by name, by index, or `software` for a CPU device.
    #[arg(long, global = true, default_value = "auto", value_name = "NAME|INDEX|software")]
    pub device: String,
    /// Check every Vulkan call; an error ends the run. Debug builds do so where the layer is installed.
    #[arg(long, global = true)]
    pub validate: bool,
    /// Say only what went wrong.
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Say more; twice for everything.
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw a scene, or a bare yarn file, into a picture.
    Render(Render),
    /// Draw a scene, or a bare yarn file with a motion, into one picture after the other. Stopped at any moment, the
    /// same command goes on from there.
    Play(Play),
    /// Open a window on a scene, or a bare yarn file, and edit it.
    #[cfg(feature = "viewer")]
    View(Box<View>),
    /// Trace a scene, or a bare yarn file, over its real fibers: slow, and what `render` is judged by. Stopped at
    /// any moment, the same command goes on from there.
    Reference(Reference),
    /// Say how far a picture is from another.
    Compare(Compare),
    /// Write every fiber of a scene, for other renderers.
    Export(Export),
    /// Measure error against run time, and show it on one page.
    Bench(Bench),
    /// Generate fabric.
    Knit(Knit),
    /// Say what a yarn file holds.
    Info(Info),
    /// Say what this machine can do, what is missing, and the line that installs it.
    Doctor,
    /// Evaluate one function for every line of standard input: a JSON object in, one out.
    #[command(after_long_help = probe::described())]
    Probe(Probe),
    /// Sweep every parameter to the ends of its domain and past them, the device against f64: a table of worst
    /// errors, and exit code 1 where one is beyond what is allowed.
    Stress(Stress),
}

/// A scene and what is changed about it.
#[derive(Debug, ClapArgs)]
pub struct SceneArgs {
    /// A scene (`.toml`) or a yarn file (`.bcc`, `.obj`, `.gltf`, `.glb`).
    #[arg(value_name = "SCENE")]
    pub path: PathBuf,
    /// Set any scene key by its path; `null` removes it. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed of everything random.
    #[arg(long, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    pub seed: Option<u64>,
    /// Frames of the first fabric's motion: raw (`frames.f32`) or numbered files (`cloth.%04d.bcc`); as
    /// `fabric.motion`, but relative to the working folder.
    #[arg(long, value_name = "FILE")]
    pub motion: Option<PathBuf>,
}

/// At what time.
#[derive(Debug, ClapArgs)]
pub struct TimeArgs {
    /// Show this frame of the motion, counted from 0, fractions between two; as `animation.frame`. The model at rest
    /// when not given.
    #[arg(long, value_name = "N")]
    pub frame: Option<f64>,
}

/// From where, and how large.
#[derive(Debug, ClapArgs)]
pub struct ViewArgs {
    /// Width and height in pixels.
    #[arg(long, default_value = "1280x960", value_name = "WxH")]
    pub size: String,
    /// Camera as `key=value` pairs: yaw, pitch (degrees), distance (mm), target (mm), fov (degrees), or
    /// `fit`.
    #[arg(long, value_name = "yaw=30,pitch=20,distance=400,target=0:0:0|fit", allow_hyphen_values = true)]
    pub camera: Option<String>,
}

/// `worsted render`.
#[derive(Debug, ClapArgs)]
pub struct Render {
    /// What to show.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The picture: `.png` as displayed, `.exr` as linear radiance. May be given more than once.
    #[arg(short, long, required = true)]
    pub output: Vec<PathBuf>,
    /// When.
    #[command(flatten)]
    pub time: TimeArgs,
    /// How it is seen.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Samples per pixel: 1, 4, 16, 36, 64 ...
    #[arg(long, default_value = "4")]
    pub samples: Sampling,
    /// Beside the light.
    #[command(flatten)]
    pub layers: LayersArgs,
    /// Draw this many times and report the spread of times.
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub repeat: u32,
    /// Write statistics as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Time every pass in a submission of its own.
    #[arg(long)]
    pub profile: bool,
    /// Say what was built and what was left out, and why.
    #[arg(long)]
    pub explain: bool,
    /// Bake tables and build pipelines anew, and keep neither.
    #[arg(long, conflicts_with = "folder")]
    pub no_cache: bool,
    /// What it may cost.
    #[command(flatten)]
    pub budget: Budget,
}

/// `worsted reference`.
#[derive(Debug, ClapArgs)]
pub struct Reference {
    /// What to show.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The picture: `.exr` as linear radiance with the variance of each pixel's mean, `.png` as displayed. May be
    /// given more than once; beside the first, named `.part`, is kept what was done so far.
    #[arg(short, long, required = true)]
    pub output: Vec<PathBuf>,
    /// When.
    #[command(flatten)]
    pub time: TimeArgs,
    /// How it is seen.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Samples per pixel.
    #[arg(long, default_value_t = 64, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1 << 20))]
    pub spp: u64,
    /// Times that light goes on from fiber to fiber; 0 is what `render` draws. The diffuse lobe stands for them:
    /// follow them with `--set shading.diffuse=false`.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(..=10_000))]
    pub bounces: u32,
    /// Write statistics as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Most that straight pieces of a fiber depart from it, in radii of the fiber, 0.0001 to 10.
    #[arg(long, default_value_t = 0.1, value_name = "X")]
    pub chord_error: f64,
    /// Part of its own fiber that a ray ignores along it, both ways, in diameters of the fiber, 0 to 1000; what it
    /// goes through before it leaves the fiber is ignored besides.
    #[arg(long, default_value_t = 2.0, value_name = "X")]
    pub own_fiber_diameters: f64,
    /// Let no fiber take light from another.
    #[arg(long)]
    pub unshadowed: bool,
    /// Begin anew, whatever was done so far.
    #[arg(long)]
    pub fresh: bool,
    /// Stop after so many passes of 4 samples, with a picture of those; the same command without this goes on.
    #[arg(long, value_name = "N")]
    pub stop_after_passes: Option<u64>,
}

/// `worsted compare`.
#[derive(Debug, ClapArgs)]
pub struct Compare {
    /// The picture to be judged: `.exr` (linear radiance) or `.png` (as displayed).
    pub test: PathBuf,
    /// The picture that it should be: `.exr`, with the variance of its pixels or without, or `.png`.
    pub reference: PathBuf,
    /// Write FLIP of every pixel as a picture: black 0, through violet and orange, pale yellow 1 (magma).
    #[arg(long, value_name = "FILE.png")]
    pub heatmap: Option<PathBuf>,
    /// End with exit code 1 where mean FLIP over the covered pixels is above this, 0 to 1.
    #[arg(long, value_name = "FLIP")]
    pub fail_above: Option<f64>,
    /// Stops that an EXR is shown brighter by than it is, as a scene's `display.exposure_stops`; 0 unless given.
    #[arg(long, value_name = "STOPS", allow_hyphen_values = true)]
    pub exposure: Option<f64>,
    /// Tone curve that an EXR is shown by, as a scene's `display.tone`; neutral unless given.
    #[arg(long)]
    pub tone: Option<ShownTone>,
    /// Write the figures as JSON; `-` for standard output, in place of the table.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// Tone curves by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShownTone {
    /// As it is up to 0.8, bent above, hue kept: a scene's default.
    Neutral,
    /// More contrast, highlights that fade to white.
    Filmic,
    /// Cut at 1.
    Clamp,
}

/// `worsted export`.
#[derive(Debug, ClapArgs)]
pub struct Export {
    /// What to show.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// When.
    #[command(flatten)]
    pub time: TimeArgs,
    /// The fibers, in mm, Y up: `.usda` as USD BasisCurves with widths; `.bcc` as polylines, their radii, yarns and
    /// plies in a JSON file beside it.
    #[arg(short, long)]
    pub output: PathBuf,
    /// Most that a straight piece may depart from a fiber's axis, in radii of the fiber.
    #[arg(long, default_value_t = RealiseSettings::default().chord_error, value_name = "RADII")]
    pub chord_error: f64,
}

/// `worsted knit`.
#[derive(Debug, ClapArgs)]
pub struct Knit {
    /// The pattern.
    #[command(subcommand)]
    pub pattern: Pattern,
}

/// Patterns that can be generated.
#[derive(Debug, Subcommand)]
pub enum Pattern {
    /// Plain jersey, knit flat from one yarn.
    Stockinette(Stockinette),
    /// Plain jersey knit in the round, each course a closed yarn, its face outward.
    Tube(Tube),
}

/// `worsted knit stockinette`.
#[derive(Debug, ClapArgs)]
pub struct Stockinette {
    /// Rows of loops.
    #[arg(long, default_value_t = KnitParams::swatch().courses)]
    pub courses: u32,
    /// Loops in a row.
    #[arg(long, default_value_t = KnitParams::swatch().wales)]
    pub wales: u32,
    /// What every pattern takes.
    #[command(flatten)]
    pub knitting: Knitting,
}

/// `worsted knit tube`.
#[derive(Debug, ClapArgs)]
pub struct Tube {
    /// Rounds of loops.
    #[arg(long, default_value_t = KnitParams::tube().courses)]
    pub courses: u32,
    /// Loops around the tube, at least 10.
    #[arg(long, default_value_t = KnitParams::tube().wales)]
    pub wales: u32,
    /// What every pattern takes.
    #[command(flatten)]
    pub knitting: Knitting,
}

/// Options of every pattern.
#[derive(Debug, ClapArgs)]
pub struct Knitting {
    /// Outer radius of the yarn in mm; the default preset's when not given.
    #[arg(long, value_name = "MM")]
    pub yarn_radius: Option<f64>,
    /// Distance between loops of a row in mm; around a tube, at its inside.
    #[arg(long, value_name = "MM")]
    pub wale_spacing: Option<f64>,
    /// Distance between rows in mm.
    #[arg(long, value_name = "MM")]
    pub course_spacing: Option<f64>,
    /// Control points of one loop.
    #[arg(long, value_name = "N")]
    pub points_per_loop: Option<u32>,
    /// Make it move, for one cycle of two seconds: for a `.gltf`.
    #[arg(long, value_enum)]
    pub animate: Option<Animate>,
    /// The yarn file to write: `.bcc`, or `.gltf`, in which yarns are lines.
    #[arg(short, long)]
    pub output: PathBuf,
}

/// Motions of generated fabric.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Animate {
    /// Pulled up and down, by a morph target.
    Stretch,
    /// Waves, by two morph targets.
    Wave,
    /// Its upper half bends over, by a skin of two joints.
    Bend,
}

/// `worsted info`.
#[derive(Debug, ClapArgs)]
pub struct Info {
    /// A yarn file (`.bcc`, `.obj`, `.gltf`, `.glb`).
    pub yarn: PathBuf,
}

/// `worsted probe`.
#[derive(Debug, ClapArgs)]
pub struct Probe {
    /// The function; `--help` says what its queries hold.
    #[arg(value_parser = PossibleValuesParser::new(probe::FUNCTIONS.iter().map(|function| function.name)))]
    pub function: String,
    /// What evaluates it.
    #[arg(long, value_enum)]
    pub backend: Backend,
}

/// What evaluates a probed function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// The shader itself, on the device.
    Device,
    /// Its f64 twin, without tables.
    F64,
}

/// `worsted stress`.
#[derive(Debug, ClapArgs)]
pub struct Stress {
    /// Try less: under a minute, for every change.
    #[arg(long)]
    pub quick: bool,
    /// Write the table as Markdown; printed when not given.
    #[arg(long, value_name = "FILE")]
    pub table: Option<PathBuf>,
    /// Write all figures as JSON; `-` for standard output, in place of the table.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}
