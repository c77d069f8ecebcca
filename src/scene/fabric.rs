//! A piece of cloth made ready: file units and axes to mm with Y up, yarn parameters resolved.

use super::SceneError;
use super::fiber_table::resolve_fiber;
use super::file::{FabricTable, SceneFile};
use super::keys::KeyError;
use super::models::Models;
use super::motion::{Motion, world_from_file};
use super::parameters::check_table;
use super::yarn_table::resolve_yarn;
use crate::bsdf::params::FiberParams;
#[cfg(test)]
use crate::bsdf::presets as fiber_presets;
use crate::io::curves::UpAxis;
use crate::io::repair::summarize_repairs;
use crate::io::yarn_file::Loaded;
use crate::math::curve::Curve;
use crate::yarn::contact::estimate_contact_radius;
use crate::yarn::params::YarnParams;
#[cfg(test)]
use crate::yarn::presets;
use crate::yarn::strand::{MOST_MIGRATIONS, Piece, Strands, strands};
use crate::yarn::turning::turns_swiftly;
use glam::DVec3;
use rayon::prelude::*;
use std::path::Path;
use std::time::{Duration, Instant};
use toml::{Table, Value};

/// A loaded fabric.
#[derive(Clone, Debug)]
pub struct Fabric {
    /// The yarn file's name, for reports.
    pub name: String,
    /// Its yarn.
    pub yarn: YarnParams,
    /// Its fibers' look.
    pub fiber: FiberParams,
    /// Its centre lines in mm, world axes.
    pub strands: Strands,
    /// Millimetres per unit of the file.
    pub mm_per_unit: f64,
    /// How it moves, if it does.
    pub motion: Option<Motion>,
    /// Whether some piece of its yarns turns so fast that fibers' cuts must follow, or may come to as it moves.
    pub turns_swiftly: bool,
    /// What a user should know of how the file was read, one line each.
    pub notes: Vec<String>,
    /// How long it took to make.
    pub load: LoadTimes,
}

/// What making a fabric of a file took.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadTimes {
    /// Reading, checking and repairing the file.
    pub read: Duration,
    /// Finding out its unit.
    pub unit: Duration,
    /// Making its yarns ready to carry fibers: lengths, turns, frames.
    pub yarns: Duration,
}

impl Fabric {
    /// Loads one fabric of a scene; `folder` is what its model's path is relative to and `scene` names
    /// the scene in errors. A model that is among `models` is not read again.
    ///
    /// # Errors
    /// Bad yarn files, unknown presets or keys, values out of range.
    pub fn load(
        file: &SceneFile,
        table: &FabricTable,
        folder: &Path,
        scene: &str,
        models: &mut Models,
    ) -> Result<Self, SceneError> {
        if table.model.is_empty() {
            let message = "fabric.model: expected a yarn file, found none".to_owned();
            return Err(SceneError::Value { scene: scene.to_owned(), message });
        }
        let started = Instant::now();
        let loaded = models.yarns(&folder.join(&table.model))?;
        let read = started.elapsed();
        let mut fabric = Self::from_loaded(file, table, &loaded, scene)?;
        if let Some(motion) = &mut fabric.motion {
            motion.path = folder.join(&motion.path);
            // What cannot be opened is said now, not after all has been baked.
            motion.open()?;
        }
        fabric.load.read = read;
        Ok(fabric)
    }

    /// The same for curves that are already there.
    ///
    /// # Errors
    /// Unknown presets or keys, values out of range.
    pub fn from_loaded(
        file: &SceneFile,
        table: &FabricTable,
        loaded: &Loaded,
        scene: &str,
    ) -> Result<Self, SceneError> {
        let value = |message: String| SceneError::Value { scene: scene.to_owned(), message };
        let (preset, yarn) =
            resolve_yarn(&file.yarn, &table.yarn).map_err(|error| value(error.to_string()))?;
        let fiber = resolve_fiber(&file.fiber, &table.fiber).map_err(|error| value(error.to_string()))?;

        let mut notes = loaded.notes.clone();
        notes.extend(summarize_repairs(&loaded.repairs));
        let started = Instant::now();
        let mm_per_unit = match table.mm_per_unit {
            Some(given) => given,
            None => matched_scale(loaded, &preset, &mut notes),
        };
        check_unit(mm_per_unit).map_err(|error| value(error.to_string()))?;
        let unit = started.elapsed();
        let started = Instant::now();
        let curves = world_curves(loaded, mm_per_unit);
        let strands = strands(&curves, loaded.curves.basis, &yarn, file.seed);
        check_turns(&strands).map_err(|message| value(format!("{}: {message}", table.model)))?;
        // A model that says itself how it moves does so unless it is told otherwise.
        let motion = table.motion.as_deref().or(loaded.moves.then_some(table.model.as_str()));
        let turns_swiftly = motion.is_some() || turns_swiftly(&strands);
        let load = LoadTimes { unit, yarns: started.elapsed(), ..Default::default() };
        let per_second = file.animation.frames_per_second;
        let motion = motion.map(|path| Motion::new(Path::new(path), loaded, mm_per_unit, per_second));
        let name = table.model.clone();
        Ok(Self { name, yarn, fiber, strands, mm_per_unit, motion, turns_swiftly, notes, load })
    }

