//! `worsted reference`.

use super::args::{Common, Reference};
use super::job::{in_range, load_scene, parse_size, realise_settings, report_notes};
use super::output::{Output, PictureFormat, write_text};
use super::progress::{set_share, share_bar};
use crate::cli::say::tell;
use crate::error::Error;
use crate::io::picture::write_png;
use crate::io::whole::check_target;
use crate::reference::accel::Accel;
use crate::reference::checkpoint;
use crate::reference::display::displayed;
use crate::reference::fibers::{RealiseSettings, realise};
use crate::reference::geometry::FiberGeometry;
use crate::reference::integrator::{TraceSettings, Tracer};
use crate::reference::rendering::Rendering;
use crate::scene::Scene;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How often what was done so far is kept.
const KEPT_EVERY: Duration = Duration::from_secs(10);
/// Tiles between two looks at the clock.
const TILES_AT_ONCE: u64 = 128;

/// A picture to be traced.
pub struct ReferenceJob {
    scene: Scene,
    size: [u32; 2],
    samples: u64,
    realise: RealiseSettings,
    trace: TraceSettings,
    outputs: Vec<Output>,
    stats: Option<PathBuf>,
    fresh: bool,
    stop_after_passes: Option<u64>,
    common: Common,
}

impl ReferenceJob {
    /// Resolves arguments and loads the scene.
    ///
    /// # Errors
    /// Arguments that make no sense, a scene that cannot be had.
    pub fn new(args: &Reference, common: &Common) -> Result<Self, Error> {
        let outputs = args.output.iter().map(|path| Output::new(path)).collect::<Result<Vec<_>, _>>()?;
        if let Some(stats) = args.stats.as_deref().filter(|path| *path != Path::new("-")) {
            check_target(stats)?;
        }
        let realise = realise_settings(args.chord_error)?;
        in_range("--own-fiber-diameters", args.own_fiber_diameters, 0.0, 1e3)?;
        let size = parse_size(&args.view.size)?;
        Ok(Self {
            scene: load_scene(&args.scene, &args.time, Some((&args.view, size)))?,
            size,
            samples: args.spp,
            realise,
            trace: TraceSettings {
                bounces: args.bounces,
                own_fiber_diameters: args.own_fiber_diameters,
                shadows: !args.unshadowed,
            },
            outputs,
            stats: args.stats.clone(),
            fresh: args.fresh,
            stop_after_passes: args.stop_after_passes,
            common: common.clone(),
        })
    }
}

/// What is known of the run; the keys are stable.
#[derive(Debug, Serialize)]
struct Stats {
    size: [u32; 2],
    samples: u64,
    bounces: u32,
    fibers: usize,
    fiber_segments: usize,
    fiber_bytes: usize,
    bvh_bytes: usize,
    /// Most memory that the process held; absent where nobody says.
    peak_bytes: Option<u64>,
    build_seconds: f64,
    /// Of this run: what was done before a stop is not in it.
    trace_seconds: f64,
    rays: u64,
    /// Mean over pixels and colours of the variance of a pixel's mean; absent at one sample.
    variance_mean: Option<f64>,
    not_finite_samples: u64,
}

