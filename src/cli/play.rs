//! `worsted play`.

use super::args::Common;
use super::encode::Film;
use super::job::{assignments, kept, parse_size, report_notes};
use super::open_device;
use super::output::{Output, PictureFormat, check_layers, write_text};
use super::play_args::Play;
use super::play_record::Record;
use super::progress::{set_share, share_bar};
use crate::bench::clock::host_peak_bytes;
use crate::cli::say::tell;
use crate::error::Error;
use crate::frame::moving::PosedFrame;
use crate::frame::stats::Stats;
use crate::frame::{Renderer, Request, check_tables};
use crate::io::error::FileError;
use crate::io::kept::Kept;
use crate::io::numbered::NumberedPath;
use crate::io::whole::check_target;
use crate::motion::mover::Movers;
use crate::scene::Scene;
use crate::scene::animation::AnimationTable;
use crate::vulkan::Device;
use serde::Serialize;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Most pictures of one run.
const MOST_PICTURES: u64 = 1_000_000;

/// Pictures to be drawn.
pub struct PlayJob {
    scene: Scene,
    movers: Movers,
    request: Request,
    outputs: Vec<(NumberedPath, PictureFormat)>,
    pictures: Range<u64>,
    stats: Option<PathBuf>,
    fresh: bool,
    film: Option<Film>,
    kept: Kept,
    common: Common,
}

impl PlayJob {
    /// Resolves arguments, loads the scene and opens its motions.
    ///
    /// # Errors
    /// Arguments that make no sense, a scene that cannot be had or does not move, no ffmpeg where one is needed.
    pub fn new(args: &Play, common: &Common) -> Result<Self, Error> {
        let outputs = args.output.iter().map(|path| output(path)).collect::<Result<Vec<_>, _>>()?;
        if let Some(stats) = args.stats.as_deref().filter(|path| *path != Path::new("-")) {
            check_target(stats)?;
        }
        let request = Request {
            size: parse_size(&args.view.size)?,
            sampling: args.samples,
            statistics: args.stats.is_some(),
            profile: false,
        };
        let mut sets: Vec<String> = args.layers.assignments().collect();
        sets.extend(assignments(&args.scene, None, args.view.camera.as_deref())?);
        let mut scene = Scene::load(&args.scene.path, &sets)?;
        check_layers(&scene.file.layers, outputs.iter().map(|(_, format)| *format))?;
        check_tables(&scene)?;
        let mut movers = Movers::open(&scene)?;
        let frames = movers.frame_count().ok_or_else(|| {
            let path = args.scene.path.display();
            Error::Arguments(format!("{path}: expected fabric.motion or --motion FILE, found neither"))
        })?;
        movers.fix_camera(&mut scene, request.size)?;
        let animation = scene.file.animation.clone();
        let pictures = pictures(args.frames.as_deref(), &animation, frames)?;
        let frames_per_second = animation.frames_per_second;
        let film = args.encode.as_ref().map(|path| Film { path: path.clone(), frames_per_second });
        if let Some(film) = &film {
            film.check()?;
            shown(&outputs)?;
        }
        Ok(Self {
            scene,
            movers,
            request,
            outputs,
            pictures,
            stats: args.stats.clone(),
            fresh: args.fresh,
            film,
            kept: kept(args.no_cache, &args.cache),
            common: common.clone(),
        })
    }

    /// The files of one picture.
    fn files(&self, picture: u64) -> impl Iterator<Item = Output> {
        self.outputs.iter().map(move |(path, format)| Output { path: path.file(picture), format: *format })
    }
}

/// A pattern of pictures; its folder is made.
fn output(path: &Path) -> Result<(NumberedPath, PictureFormat), Error> {
    let wrong = |why: String| Error::Arguments(format!("-o {}: {why}", path.display()));
    let pattern = NumberedPath::new(path).map_err(wrong)?;
    let folder = pattern.folder();
    if !folder.as_os_str().is_empty() {
        std::fs::create_dir_all(folder).map_err(|e| FileError::io(folder, "make", &e))?;
    }
    let format = Output::new(&pattern.file(0))?.format;
    Ok((pattern, format))
}

