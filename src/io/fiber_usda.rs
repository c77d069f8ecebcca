//! Fibers as USD BasisCurves, in USD's plain text (Pixar, OpenUSD: UsdGeomBasisCurves).
//!
//! One prim for each fabric: linear curves, a width for each point, and `ply`, `fiber` and `curve` (the yarn) as
//! primvars of each curve. A closed run repeats its first point, since one prim cannot hold curves of both kinds.
//! Numbers are f32 in the fewest digits that read back as the same. No materials.

use std::io::{Result, Write};
use std::path::Path;

use glam::Vec3;

use super::error::FileError;
use super::fiber_runs::{FiberGroup, FiberRun, check_runs};
use super::whole::write_whole;

/// How often [`write_usda`] goes over all points.
pub const USDA_PASSES: u64 = 2;

/// Writes fabrics of fibers. `progress` is told points as they are written, each [`USDA_PASSES`] times.
///
/// # Errors
/// Runs that no reader would take; what the file system says.
pub fn write_usda(
    path: &Path,
    groups: &[FiberGroup<'_>],
    progress: &dyn Fn(u64),
) -> std::result::Result<(), FileError> {
    check_runs(path, groups)?;
    write_whole(path, |out| {
        out.write_all(HEADER.as_bytes())?;
        for (index, group) in groups.iter().enumerate() {
            write_group(out, index, group, progress)?;
        }
        writeln!(out, "}}")
    })
}

const HEADER: &str = "#usda 1.0
(
    defaultPrim = \"Fibers\"
    doc = \"Fibers of yarns, written by worsted\"
    metersPerUnit = 0.001
    upAxis = \"Y\"
)

def Xform \"Fibers\" (
    kind = \"component\"
)
{
";

fn write_group(
    out: &mut dyn Write,
    index: usize,
    group: &FiberGroup<'_>,
    progress: &dyn Fn(u64),
) -> Result<()> {
    let runs = &group.runs;
    let (low, high) = extent(runs);
    writeln!(out, "    def BasisCurves \"fabric_{index}\"\n    {{")?;
    writeln!(out, "        uniform token type = \"linear\"")?;
    writeln!(out, "        uniform token wrap = \"nonperiodic\"")?;
    writeln!(out, "        float3[] extent = [{}, {}]", Tuple(low), Tuple(high))?;
    let count = |out: &mut dyn Write, run: &FiberRun<'_>| write!(out, "{}", closed(run, run.points).count());
    array(out, "int[] curveVertexCounts", None, runs, count)?;
    array(out, "point3f[] points", None, runs, |out, run| {
        progress(run.points.len() as u64);
        list(out, closed(run, run.points).map(|p| Tuple(p.as_vec3())))
    })?;
    array(out, "float[] widths", Some("vertex"), runs, |out, run| {
        progress(run.points.len() as u64);
        list(out, closed(run, run.radii_mm).map(|radius| (2.0 * radius) as f32))
    })?;
    array(out, "int[] primvars:ply", Some("uniform"), runs, |out, run| write!(out, "{}", run.ply))?;
    array(out, "int[] primvars:fiber", Some("uniform"), runs, |out, run| write!(out, "{}", run.fiber))?;
    array(out, "int[] primvars:curve", Some("uniform"), runs, |out, run| write!(out, "{}", run.curve))?;
    writeln!(out, "    }}")
}

/// The values along a run, the first again where it is closed.
fn closed<'a, T: Copy>(run: &FiberRun<'_>, values: &'a [T]) -> impl Iterator<Item = T> + 'a {
    let again = if run.closed { &values[..values.len().min(1)] } else { &[] };
    values.iter().chain(again).copied()
}

/// An attribute that is an array, a line for each run.
fn array(
    out: &mut dyn Write,
    name: &str,
    interpolation: Option<&str>,
    runs: &[FiberRun<'_>],
    write: impl Fn(&mut dyn Write, &FiberRun<'_>) -> Result<()>,
) -> Result<()> {
    write!(out, "        {name} = [")?;
    for (index, run) in runs.iter().enumerate() {
        write!(out, "{}            ", if index == 0 { "\n" } else { ",\n" })?;
        write(out, run)?;
    }
    write!(out, "\n        ]")?;
    match interpolation {
        Some(kind) => writeln!(out, " (\n            interpolation = \"{kind}\"\n        )"),
        None => writeln!(out),
    }
}

fn list(out: &mut dyn Write, values: impl Iterator<Item = impl std::fmt::Display>) -> Result<()> {
    for (index, value) in values.enumerate() {
        write!(out, "{}{value}", if index == 0 { "" } else { ", " })?;
    }
    Ok(())
}

struct Tuple(Vec3);

impl std::fmt::Display for Tuple {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "({}, {}, {})", self.0.x, self.0.y, self.0.z)
    }
}

/// Corners of a box around the fibers' surfaces.
fn extent(runs: &[FiberRun<'_>]) -> (Vec3, Vec3) {
    let places = runs.iter().flat_map(|run| run.points.iter().zip(run.radii_mm));
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = places.fold(start, |(low, high), (p, &radius)| {
        let (p, radius) = (p.as_vec3(), Vec3::splat(radius as f32));
        (low.min(p - radius), high.max(p + radius))
    });
    // A fabric without fibers has no box; infinities would be no numbers in the file.
    if low.is_finite() && high.is_finite() { (low, high) } else { (Vec3::ZERO, Vec3::ZERO) }
}

#[cfg(test)]
#[path = "fiber_usda_tests.rs"]
mod tests;
