//! What was typed, resolved into what will run.

use super::args::{Common, Render, SceneArgs, TimeArgs, ViewArgs};
use super::bench_args::CacheArgs;
use super::budget::BudgetJob;
use super::output::{Output, check_layers};
use crate::cli::say::tell;
use crate::error::Error;
use crate::frame::{Request, check_tables};
use crate::io::cache::Cache;
use crate::io::kept::Kept;
use crate::io::picture::{MAX_PIXELS, MAX_SIDE};
use crate::io::whole::check_target;
use crate::motion::mover::Movers;
use crate::reference::fibers::RealiseSettings;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// A picture to be drawn.
pub struct RenderJob {
    /// The scene, loaded.
    pub scene: Scene,
    /// The same as it was before a budget changed it.
    pub asked_for: Option<Scene>,
    /// Where it was loaded from.
    pub path: PathBuf,
    /// With these assignments.
    pub sets: Vec<String>,
    /// What the picture may cost.
    pub budget: Option<BudgetJob>,
    /// Size, samples, and what to count.
    pub request: Request,
    /// Where the picture goes.
    pub outputs: Vec<Output>,
    /// Pictures to draw for the statistics.
    pub repeat: u32,
    /// Where statistics go.
    pub stats: Option<PathBuf>,
    /// Whether to say what was left out.
    pub explain: bool,
    /// Tables and pipelines of earlier runs.
    pub kept: Kept,
    /// Device and log options.
    pub common: Common,
}

impl RenderJob {
    /// Resolves arguments and loads the scene.
    ///
    /// # Errors
    /// Arguments that make no sense, a scene that cannot be had.
    pub fn new(args: &Render, common: &Common) -> Result<Self, Error> {
        let outputs = args.output.iter().map(|path| Output::new(path)).collect::<Result<Vec<_>, _>>()?;
        if let Some(stats) = args.stats.as_deref().filter(|path| *path != Path::new("-")) {
            check_target(stats)?;
        }
        let request = Request {
            size: parse_size(&args.view.size)?,
            sampling: args.samples,
            statistics: args.stats.is_some() || args.explain,
            profile: args.profile,
        };
        let mut sets: Vec<String> = args.layers.assignments().collect();
        sets.extend(assignments(&args.scene, args.time.frame, args.view.camera.as_deref())?);
        let scene = Scene::load(&args.scene.path, &sets)?;
        check_layers(&scene.file.layers, outputs.iter().map(|output| output.format))?;
        check_tables(&scene)?;
        let budget = BudgetJob::new(&args.budget)?;
        if budget.is_some() && scene.file.animation.frame.is_some() {
            let message =
                "--max-error, --max-ms: expected a model at rest, which was measured, found animation.frame";
            return Err(Error::Arguments(message.to_owned()));
        }
        Ok(Self {
            asked_for: None,
            scene,
            path: args.scene.path.clone(),
            sets,
            budget,
            request,
            outputs,
            repeat: args.repeat,
            stats: args.stats.clone(),
            explain: args.explain,
            kept: kept(args.no_cache, &args.budget.cache),
            common: common.clone(),
        })
    }
}

/// Where tables and pipelines are kept: nowhere for a user without a home, who named no folder.
pub(super) fn kept(no_cache: bool, cache: &CacheArgs) -> Kept {
    if no_cache {
        return Kept::NOTHING;
    }
    Cache::new(cache.folder.as_deref()).map(Kept::within).unwrap_or_else(|why| {
        tracing::debug!("{why}");
        Kept::NOTHING
    })
}

/// The scene with what `--motion`, `--frame`, `--camera`, `--seed` and `--set` set, in an order that gives `--set` the
/// last word. Fabrics are where the frame has them; a camera for pictures of `size` is fitted as for any frame.
///
/// # Errors
/// A camera that makes no sense, a scene that cannot be had, a frame that cannot be read.
pub(super) fn load_scene(
    args: &SceneArgs,
    time: &TimeArgs,
    view: Option<(&ViewArgs, [u32; 2])>,
) -> Result<Scene, Error> {
    let camera = view.and_then(|(view, _)| view.camera.as_deref());
    let mut scene = Scene::load(&args.path, &assignments(args, time.frame, camera)?)?;
    pose(&mut scene, view.map(|(_, size)| size))?;
    Ok(scene)
}

/// Puts fabrics where the frame that the scene asks for has them; a camera for pictures of `size` is fitted as for any
/// frame.
///
/// # Errors
/// A frame that cannot be read.
pub(super) fn pose(scene: &mut Scene, size: Option<[u32; 2]>) -> Result<(), Error> {
    let Some(frame) = scene.file.animation.frame else { return Ok(()) };
    let mut movers = Movers::open(scene)?;
    if let Some(size) = size {
        movers.fix_camera(scene, size)?;
    }
    Ok(movers.put(scene, frame)?)
}