/// The pictures that a film is made of.
fn shown(outputs: &[(NumberedPath, PictureFormat)]) -> Result<&NumberedPath, Error> {
    let shown = outputs.iter().find(|(_, format)| *format == PictureFormat::Png);
    let none =
        || Error::Arguments("--encode: expected pictures in .png to make a film of, found none".into());
    shown.map(|(path, _)| path).ok_or_else(none)
}

/// `10..20`, `10..`, `..20`, `10..=19` or `10`, of a motion of so many frames.
fn pictures(text: Option<&str>, animation: &AnimationTable, frames: u64) -> Result<Range<u64>, Error> {
    let count = animation.picture_count(frames);
    let last = if animation.repeat { MOST_PICTURES } else { count };
    let text = text.unwrap_or("..");
    let number =
        |text: &str, otherwise: u64| if text.is_empty() { Some(otherwise) } else { text.parse().ok() };
    let parsed = match text.split_once("..") {
        None => number(text, 0).filter(|_| !text.is_empty()).map(|first: u64| first..first.saturating_add(1)),
        Some((first, end)) => {
            let end = match end.strip_prefix('=') {
                Some(end) => end.parse::<u64>().ok().map(|end| end.saturating_add(1)),
                None => number(end, count),
            };
            number(first, 0).zip(end).map(|(first, end)| first..end)
        }
    };
    let range = parsed.filter(|range| range.start < range.end && range.end <= last);
    let found =
        || Error::Arguments(format!("--frames {text}: expected A..B within 0..{last}, of {frames} frames"));
    let range = range.ok_or_else(found)?;
    if range.end - range.start > MOST_PICTURES {
        return Err(Error::Arguments(format!("--frames {text}: expected at most {MOST_PICTURES} pictures")));
    }
    Ok(range)
}

/// One picture of a run; the keys are stable.
#[derive(Clone, Copy, Debug, Serialize)]
struct Played {
    /// Its number.
    picture: u64,
    /// The time that it shows, in frames of the motion.
    frame: f64,
    /// Reading the frame and working out where all is, on another thread.
    pose_ms: f64,
    /// For how long that was waited for.
    waited_ms: f64,
    /// Handing it to the device.
    upload_ms: f64,
    /// What was handed over.
    uploaded_bytes: u64,
    /// Drawing, wall time on the device.
    frame_ms: f64,
    /// Writing files.
    write_ms: f64,
    patches_drawn: Option<u64>,
    patches_culled: Option<u64>,
    triangles: Option<u64>,
    clamped_pixels: u64,
}

/// What `--stats` of a run says; the keys are stable.
#[derive(Debug, Serialize)]
struct Report {
    /// Pictures drawn in this run.
    pictures: Vec<Played>,
    /// Pictures that were there already.
    skipped: u64,
    /// Of the last picture, and of all drawn together.
    #[serde(flatten)]
    stats: Stats,
}

/// Draws what is not there yet, writes, reports, makes a film.
///
/// # Errors
/// No device, a device that fails, frames that cannot be read, pictures of something else where these are to go, files
/// that cannot be written, pixels that are not numbers.
pub fn run(mut job: PlayJob) -> Result<(), Error> {
    report_notes(&job.scene, &job.common);
    let device = open_device(&job.common)?;
    let movers = std::mem::take(&mut job.movers);
    let missing = missing(&job, &movers, &device)?;
    let skipped = job.pictures.end - job.pictures.start - missing.len() as u64;
    if skipped > 0 && !job.common.quiet {
        tell!("{skipped} pictures are there already");
    }
    let drawn = if missing.is_empty() { None } else { Some(draw(&job, movers, &missing, &device)?) };
    Device::shutdown(device)?;
    if let Some((path, (pictures, stats))) = job.stats.as_ref().zip(drawn) {
        let report = Report { pictures, skipped, stats };
        let text = serde_json::to_string_pretty(&report);
        write_text(path, &text.map_err(|e| Error::Failed(format!("statistics: {e}")))?)?;
    }
    match &job.film {
        Some(film) => {
            let count = job.pictures.end - job.pictures.start;
            film.encode(shown(&job.outputs)?, job.pictures.start, count)
        }
        None => Ok(()),
    }
}

