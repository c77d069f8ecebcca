//! All views in all ways: what was measured before is kept, the rest is measured, and the report is written after
//! every picture.

use super::against;
use super::measure::{Measured, measure};
use super::references::{self, reference};
use super::report::{
    Cell, Counts, Head, Report, TIMED_BY_DEVICE, TIMED_BY_PROCESSOR, TIMED_BY_WALL, ViewFacts,
};
use super::settings::Setting;
use super::truth::{Floor, Truth, TruthSettings};
use super::views::{View, fiber_px};
use super::work::work;
use crate::error::Error;
use crate::frame::Request;
use crate::frame::sampling::Sampling;
use crate::io::cache::Cache;
use crate::io::error::FileError;
use crate::io::picture::{DisplayImage, write_png};
use crate::math::digest::Digest;
use crate::reference::display::displayed;
use crate::scene::Scene;
use crate::vulkan::Device;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

/// The report's folder of small pictures.
const THUMBNAILS: &str = "thumbnails";
/// Widest of them, in pixels.
const THUMBNAIL_PX: u32 = 128;
/// What a reference weighs in the progress, in samples a pixel of it, against a drawn picture's samples.
const TRACED_WEIGHT: f64 = 4.0;

/// What is to be measured.
pub struct Plan {
    /// A scene or a yarn file.
    pub scene: PathBuf,
    /// What a reader knows it by.
    pub model: String,
    /// Scene keys set for every picture, reference included.
    pub sets: Vec<String>,
    /// From where it is looked at.
    pub views: Vec<View>,
    /// The ways to draw it.
    pub settings: Vec<Setting>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Of the references.
    pub truth: TruthSettings,
    /// Pictures of which the median counts.
    pub frames: u32,
    /// Where the report goes.
    pub folder: PathBuf,
    /// Where references are kept.
    pub cache: Cache,
}

/// A view with what decides its pictures.
struct Prepared<'a> {
    view: &'a View,
    sets: Vec<String>,
    scene: Scene,
    key: u64,
}

/// Measures what the report in the folder does not hold yet. `tell` hears the share done and what is being done.
///
/// # Errors
/// Those of scenes, references, the device and files.
pub fn run(device: &Arc<Device>, plan: &Plan, tell: &mut dyn FnMut(f64, &str)) -> Result<Report, Error> {
    let folder = plan.folder.join(THUMBNAILS);
    std::fs::create_dir_all(&folder).map_err(|e| FileError::io(&folder, "make", &e))?;
    let earlier = Report::read(&plan.folder)?;
    let prepared = prepare(plan)?;
    let common = common_key(device, plan)?;
    let mut report =
        Report { head: head(device, plan), views: Vec::new(), cells: Vec::new(), warnings: Vec::new() };
    let earlier_cells = earlier.as_ref().map(|report| report.cells.as_slice()).unwrap_or_default();
    let mut progress = Progress::new(plan, &prepared, tell);
    for prepared in &prepared {
        let traced = progress.reference_weight(prepared.key);
        let doing = format!("reference, {}", prepared.view.name);
        let truth = reference(&plan.cache, &prepared.scene, plan.size, &plan.truth, &mut |share| {
            progress.tell(traced * share, &doing);
            Ok(())
        })?;
        progress.done += traced;
        report.views.push(view_facts(plan, prepared, &truth)?);
        for (index, setting) in plan.settings.iter().enumerate() {
            let key = cell_key(common, prepared, setting);
            progress.tell(0.0, &format!("{}, {}", prepared.view.name, setting.name));
            let kept = earlier_cells
                .iter()
                .find(|cell| cell.key == key && plan.folder.join(&cell.thumbnail).exists());
            let cell = match kept {
                // Names are not in the key: what is drawn is.
                Some(kept) => {
                    Cell { view: prepared.view.name.clone(), setting: setting.clone(), ..kept.clone() }
                }
                None => {
                    let name = format!("{THUMBNAILS}/{}-{index}.png", file_name(&prepared.view.name));
                    draw(device, plan, prepared, setting, &truth, (key, name))?
                }
            };
            if kept.is_some() {
                report.head.date = earlier.as_ref().map_or(String::new(), |report| report.head.date.clone());
            }
            report.cells.push(cell);
            progress.done += weight(setting, plan.frames);
            report.warnings = report.spread_warnings();
            if kept.is_none() {
                with_the_rest(&report, earlier_cells).write(&plan.folder)?;
            }
        }
    }
    report.write(&plan.folder)?;
    Ok(report)
}

/// The report so far with the earlier cells that it has not come to yet: stopped now, none is lost.
fn with_the_rest(report: &Report, earlier: &[Cell]) -> Report {
    let mut all = report.clone();
    let missing = earlier.iter().filter(|cell| report.cells.iter().all(|other| other.key != cell.key));
    all.cells.extend(missing.cloned());
    all
}

fn prepare(plan: &Plan) -> Result<Vec<Prepared<'_>>, Error> {
    let mut all = Vec::new();
    for view in &plan.views {
        let sets = [&plan.sets[..], &view.sets[..]].concat();
        let scene = Scene::load(&plan.scene, &sets)?;
        let key = references::key(&scene, plan.size, &plan.truth);
        all.push(Prepared { view, sets, scene, key });
    }
    Ok(all)
}