/// What `--motion`, `--frame`, `--camera`, `--seed` and `--set` set.
pub(super) fn assignments(
    args: &SceneArgs,
    frame: Option<f64>,
    camera: Option<&str>,
) -> Result<Vec<String>, Error> {
    let mut assignments = camera.map(camera_assignments).transpose()?.unwrap_or_default();
    assignments.extend(args.seed.map(|seed| format!("seed={seed}")));
    assignments.extend(frame.map(|frame| format!("animation.frame={frame:?}")));
    assignments.extend(args.motion.as_deref().map(motion_assignment).transpose()?);
    assignments.extend(args.set.iter().cloned());
    Ok(assignments)
}

/// `--motion FILE` as an assignment, whose path is not relative to the scene file.
fn motion_assignment(path: &Path) -> Result<String, Error> {
    let wrong = |why: String| Error::Arguments(format!("--motion {}: {why}", path.display()));
    let whole = std::path::absolute(path).map_err(|e| wrong(e.to_string()))?;
    let text = whole.to_str().ok_or_else(|| wrong("expected a UTF-8 path".into()))?;
    Ok(format!("fabric.motion={}", toml::Value::String(text.to_owned())))
}

/// Says what a user should know of how the yarn was read.
pub(super) fn report_notes(scene: &Scene, common: &Common) {
    if !common.quiet {
        for fabric in &scene.fabrics {
            fabric.notes.iter().for_each(|note| tell!("{}: {note}", fabric.name));
        }
    }
}

/// How fibers are realised with this `--chord-error`.
///
/// # Errors
/// One out of range.
pub(super) fn realise_settings(chord_error: f64) -> Result<RealiseSettings, Error> {
    in_range("--chord-error", chord_error, 1e-4, 10.0)?;
    Ok(RealiseSettings { chord_error, ..Default::default() })
}

/// Whether an option's value is from `low` to `high`.
///
/// # Errors
/// One that is not.
pub(super) fn in_range(name: &str, value: f64, low: f64, high: f64) -> Result<(), Error> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(Error::Arguments(format!("{name} {value}: allowed is {low} to {high}")))
}

/// `1280x960`.
pub(super) fn parse_size(text: &str) -> Result<[u32; 2], Error> {
    let side = |s: &str| s.parse::<u32>().ok().filter(|n| (1..=MAX_SIDE).contains(n));
    let fits = |[w, h]: &[u32; 2]| u64::from(*w) * u64::from(*h) <= MAX_PIXELS;
    let parsed = text.split_once('x').and_then(|(w, h)| Some([side(w)?, side(h)?])).filter(fits);
    parsed.ok_or_else(|| {
        let expected = format!("sides of 1 to {MAX_SIDE} pixels and at most {MAX_PIXELS} in all");
        Error::Arguments(format!("--size {text}: expected WxH with {expected}"))
    })
}

/// `yaw=30,pitch=20,distance=400,target=0:0:0` or `fit` as assignments to scene keys.
fn camera_assignments(text: &str) -> Result<Vec<String>, Error> {
    let wrong = |what: String| Error::Arguments(format!("--camera {text}: {what}"));
    let number = |value: &str| {
        let parsed = value.parse::<f64>().ok().filter(|v| v.is_finite());
        parsed.ok_or_else(|| wrong(format!("expected a number, found `{value}`")))
    };
    let mut assignments = Vec::new();
    for part in text.split(',') {
        if part == "fit" {
            assignments.push("camera.fit=true".to_owned());
            continue;
        }
        let (key, value) =
            part.split_once('=').ok_or_else(|| wrong(format!("expected key=value, found `{part}`")))?;
        assignments.push(match key {
            "yaw" | "pitch" => format!("camera.{key}_deg={:?}", number(value)?),
            "fov" => format!("camera.fov_y_deg={:?}", number(value)?),
            "distance" => format!("camera.distance_mm={:?}", number(value)?),
            "target" => {
                let xyz = value.split(':').map(number).collect::<Result<Vec<_>, _>>()?;
                if xyz.len() != 3 {
                    return Err(wrong(format!("expected target=X:Y:Z, found {} numbers", xyz.len())));
                }
                format!("camera.target_mm={xyz:?}")
            }
            _ => {
                return Err(wrong(format!(
                    "expected yaw, pitch, distance, target, fov or fit, found `{key}`"
                )));
            }
        });
    }
    Ok(assignments)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(parse_size("640x480").unwrap(), [640, 480]);
        for bad in ["640", "0x4", "640x", "axb", "99999x1", "16384x16384", "4x-1", ""] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn cameras() {
        let good = camera_assignments("yaw=-30,pitch=20,distance=400,target=1:2:-3.5").unwrap();
        let expected = [
            "camera.yaw_deg=-30.0",
            "camera.pitch_deg=20.0",
            "camera.distance_mm=400.0",
            "camera.target_mm=[1.0, 2.0, -3.5]",
        ];
        assert_eq!(good, expected);
        assert_eq!(camera_assignments("fit").unwrap(), ["camera.fit=true"]);
        for bad in ["yaw", "roll=3", "yaw=x", "target=1:2", "yaw=nan", ""] {
            let error = camera_assignments(bad).unwrap_err().to_string();
            assert!(!error.contains('\n'), "{error}");
        }
    }
}