/// Numbers of the pictures that are not there yet; those that are there are of this job.
fn missing(job: &PlayJob, movers: &Movers, device: &Device) -> Result<Vec<u64>, Error> {
    let is_there = |output: Output| output.path.metadata().is_ok_and(|file| file.is_file() && file.len() > 0);
    let record = Record::new(&job.outputs[0].0, &job.scene, movers, &job.request, device.name());
    let any = job.pictures.clone().any(|picture| job.files(picture).any(is_there));
    record.settle(any, job.fresh)?;
    let missing = |picture: &u64| job.fresh || !job.files(*picture).all(is_there);
    Ok(job.pictures.clone().filter(missing).collect())
}

fn draw(
    job: &PlayJob,
    movers: Movers,
    missing: &[u64],
    device: &Arc<Device>,
) -> Result<(Vec<Played>, Stats), Error> {
    let mut renderer = Renderer::keeping(device, job.scene.clone(), job.request, &job.kept)?;
    let animation = job.scene.file.animation.clone();
    let frames: Vec<f64> = missing.iter().map(|picture| animation.frame_of_picture(*picture)).collect();
    let mut poser = renderer.poser(movers, frames.into_iter());
    let bar = share_bar(&job.common);
    let mut played = Vec::new();
    for (done, &picture) in missing.iter().enumerate() {
        bar.set_message(format!("picture {picture}"));
        let waiting = Instant::now();
        let posed = poser.next_frame()?;
        let mut posed =
            posed.ok_or_else(|| Error::Failed(format!("picture {picture}: expected a frame, found none")))?;
        let waited = waiting.elapsed();
        let progress = |share: f64| set_share(&bar, (done as f64 + share) / missing.len() as f64);
        let drawn = draw_one(job, &mut renderer, picture, &mut posed, &progress)?;
        poser.give_back(posed);
        if job.stats.is_some() {
            played.push(Played { waited_ms: ms(waited), ..drawn });
        }
    }
    bar.finish_and_clear();
    let mut stats = renderer.stats().clone();
    stats.set_gpu_bytes(device);
    stats.host_peak_bytes = host_peak_bytes();
    Ok((played, stats))
}

/// Draws and writes one picture.
fn draw_one(
    job: &PlayJob,
    renderer: &mut Renderer,
    picture: u64,
    posed: &mut PosedFrame,
    progress: &dyn Fn(f64),
) -> Result<Played, Error> {
    let uploading = Instant::now();
    let uploaded_bytes = renderer.pose(posed)?;
    let upload = uploading.elapsed();
    let drawn = renderer.render(progress)?;
    let stats = renderer.stats();
    if stats.nan_pixels > 0 {
        let pixels = stats.nan_pixels;
        let message =
            format!("picture {picture}: {pixels} pixels are not finite numbers: please report this scene");
        return Err(Error::Failed(message));
    }
    let writing = Instant::now();
    job.files(picture).try_for_each(|output| output.write(&drawn))?;
    Ok(Played {
        picture,
        frame: posed.frame,
        pose_ms: ms(posed.taken),
        waited_ms: 0.0,
        upload_ms: ms(upload),
        uploaded_bytes,
        frame_ms: ms(stats.last_frame().map_or(Duration::ZERO, |taken| taken.wall)),
        write_ms: ms(writing.elapsed()),
        patches_drawn: stats.patches_drawn,
        patches_culled: stats.patches_culled,
        triangles: stats.triangles,
        clamped_pixels: stats.clamped_pixels,
    })
}

fn ms(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_pictures() {
        let of = |text: Option<&str>, repeat: bool| {
            pictures(text, &AnimationTable { repeat, speed: 0.5, ..Default::default() }, 10)
        };
        for (text, expected) in [
            (None, 0..19),
            (Some(".."), 0..19),
            (Some("3..7"), 3..7),
            (Some("3..=7"), 3..8),
            (Some("3.."), 3..19),
            (Some("..7"), 0..7),
            (Some("18"), 18..19),
        ] {
            assert_eq!(of(text, false).unwrap(), expected, "{text:?}");
        }
        for bad in
            ["", "7..3", "3..3", "0..20", "19", "a..b", "-1..3", "3...7", "..=", "18446744073709551615"]
        {
            let error = of(Some(bad), false).unwrap_err().to_string();
            assert!(error.contains("--frames") && error.contains("expected"), "{error}");
        }
        assert_eq!(of(Some("0..200"), true).unwrap(), 0..200);
        assert_eq!(of(None, true).unwrap(), 0..20);
    }
}