/// Traces, writes, reports.
///
/// # Errors
/// Too many fibers, an unfinished picture of something else, files that cannot be written, samples that are no
/// numbers.
pub fn run(job: &ReferenceJob) -> Result<(), Error> {
    report_notes(&job.scene, &job.common);
    let started = Instant::now();
    let part = checkpoint::path_beside(&job.outputs[0].path);
    let key = checkpoint::key(&job.scene, job.size, job.realise.chord_error, &job.trace);
    let mut rendering = resume(job, &part, key)?;
    let fibers = realise(&job.scene, &job.realise).map_err(|e| Error::Arguments(e.to_string()))?;
    let geometry = FiberGeometry::<f32>::new(fibers, job.scene.origin_mm);
    let accel = Accel::new(geometry).map_err(|e| Error::Arguments(e.to_string()))?;
    let tracer = Tracer::new(&job.scene, accel, job.size, job.trace);
    let build_seconds = started.elapsed().as_secs_f64();

    let traced = Instant::now();
    let done = trace(job, &tracer, &mut rendering, (&part, key))?;
    let trace_seconds = traced.elapsed().as_secs_f64();
    write_pictures(job, &rendering)?;
    if done {
        remove(&part)?;
    } else {
        checkpoint::save(&part, key, &rendering)?;
        say(job, &format!("stopped after {} passes; the same command goes on", rendering.passes()));
    }
    if let Some(path) = &job.stats {
        let stats = stats(job, &tracer, &rendering, [build_seconds, trace_seconds]);
        let text =
            serde_json::to_string_pretty(&stats).map_err(|e| Error::Failed(format!("statistics: {e}")))?;
        write_text(path, &text)?;
    }
    match rendering.tally.not_finite {
        0 => Ok(()),
        n => Err(Error::Failed(format!("{n} samples are not finite numbers: please report this scene"))),
    }
}

fn say(job: &ReferenceJob, line: &str) {
    if !job.common.quiet {
        tell!("{line}");
    }
}

/// What was done so far, or nothing yet.
fn resume(job: &ReferenceJob, part: &Path, key: u64) -> Result<Rendering, Error> {
    let kept = if job.fresh { None } else { checkpoint::load(part, key, job.size)? };
    Ok(match kept {
        Some(rendering) => {
            let percent = 100.0 * rendering.share(job.samples);
            say(job, &format!("{}: going on at {percent:.0}%", part.display()));
            rendering
        }
        None => Rendering::new(job.size),
    })
}

/// Traces until done or told to stop; whether it is done.
fn trace(
    job: &ReferenceJob,
    tracer: &Tracer<f32>,
    rendering: &mut Rendering,
    (part, key): (&Path, u64),
) -> Result<bool, Error> {
    let bar = share_bar(&job.common);
    set_share(&bar, rendering.share(job.samples));
    bar.reset_eta();
    let mut kept = Instant::now();
    while !rendering.is_done(job.samples) && job.stop_after_passes.is_none_or(|n| rendering.passes() < n) {
        rendering.advance(tracer, job.samples, TILES_AT_ONCE);
        set_share(&bar, rendering.share(job.samples));
        if kept.elapsed() > KEPT_EVERY {
            checkpoint::save(part, key, rendering)?;
            kept = Instant::now();
        }
    }
    bar.finish_and_clear();
    Ok(rendering.is_done(job.samples))
}

fn write_pictures(job: &ReferenceJob, rendering: &Rendering) -> Result<(), Error> {
    let picture = rendering.measured();
    for output in &job.outputs {
        match output.format {
            PictureFormat::Exr => picture.write(&output.path)?,
            PictureFormat::Png => {
                write_png(&output.path, &displayed(&picture.mean, &job.scene.file.display))?;
            }
        }
    }
    Ok(())
}

/// Removes what was kept of a picture that is done.
fn remove(part: &Path) -> Result<(), Error> {
    match std::fs::remove_file(part) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(crate::io::error::FileError::io(part, "remove", &error).into())
        }
        _ => Ok(()),
    }
}

fn stats(
    job: &ReferenceJob,
    tracer: &Tracer<f32>,
    rendering: &Rendering,
    [build_seconds, trace_seconds]: [f64; 2],
) -> Stats {
    let accel = tracer.accel();
    let geometry = accel.geometry();
    Stats {
        size: job.size,
        samples: rendering.samples(),
        bounces: job.trace.bounces,
        fibers: geometry.run_count(),
        fiber_segments: geometry.piece_count(),
        fiber_bytes: geometry.bytes(),
        bvh_bytes: accel.bytes(),
        peak_bytes: peak_bytes(),
        build_seconds,
        trace_seconds,
        rays: rendering.tally.rays,
        variance_mean: rendering.mean_variance(),
        not_finite_samples: rendering.tally.not_finite,
    }
}

/// Most memory that this process held, where the system keeps a `proc` folder.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}
