//! Every fiber of a scene where it really lies, as runs of points along its axis.

use super::sweep::{Sweep, sweep_curve};
use crate::scene::Scene;
use crate::yarn::fetch::FiberField;
use crate::yarn::strand::Piece;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// How finely fibers are cut into straight pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealiseSettings {
    /// Most that a straight piece may depart from the fiber's axis, as a share of the fiber's radius; above 0.
    pub chord_error: f64,
    /// Most points of all fibers together.
    pub max_points: u64,
}

impl Default for RealiseSettings {
    fn default() -> Self {
        Self { chord_error: 0.1, max_points: 1 << 26 }
    }
}

/// One unbroken run of a fiber: from one end to the next tip of a hair, or all around a closed curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RealisedFiber {
    /// Index of the fabric in the scene.
    pub fabric: usize,
    /// Index of the curve in the fabric.
    pub curve: usize,
    /// The ply it belongs to.
    pub ply: u32,
    /// Index in the yarn's cross-section. Several runs of a curve share it: a hair's tip ends one of them.
    pub fiber: u32,
    /// Whether the last point is joined to the first again, which is not repeated.
    pub closed: bool,
    /// At least two points of the axis, in mm, in the scene's axes with its origin included.
    pub points: Vec<DVec3>,
    /// The fiber's unit direction at each point.
    pub tangents: Vec<DVec3>,
    /// Its radius in mm at each point: hairs taper to 0.
    pub radii_mm: Vec<f64>,
}

impl RealisedFiber {
    /// Straight pieces.
    pub fn segment_count(&self) -> usize {
        self.points.len() - usize::from(!self.closed)
    }
}

/// Fibers that would not fit in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected at most {max_points} points of fibers, found more: take fewer fibers (yarn.fibers_per_ply), less \
     fabric or a larger chord error"
)]
pub struct TooManyPoints {
    /// The limit that was passed.
    pub max_points: u64,
}

/// Realises every fiber of the scene, loops and hairs included, with the random identities that every other
/// path gives them. The order is that of fabrics, curves, fibers and the way along them.
///
/// # Errors
/// More points than the settings allow.
pub fn realise(scene: &Scene, settings: &RealiseSettings) -> Result<Vec<RealisedFiber>, TooManyPoints> {
    let count = AtomicU64::new(0);
    let mut all = Vec::new();
    for (index, fabric) in scene.fabrics.iter().enumerate() {
        let field = FiberField::new(fabric.strands.clone(), &fabric.yarn, scene.file.seed);
        for mut fiber in realise_field(&field, settings, &count)? {
            fiber.fabric = index;
            all.push(fiber);
        }
    }
    Ok(all)
}

/// The same for one fabric; `count` goes up by the points that were made.
///
/// # Errors
/// `count` passes what the settings allow.
pub fn realise_field(
    field: &FiberField,
    settings: &RealiseSettings,
    count: &AtomicU64,
) -> Result<Vec<RealisedFiber>, TooManyPoints> {
    let max_points = settings.max_points;
    let tolerance_mm = settings.chord_error * field.yarn.fiber_radius_mm();
    let curves: Vec<&[Piece]> = field.strands.pieces.chunk_by(|a, b| a.curve == b.curve).collect();
    let jobs: Vec<(&[Piece], usize)> =
        curves.iter().flat_map(|pieces| (0..field.fibers.len()).map(|fiber| (*pieces, fiber))).collect();
    let realised = jobs.into_par_iter().map(|(pieces, fiber)| {
        let left = max_points.saturating_sub(count.load(Ordering::Relaxed));
        let sweep = Sweep { field, pieces, fiber, tolerance_mm, max_points: left };
        let runs = sweep_curve(&sweep).ok_or(TooManyPoints { max_points })?;
        let made: u64 = runs.iter().map(|run| run.points.len() as u64).sum();
        let before = count.fetch_add(made, Ordering::Relaxed);
        if before + made > max_points { Err(TooManyPoints { max_points }) } else { Ok(runs) }
    });
    Ok(realised.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

#[cfg(test)]
#[path = "fibers_tests.rs"]
mod tests;
