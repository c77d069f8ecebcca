//! Whether playing holds no more memory the longer it goes on.

use crate::ALLOCATOR;
use crate::report::{Verdicts, print_columns, print_head};
use crate::stage::{Stage, joined, request};
use memory_stats::memory_stats;
use stats_alloc::Region;
use std::alloc::System;
use std::path::{Path, PathBuf};
use worsted::error::Error;
use worsted::frame::Renderer;
use worsted::io::error::FileError;
use worsted::motion::mover::Movers;
use worsted::scene::Scene;

/// Most that this program's heap may grow by from a tenth of the frames to all of them: frames under way differ.
const MOST_GROWTH_BYTES: f64 = 2e6;
/// The same of the process where nothing is drawn: the C library keeps some of what is freed.
const MOST_PROCESS_GROWTH_BYTES: f64 = 8e6;
/// Rows of the table.
const ROWS: u64 = 10;
/// Fewest pixels that can be drawn to some effect, and frames between two of them.
const SIZE: [u32; 2] = [32, 24];

/// `measure animation-memory`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// The model at rest.
    model: PathBuf,
    /// Frames of its motion: raw (`frames.f32`) or numbered files. They are played again and again.
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    /// Frames to play: read, worked out and handed to the device.
    #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(100..=1_000_000))]
    frames: u64,
    /// Frames from one picture to the next: the rest is not drawn.
    #[arg(long, default_value_t = 500)]
    draw_every: u64,
    /// Set a scene key. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// A moving scene.
///
/// # Errors
/// Those of the scene.
pub fn scene_of(model: &Path, motion: Option<&PathBuf>, sets: &[String]) -> Result<Scene, Error> {
    let whole = |path: &PathBuf| std::path::absolute(path).map_err(|e| FileError::io(path, "find", &e));
    let motion = motion.map(whole).transpose()?;
    let motion: Vec<String> = motion.iter().map(|path| format!("fabric.motion={}", path.display())).collect();
    Ok(Scene::load(model, &joined(&motion, sets))?)
}

/// Plays, prints the table and whether memory stays.
///
/// # Errors
/// Those of the scene and the device; memory that grows, or that nobody says anything of.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let sets = joined(&options.set, &["animation.repeat=true".to_owned()]);
    let mut scene = scene_of(&options.model, options.motion.as_ref(), &sets)?;
    let points = scene.fabrics.iter().map(|fabric| fabric.strands.control_point_count).sum::<usize>();
    let [width, height] = SIZE;
    let lines = [
        format!("{points} control points, {} frames", options.frames),
        format!("every {}th of them drawn, {width} x {height} pixels, 1 sample", options.draw_every),
    ];
    print_head("Memory while playing", stage.device(), &lines);
    print_columns(&["frames played", "pictures", "program's heap MB", "device MB", "process MB"]);
    let start = Region::new(ALLOCATOR);
    let mut movers = Movers::open(&scene)?;
    movers.fix_camera(&mut scene, SIZE)?;
    let mut renderer = Renderer::new(stage.device(), scene, request(SIZE, 1, false)?)?;
    let mut poser = renderer.poser(movers, (0..options.frames).map(|frame| frame as f64));
    let (mut played, mut pictures) = (0, 0);
    let mut memory: Vec<Memory> = Vec::new();
    while let Some(mut posed) = poser.next_frame()? {
        renderer.pose(&mut posed)?;
        poser.give_back(posed);
        if played % options.draw_every.max(1) == 0 {
            renderer.render(&|_| ())?;
            pictures += 1;
        }
        played += 1;
        if played % (options.frames / ROWS).max(1) == 0 {
            let now = Memory::now(stage, &start);
            let [heap, device, process] = [now.heap, now.device, now.process].map(|bytes| bytes / 1e6);
            println!("| {played} | {pictures} | {heap:.2} | {device:.2} | {process:.1} |");
            memory.push(now);
        }
    }
    let grown = |of: fn(&Memory) -> f64| {
        memory.first().zip(memory.last()).map_or(f64::NAN, |(first, last)| of(last) - of(first))
    };
    let mut verdicts = Verdicts::default();
    verdicts.at_least("frames played", played as f64, options.frames as f64);
    verdicts.at_most("bytes by which the program's heap grew", grown(|m| m.heap), MOST_GROWTH_BYTES);
    verdicts.at_most("bytes by which the device's memory grew", grown(|m| m.device), 0.0);
    if pictures <= 1 {
        // A driver may keep more for itself from one picture on than from those before.
        verdicts.at_most("bytes by which the process grew", grown(|m| m.process), MOST_PROCESS_GROWTH_BYTES);
    }
    verdicts.finish()
}

/// Bytes that are held; NaN where nobody says.
#[derive(Clone, Copy)]
struct Memory {
    /// By this program's own code.
    heap: f64,
    /// On the device, for this program.
    device: f64,
    /// By the process in all, what the driver needs of its own included.
    process: f64,
}

impl Memory {
    fn now(stage: &Stage, start: &Region<'_, System>) -> Self {
        let heap = start.change();
        let bytes = |count: usize| count as f64;
        Self {
            heap: bytes(heap.bytes_allocated) - bytes(heap.bytes_deallocated),
            device: stage.device().memory_bytes().values().map(|bytes| *bytes as f64).sum(),
            process: memory_stats().map_or(f64::NAN, |stats| bytes(stats.physical_mem)),
        }
    }
}