    /// Positions that the picture must hold: the Bezier control points of every piece, in mm.
    pub fn hull_points(&self) -> impl Iterator<Item = DVec3> + Clone {
        self.strands.pieces.iter().flat_map(|piece| self.strands.bezier(piece))
    }

    /// A straight yarn in the default look.
    #[cfg(test)]
    pub fn for_tests() -> Self {
        let yarn = presets::yarn(presets::DEFAULT_YARN).unwrap();
        let points = (0..4).map(|i| DVec3::X * f64::from(i)).collect();
        let strands =
            strands(&[Curve { points, closed: false }], crate::math::curve::Basis::CatmullRom, &yarn, 0);
        let fiber = fiber_presets::fiber(fiber_presets::DEFAULT_FIBER).unwrap();
        Self {
            name: "test".into(),
            yarn,
            fiber,
            strands,
            mm_per_unit: 1.0,
            motion: None,
            turns_swiftly: false,
            notes: Vec::new(),
            load: LoadTimes::default(),
        }
    }
}

/// Checks a unit that may have been worked out, as one that is stated.
fn check_unit(mm_per_unit: f64) -> Result<(), KeyError> {
    let given = Table::from_iter([("mm_per_unit".to_owned(), Value::Float(mm_per_unit))]);
    check_table("fabric", "fabric", &given)
}

/// Most turns of plies, fibers or migration over one piece of yarn: f32 then still has a twentieth of a radian.
const MOST_TURNS: f64 = 1e5;

/// Whether the device can count the turns of every piece, and the periods of every closed curve.
fn check_turns(strands: &Strands) -> Result<(), String> {
    let counts = |piece: &Piece| {
        [piece.turns.ply, piece.turns.fiber, piece.turns.migration].map(|turns| turns.delta.abs())
    };
    // Written so that what is no number is refused.
    let uncounted = |piece: &&Piece| !counts(piece).iter().all(|count| *count <= MOST_TURNS);
    if let Some(piece) = strands.pieces.par_iter().find_first(uncounted) {
        let (curve, length) = (piece.curve, piece.length_mm);
        let most = counts(piece).into_iter().fold(0.0, f64::max);
        return Err(format!(
            "curve {curve}: expected at most {MOST_TURNS} turns over one piece, found {most:.0} in {length} mm"
        ));
    }
    match strands.period_counts.iter().position(|count| *count > MOST_MIGRATIONS) {
        None => Ok(()),
        Some(curve) => Err(format!(
            "curve {curve}: expected a closed yarn of at most {MOST_MIGRATIONS} migrations of its fibers, found {}",
            strands.period_counts[curve]
        )),
    }
}

/// Millimetres per unit so that the file's yarns touch at the preset's outer radius. The preset's, not
/// the overridden one: sweeping a radius must not rescale the model.
fn matched_scale(loaded: &Loaded, preset: &YarnParams, notes: &mut Vec<String>) -> f64 {
    let outer_mm = preset.outer_radius_mm();
    if let Some(scale) = loaded.mm_per_unit {
        notes.push(format!("no mm_per_unit: {} is in units of {scale} mm", loaded.format));
        return scale;
    }
    match estimate_contact_radius(&loaded.curves.curves, loaded.curves.basis) {
        Some(radius) => {
            let scale = outer_mm / radius;
            notes.push(format!(
                "no mm_per_unit: yarns touch at radius {radius:.4} units, matched to the preset's outer \
                 radius {outer_mm:.3} mm: {scale:.4} mm per unit"
            ));
            scale
        }
        None => {
            notes.push("no mm_per_unit and no yarns that touch: 1 unit is taken as 1 mm".into());
            1.0
        }
    }
}

/// The curves in mm with Y up.
fn world_curves(loaded: &Loaded, mm_per_unit: f64) -> Vec<Curve> {
    let up = loaded.curves.up_axis.unwrap_or(UpAxis::Y);
    let place = |curve: &Curve| Curve {
        points: curve.points.iter().map(|&p| world_from_file(up, p) * mm_per_unit).collect(),
        closed: curve.closed,
    };
    loaded.curves.curves.par_iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::curve::Basis;

    fn checked(closed: bool, pitch_mm: f64, step_mm: f64) -> Result<(), String> {
        let mut yarn = presets::yarn(presets::DEFAULT_YARN).unwrap();
        (yarn.fiber_pitch_mm, yarn.migration_rate) = (Some(pitch_mm), 1.0);
        let points = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y].map(|p| p * step_mm).to_vec();
        check_turns(&strands(&[Curve { points, closed }], Basis::CatmullRom, &yarn, 0))
    }

    #[test]
    fn turns_that_the_device_cannot_count_are_refused() {
        assert_eq!(checked(false, 0.01, 500.0), Ok(()));
        let error = checked(false, 0.01, 2000.0).unwrap_err();
        assert!(
            error.starts_with("curve 0: expected at most 100000 turns over one piece, found 2"),
            "{error}"
        );
        assert!(checked(false, 1.0, f64::NAN).is_err());
        assert!(checked(false, 1.0, 1e300).is_err());
    }
}
