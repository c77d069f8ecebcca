//! What pictures are compared with: every fiber traced, and how far a second such picture is from the first by noise
//! alone.

use super::against;
use crate::error::Error;
use crate::io::measured::MeasuredImage;
use crate::io::picture::LinearImage;
use crate::metrics::error::RegionError;
use crate::reference::accel::Accel;
use crate::reference::checkpoint;
use crate::reference::fibers::{RealiseSettings, RealisedFiber, realise};
use crate::reference::geometry::FiberGeometry;
use crate::reference::integrator::{TraceSettings, Tracer};
use crate::reference::rendering::Rendering;
use crate::scene::Scene;
use std::path::Path;
use std::time::{Duration, Instant};

/// Tiles traced between two looks at the clock.
const TILES_AT_ONCE: u64 = 128;
/// How often what was done so far is kept.
const KEPT_EVERY: Duration = Duration::from_secs(10);
/// Most points of fibers held at once: about 8 GB while their tree is built. Beyond it pieces are made coarser.
const MOST_POINTS: u64 = 24 << 20;
/// How far pieces may depart from fibers, in radii of these; each twice the one before.
const CHORD_ERRORS: [f64; 7] = [0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4];

/// A tracer of the scene, with pieces as fine as memory allows, and how far they depart from fibers in radii.
///
/// # Errors
/// Too many fibers.
pub fn tracer(scene: &Scene, size: [u32; 2], settings: TraceSettings) -> Result<(Tracer<f32>, f64), Error> {
    let (fibers, chord_error) = realised(scene)?;
    let geometry = FiberGeometry::<f32>::new(fibers, scene.origin_mm);
    let accel = Accel::new(geometry).map_err(|e| Error::Arguments(e.to_string()))?;
    Ok((Tracer::new(scene, accel, size, settings), chord_error))
}

fn realised(scene: &Scene) -> Result<(Vec<RealisedFiber>, f64), Error> {
    let mut failed = None;
    for chord_error in CHORD_ERRORS {
        match realise(scene, &RealiseSettings { chord_error, max_points: MOST_POINTS }) {
            Ok(fibers) => return Ok((fibers, chord_error)),
            Err(error) => failed = Some(error),
        }
    }
    Err(Error::Arguments(failed.map_or_else(String::new, |error| error.to_string())))
}

/// How a reference is traced.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthSettings {
    /// Samples a pixel, at least 1.
    pub samples: u64,
    /// Samples a pixel of the second picture, at each of which it is compared with the first; rising.
    pub floors: Vec<u64>,
}

/// The noise of a perfect picture of so many samples a pixel, as an error against the reference.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Floor {
    /// Samples a pixel of that picture.
    pub samples: u64,
    /// Mean FLIP over covered pixels.
    pub flip: f64,
    /// Mean squared error of radiance over covered pixels.
    pub mse: f64,
}

/// A reference, and what noise alone does to pictures that are compared with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// The picture, with its variance.
    pub picture: MeasuredImage,
    /// What noise does, by samples.
    pub floors: Vec<Floor>,
    /// How far pieces of fibers departed from these, in radii.
    pub chord_error: f64,
}

/// Traces `first`, a picture of `samples` samples, and then one of its own samples for each of `counts`, rising.
/// `each` sees the rendering after every few tiles.
///
/// # Errors
/// Those of `each`.
pub fn first_and_seconds(
    tracer: &Tracer<f32>,
    rendering: &mut Rendering,
    samples: u64,
    counts: &[u64],
    mut each: impl FnMut(&Rendering) -> Result<(), Error>,
) -> Result<(MeasuredImage, Vec<LinearImage>), Error> {
    let mut trace_to = |rendering: &mut Rendering, samples: u64| {
        while !rendering.is_done(samples) {
            rendering.advance(tracer, samples, TILES_AT_ONCE);
            each(rendering)?;
        }
        Ok::<_, Error>(rendering.measured())
    };
    let first = trace_to(rendering, samples)?;
    let mut seconds = Vec::new();
    for &count in counts {
        // A pass that is cut short counts as whole: what comes after begins from before it.
        let both = trace_to(&mut rendering.clone(), samples + count)?;
        seconds.push(rest(&both.mean, &first.mean, samples as f64, count as f64));
    }
    Ok((first, seconds))
}

/// The picture that `both` adds to `first`, which has `samples` samples, by `count` more.
fn rest(both: &LinearImage, first: &LinearImage, samples: f64, count: f64) -> LinearImage {
    let value = |both: f32, first: f32| {
        let sum = (samples + count) * f64::from(both) - samples * f64::from(first);
        // What rounding leaves of nothing is nothing.
        if sum < 1e-5 * samples * f64::from(first) { 0.0 } else { (sum / count) as f32 }
    };
    let pixel = |(both, first): (&[f32; 4], &[f32; 4])| std::array::from_fn(|c| value(both[c], first[c]));
    let pixels = both.pixels.iter().zip(&first.pixels).map(pixel).collect();
    LinearImage { width: both.width, height: both.height, pixels }
}

/// Is told the share done; where it fails, so does what tells it.
pub type Progress<'a> = dyn FnMut(f64) -> Result<(), Error> + 'a;

/// Traces a reference and its floors, going on from what `part` holds.
///
/// # Errors
/// Too many fibers; samples that are no numbers; files that cannot be written; those of `progress`, with what was done by
/// then kept in `part`.
pub fn trace(
    scene: &Scene,
    size: [u32; 2],
    settings: &TruthSettings,
    part: &Path,
    progress: &mut Progress<'_>,
) -> Result<Truth, Error> {
    let trace = TraceSettings::default();
    let (tracer, chord_error) = tracer(scene, size, trace)?;
    let key = checkpoint::key(scene, size, chord_error, &trace);
    // What was kept may be of another program, or damaged: then it is traced anew.
    let mut rendering =
        checkpoint::load(part, key, size).ok().flatten().unwrap_or_else(|| Rendering::new(size));
    let mut kept = Instant::now();
    let all = settings.samples as f64 + settings.floors.iter().sum::<u64>() as f64;
    let (mut done_before, mut last) = (0.0, 0.0);
    let (picture, seconds) =
        first_and_seconds(&tracer, &mut rendering, settings.samples, &settings.floors, |rendering| {
            let tiles = rendering.tally.tiles as f64 / rendering.tiles_per_pass() as f64;
            let samples = tiles * crate::reference::rendering::SAMPLES_PER_PASS as f64;
            if samples < last {
                done_before += last - settings.samples as f64;
            }
            last = samples;
            let goes_on = progress(((done_before + samples) / all).min(1.0));
            if (goes_on.is_err() || kept.elapsed() > KEPT_EVERY) && samples <= settings.samples as f64 {
                checkpoint::save(part, key, rendering)?;
                kept = Instant::now();
            }
            goes_on
        })?;
    if rendering.tally.not_finite > 0 {
        let count = rendering.tally.not_finite;
        return Err(Error::Failed(format!(
            "{count} samples are not finite numbers: please report this scene"
        )));
    }
    let floor = |(samples, second): (&u64, &LinearImage)| {
        let RegionError { flip_mean, mse, .. } = against(second, &picture.mean)?.error.covered;
        Ok(Floor { samples: *samples, flip: flip_mean, mse })
    };
    let floors = settings.floors.iter().zip(&seconds).map(floor).collect::<Result<Vec<_>, Error>>()?;
    Ok(Truth { picture, floors, chord_error })
}
