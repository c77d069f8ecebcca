//! Fibers as a BCC file of polylines, and beside it what BCC has no room for.
//!
//! BCC knows points and nothing else: no radius, no number. A second file, `NAME.bcc.json`, says the rest of each
//! curve in the order of the BCC file: `{"units": "mm", "up_axis": "Y", "curves": [...]}` with `fabric`, `curve`,
//! `ply`, `fiber` (indices from 0) and `radius_mm`, a number, or a list with one for each point where it tapers.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::bcc::{CurveRef, write_bcc_curves};
use super::curves::{Basis, UpAxis};
use super::error::FileError;
use super::fiber_runs::{FiberGroup, FiberRun, check_runs};
use super::whole::{check_target, write_whole};

/// Where the file beside the BCC file goes.
pub fn side_file(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

/// Writes both files; neither is left half-written. `progress` is told points as they are written.
///
/// # Errors
/// Runs that no reader would take; what the file system says.
pub fn write_fiber_bcc(
    path: &Path,
    groups: &[FiberGroup<'_>],
    progress: &dyn Fn(u64),
) -> Result<(), FileError> {
    check_runs(path, groups)?;
    check_target(path)?;
    let side = side_file(path);
    write_whole(&side, |out| write_side(out, groups))?;
    let runs = groups.iter().flat_map(|group| &group.runs);
    let curves = runs.map(|run| CurveRef { points: run.points, closed: run.closed });
    let written = write_bcc_curves(path, Basis::Polyline, UpAxis::Y, curves, progress);
    if written.is_err() {
        // Alone it would describe nothing; the error to report is the other file's.
        let _ = std::fs::remove_file(&side);
    }
    written
}

fn write_side(out: &mut dyn Write, groups: &[FiberGroup<'_>]) -> std::io::Result<()> {
    write!(out, "{{\"units\": \"mm\", \"up_axis\": \"Y\", \"curves\": [")?;
    let runs =
        groups.iter().enumerate().flat_map(|(fabric, group)| group.runs.iter().map(move |run| (fabric, run)));
    for (index, (fabric, run)) in runs.enumerate() {
        let separator = if index == 0 { "\n" } else { ",\n" };
        let FiberRun { curve, ply, fiber, .. } = run;
        write!(
            out,
            "{separator}{{\"fabric\": {fabric}, \"curve\": {curve}, \"ply\": {ply}, \"fiber\": {fiber}, "
        )?;
        write!(out, "\"radius_mm\": ")?;
        write_radii(out, run.radii_mm)?;
        write!(out, "}}")?;
    }
    writeln!(out, "\n]}}")
}

/// One number where all are the same, else a list.
fn write_radii(out: &mut dyn Write, radii_mm: &[f64]) -> std::io::Result<()> {
    let mut radii = radii_mm.iter().map(|&radius| radius as f32);
    let first = radii.next().unwrap_or_default();
    if radii.clone().all(|radius| radius == first) {
        return write!(out, "{first}");
    }
    write!(out, "[{first}")?;
    for radius in radii {
        write!(out, ", {radius}")?;
    }
    write!(out, "]")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::bcc::read_bcc;
    use glam::DVec3;

    #[test]
    fn points_and_radii_are_read_back_as_f32_in_one_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bcc");
        let points: Vec<DVec3> = (0..5).map(|i| DVec3::new(0.1, 7.3, 1.7) * f64::from(i)).collect();
        let (even, taper) = ([0.0123; 5], [0.0123, 0.0123, 0.01, 0.005, 0.0]);
        let run =
            |radii_mm, closed, fiber| FiberRun { points: &points, radii_mm, closed, curve: 3, ply: 1, fiber };
        let groups = [
            FiberGroup { runs: vec![run(&even[..], false, 4)] },
            FiberGroup { runs: vec![run(&even[..], true, 5), run(&taper[..], false, 6)] },
        ];
        let told = std::cell::Cell::new(0);
        write_fiber_bcc(&path, &groups, &|points| told.set(told.get() + points)).unwrap();
        assert_eq!(told.get(), 15);
        let curves = read_bcc(&path).unwrap().curves;
        assert_eq!((curves.basis, curves.up_axis), (Basis::Polyline, Some(UpAxis::Y)));
        let expected: Vec<DVec3> = points.iter().map(|p| p.as_vec3().as_dvec3()).collect();
        assert_eq!(curves.curves.iter().map(|c| c.closed).collect::<Vec<_>>(), [false, true, false]);
        assert!(curves.curves.iter().all(|curve| curve.points == expected));

        let side: serde_json::Value =
            serde_json::from_slice(&std::fs::read(side_file(&path)).unwrap()).unwrap();
        let curves = side["curves"].as_array().unwrap();
        let of = |key: &str| curves.iter().map(|c| c[key].as_u64().unwrap()).collect::<Vec<_>>();
        assert_eq!((of("fabric"), of("fiber"), of("ply")), (vec![0, 1, 1], vec![4, 5, 6], vec![1; 3]));
        assert_eq!(curves[0]["radius_mm"].as_f64().map(|r| r as f32), Some(0.0123));
        assert_eq!(curves[2]["radius_mm"].as_array().unwrap().len(), 5);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn nothing_is_left_of_what_could_not_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bcc");
        assert!(write_fiber_bcc(&path, &[], &|_| ()).is_err());
        let points = [DVec3::ZERO, DVec3::X];
        let run =
            FiberRun { points: &points, radii_mm: &[0.1; 2], closed: false, curve: 0, ply: 0, fiber: 0 };
        let group = FiberGroup { runs: vec![run] };
        std::fs::create_dir(&path).unwrap();
        assert!(write_fiber_bcc(&path, &[group], &|_| ()).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
