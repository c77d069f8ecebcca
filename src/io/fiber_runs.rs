//! Fibers one by one, as other renderers take them: polylines with a radius at each point.

use std::path::Path;

use glam::DVec3;

use super::error::{FileError, Place};
use super::yarn_file::coordinate_fault;

/// One unbroken run of a fiber, borrowed: nothing is copied on the way to a file.
#[derive(Clone, Copy, Debug)]
pub struct FiberRun<'a> {
    /// At least two points of the axis in mm, Y up.
    pub points: &'a [DVec3],
    /// Its radius in mm at each point.
    pub radii_mm: &'a [f64],
    /// Whether the last point is joined to the first again, which is not repeated.
    pub closed: bool,
    /// Index of the yarn that it belongs to, in its fabric.
    pub curve: usize,
    /// Index of the ply in the yarn.
    pub ply: u32,
    /// Index in the yarn's cross-section; several runs share it where hairs end.
    pub fiber: u32,
}

/// The fibers of one fabric.
#[derive(Clone, Debug, Default)]
pub struct FiberGroup<'a> {
    /// Its runs, in the file's order.
    pub runs: Vec<FiberRun<'a>>,
}

/// Points of all runs together.
pub fn point_count(groups: &[FiberGroup<'_>]) -> u64 {
    groups.iter().flat_map(|group| &group.runs).map(|run| run.points.len() as u64).sum()
}

/// Whether every run can be written so that others can read it; `path` and the run's index among all are named.
pub(super) fn check_runs(path: &Path, groups: &[FiberGroup<'_>]) -> Result<(), FileError> {
    if groups.iter().all(|group| group.runs.is_empty()) {
        return Err(FileError::new(path, Place::File, "expected at least one fiber to write, found 0"));
    }
    for (index, run) in groups.iter().flat_map(|group| &group.runs).enumerate() {
        if let Some(fault) = run_fault(run) {
            return Err(FileError::new(path, Place::Curve(index), fault));
        }
    }
    Ok(())
}

fn run_fault(run: &FiberRun<'_>) -> Option<String> {
    let (points, radii) = (run.points.len(), run.radii_mm.len());
    if points < 2 || i32::try_from(points).is_err() {
        return Some(format!("expected 2 to {} points, found {points}", i32::MAX));
    }
    if radii != points {
        return Some(format!("expected a radius for each of {points} points, found {radii}"));
    }
    let bad = run.radii_mm.iter().find(|radius| !(0.0..=f64::from(f32::MAX)).contains(*radius));
    let radius = bad.map(|radius| format!("expected a radius from 0 mm up, found {radius}"));
    radius.or_else(|| run.points.iter().find_map(|&p| coordinate_fault(p)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_could_read_is_refused_by_its_index() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let good =
            FiberRun { points: &points, radii_mm: &[0.1; 3], closed: false, curve: 0, ply: 0, fiber: 0 };
        let refusal = |run: FiberRun<'_>| {
            let groups = [FiberGroup { runs: vec![good] }, FiberGroup { runs: vec![good, run] }];
            check_runs(Path::new("a.usda"), &groups).unwrap_err().to_string()
        };
        let wild = [DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::Y];
        for (run, message) in [
            (FiberRun { points: &points[..1], ..good }, "found 1"),
            (FiberRun { radii_mm: &[0.1; 2], ..good }, "each of 3 points, found 2"),
            (FiberRun { radii_mm: &[0.1, -0.1, 0.1], ..good }, "found -0.1"),
            (FiberRun { radii_mm: &[0.1, f64::NAN, 0.1], ..good }, "found NaN"),
            (FiberRun { points: &wild, ..good }, "x = NaN"),
        ] {
            let refused = refusal(run);
            assert!(refused.starts_with("a.usda: curve 2: ") && refused.contains(message), "{refused}");
        }
        let group = FiberGroup { runs: vec![good] };
        assert!(check_runs(Path::new("a.usda"), std::slice::from_ref(&group)).is_ok());
        assert_eq!(point_count(&[group.clone(), group]), 6);
        assert!(check_runs(Path::new("a.usda"), &[FiberGroup::default()]).is_err());
    }
}