/// Draws and compares one picture.
fn draw(
    device: &Arc<Device>,
    plan: &Plan,
    prepared: &Prepared<'_>,
    setting: &Setting,
    truth: &Truth,
    (key, thumbnail): (String, String),
) -> Result<Cell, Error> {
    let scene = Scene::load(&plan.scene, &[&prepared.sets[..], &setting.sets[..]].concat())?;
    let sampling = Sampling::new(setting.samples).map_err(Error::Arguments)?;
    let request = Request { size: plan.size, sampling, statistics: false, profile: false };
    let measured = measure(device, scene, request, plan.frames)?;
    let Measured { linear, display, stats, .. } = &measured;
    let error = against(linear, &truth.picture.mean)?.error.covered;
    write_thumbnail(&plan.folder.join(&thumbnail), display)?;
    Ok(Cell {
        key,
        view: prepared.view.name.clone(),
        setting: setting.clone(),
        flip: error.flip_mean,
        mse: error.mse,
        floor_flip: floor(&truth.floors, setting.samples),
        cpu_ms: measured.cpu_ms.median.is_finite().then_some(measured.cpu_ms),
        wall_ms: measured.wall_ms,
        device_ms: measured.device_ms,
        gpu_bytes: measured.gpu_bytes,
        counts: Counts {
            control_points: stats.control_points,
            fiber_curves: stats.fiber_curves,
            fiber_segments: stats.fiber_segments.unwrap_or(0),
        },
        work: work(&prepared.scene, plan.size),
        thumbnail,
    })
}

fn floor(floors: &[Floor], samples: u32) -> Option<f64> {
    floors.iter().find(|floor| floor.samples == u64::from(samples)).map(|floor| floor.flip)
}

fn view_facts(plan: &Plan, prepared: &Prepared<'_>, truth: &Truth) -> Result<ViewFacts, Error> {
    let thumbnail = format!("{THUMBNAILS}/{}-reference.png", file_name(&prepared.view.name));
    let shown = displayed(&truth.picture.mean, &prepared.scene.file.display);
    write_thumbnail(&plan.folder.join(&thumbnail), &shown)?;
    Ok(ViewFacts {
        name: prepared.view.name.clone(),
        fiber_px: fiber_px(&prepared.scene, plan.size)?,
        floors: truth.floors.clone(),
        chord_error: truth.chord_error,
        thumbnail,
    })
}

fn file_name(view: &str) -> String {
    view.replace(|c: char| !c.is_ascii_alphanumeric(), "-")
}

/// A small picture of a picture.
fn write_thumbnail(path: &Path, display: &DisplayImage) -> Result<(), Error> {
    let whole = image::RgbaImage::from_raw(display.width, display.height, display.pixels.concat())
        .ok_or_else(|| Error::Failed("expected as many pixels as the picture's size says".into()))?;
    let width = THUMBNAIL_PX.min(display.width);
    let height = (u64::from(width) * u64::from(display.height) / u64::from(display.width)).max(1) as u32;
    let small = image::imageops::thumbnail(&whole, width, height);
    let pixels = small.pixels().map(|pixel| pixel.0).collect();
    Ok(write_png(path, &DisplayImage { width, height, pixels })?)
}

/// Everything that decides all cells: the device, the frames, and this very program.
fn common_key(device: &Device, plan: &Plan) -> Result<Digest, Error> {
    let path = std::env::current_exe().map_err(|e| FileError::io(Path::new("worsted"), "find", &e))?;
    let program = std::fs::read(&path).map_err(|e| FileError::io(&path, "read", &e))?;
    let mut digest = Digest(3);
    digest.text(device.name());
    digest.text(device.driver());
    digest.words([u64::from(plan.frames), program.len() as u64]);
    let word = |bytes: &[u8]| bytes.iter().fold(0, |word, byte| word << 8 | u64::from(*byte));
    digest.words(program.chunks(8).map(word));
    Ok(digest)
}

fn cell_key(mut digest: Digest, prepared: &Prepared<'_>, setting: &Setting) -> String {
    digest.words([prepared.key, u64::from(setting.samples), setting.sets.len() as u64]);
    digest.text(&format!("{:?}", prepared.scene.file));
    setting.sets.iter().for_each(|set| digest.text(set));
    format!("{:016x}", digest.0)
}

fn head(device: &Device, plan: &Plan) -> Head {
    let timing_method = if device.is_cpu() {
        if cfg!(unix) { TIMED_BY_PROCESSOR } else { TIMED_BY_WALL }
    } else {
        TIMED_BY_DEVICE
    };
    Head {
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        version: env!("CARGO_PKG_VERSION").into(),
        device: device.name().into(),
        driver: device.driver().into(),
        processors: std::thread::available_parallelism().map_or(1, usize::from),
        timing_method: timing_method.into(),
        size: plan.size,
        reference_samples: plan.truth.samples,
        model: plan.model.clone(),
    }
}

/// How far everything is, in samples a pixel.
struct Progress<'a> {
    done: f64,
    all: f64,
    traced: f64,
    cache: &'a Cache,
    report: &'a mut dyn FnMut(f64, &str),
}

impl<'a> Progress<'a> {
    fn new(plan: &'a Plan, prepared: &[Prepared<'_>], report: &'a mut dyn FnMut(f64, &str)) -> Self {
        let traced =
            TRACED_WEIGHT * (plan.truth.samples as f64 + plan.truth.floors.iter().sum::<u64>() as f64);
        let mut progress = Self { done: 0.0, all: 0.0, traced, cache: &plan.cache, report };
        let references: f64 = prepared.iter().map(|view| progress.reference_weight(view.key)).sum();
        let cells: f64 = plan.settings.iter().map(|setting| weight(setting, plan.frames)).sum();
        progress.all = references + cells * prepared.len() as f64;
        progress
    }

    fn reference_weight(&self, key: u64) -> f64 {
        if references::is_kept(self.cache, key) { 0.0 } else { self.traced }
    }

    fn tell(&mut self, more: f64, doing: &str) {
        (self.report)((self.done + more) / self.all.max(1e-9), doing);
    }
}

fn weight(setting: &Setting, frames: u32) -> f64 {
    f64::from(setting.samples.max(2)) * f64::from(frames + 1)
}
