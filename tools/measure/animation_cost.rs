//! What it costs that a scene moves: processor time of pictures of frames against pictures of the model at rest, in turn.

use crate::animation_memory::scene_of;
use crate::report::{Verdicts, print_columns, print_head};
use crate::stage::{Stage, request};
use std::path::PathBuf;
use worsted::bench::clock::cpu_seconds;
use worsted::error::Error;
use worsted::frame::Renderer;
use worsted::math::spread::Spread;
use worsted::motion::mover::Movers;

/// Most processor time of a picture of a frame, as a multiple of one of the model at rest.
const MOST_RATIO: f64 = 1.1;

/// `measure animation-cost`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// The model at rest.
    model: PathBuf,
    /// Frames of its motion: raw (`frames.f32`) or numbered files. Without it the model moves as its own file says.
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    /// Pictures of either kind.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=1000))]
    frames: u64,
    /// Width and height in pixels.
    #[arg(long, num_args = 2, default_values_t = [640, 480])]
    size: Vec<u32>,
    /// Samples per pixel.
    #[arg(long, default_value_t = 4)]
    samples: u32,
    /// Set a scene key. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Draws, prints the ratio and whether it is within its limit.
///
/// # Errors
/// Those of the scene and the device; a limit that does not hold.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let size = [options.size[0], options.size[1]];
    let mut scene = scene_of(&options.model, options.motion.as_ref(), &options.set)?;
    let points = scene.fabrics.iter().map(|fabric| fabric.strands.control_point_count).sum::<usize>();
    let lines = [
        format!("{points} control points; {} x {} pixels, {} samples", size[0], size[1], options.samples),
        "processor time of all threads, of pictures of a frame and of the same frame at rest, in turn"
            .to_owned(),
    ];
    print_head("Cost of animation", stage.device(), &lines);
    let mut movers = Movers::open(&scene)?;
    let count = movers.frame_count().ok_or_else(|| Error::Arguments("expected a model that moves".into()))?;
    movers.fix_camera(&mut scene, size)?;
    let mut renderer = Renderer::new(stage.device(), scene, request(size, options.samples, false)?)?;
    let (mut still, mut moving, mut posing, mut bytes) = (Vec::new(), Vec::new(), Vec::new(), 0);
    let mut movers = Some(movers);
    renderer.render(&|_| ())?;
    for index in 0..options.frames {
        let frame = (index * (count - 1) / options.frames.max(2)) as f64;
        // One frame at a time, so that nothing is worked out while the still one is drawn.
        let started = cpu_seconds();
        let mut poser = renderer.poser(movers.take().unwrap_or_default(), std::iter::once(frame));
        let posed = poser.next_frame()?;
        let mut posed = posed.ok_or_else(|| Error::Failed(format!("expected frame {frame}, found none")))?;
        bytes = renderer.pose(&mut posed)?;
        let posed_by = cpu_seconds();
        renderer.render(&|_| ())?;
        let moved_by = cpu_seconds();
        renderer.render(&|_| ())?;
        still.push(cpu_seconds() - moved_by);
        moving.push(moved_by - started);
        posing.push(posed_by - started);
        movers = poser.finish();
    }
    let median = |times: &[f64]| Spread::of(times).map_or(f64::NAN, |spread| spread.median);
    let ratio = median(&moving) / median(&still);
    let mut verdicts = Verdicts::default();
    print_columns(&[
        "picture at rest",
        "of it the frame",
        "picture of a frame / at rest",
        "bytes a frame",
        "holds",
    ]);
    let holds = verdicts.at_most("picture of a frame / at rest", ratio, MOST_RATIO);
    let share = median(&posing) / median(&still);
    println!("| 1 | {share:.4} | {ratio:.4} | {bytes} | {holds} |");
    verdicts.finish()
}
