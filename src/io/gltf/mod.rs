//! glTF 2.0 (`.gltf`, `.glb`): lines as yarns, moved by nodes, morph targets and skins.
//!
//! - LINES, LINE_STRIP and LINE_LOOP primitives, with indices or without, of every node of the default scene. Segments
//!   that meet end to end at the same vertex are one curve. Of a file without lines the edges of its triangles are taken.
//! - Its first animation moves it. What it does between two keys is as the file says: steps, straight, cubic.
//! - Buffers are in the file itself or in files beside it. Lengths are metres, Y is up.
//! - Every index and offset is checked; a hierarchy that is no tree is refused, as is a mesh that so many nodes show that
//!   it has more points than the file has bytes.

mod accessor;
mod animation;
mod buffers;
mod model;
mod shapes;

use super::curves::{Basis, Curve, CurveSet, UpAxis};
use super::error::{FileError, Place, plain};
use super::yarn_file::{Loaded, coordinate_fault};
use buffers::Buffers;
use glam::DVec3;
pub use model::Model;
use std::path::Path;

/// The first bytes of a binary glTF.
pub const GLB_MAGIC: [u8; 4] = *b"glTF";

/// Millimetres in the unit of a glTF.
pub const GLTF_MM_PER_UNIT: f64 = 1000.0;

/// The curves of a glTF at rest, without repairs.
///
/// # Errors
/// One line naming the part at fault; a file without lines and triangles.
pub fn parse_gltf(file: &Path, bytes: &[u8]) -> Result<Loaded, FileError> {
    let model = Model::new(file, bytes)?;
    let points = model.points(None)?;
    let mut rest = &points[..];
    let curves: Vec<Curve> = model
        .curves()
        .map(|(count, closed)| {
            let (curve, after) = rest.split_at(count);
            rest = after;
            Curve { points: curve.to_vec(), closed }
        })
        .collect();
    let set = CurveSet { basis: Basis::Polyline, up_axis: Some(UpAxis::Y), curves };
    let mut loaded = Loaded::of_curves(set, "glTF");
    loaded.notes = model.notes().to_vec();
    loaded.moves = model.duration().is_some();
    loaded.mm_per_unit = Some(GLTF_MM_PER_UNIT);
    Ok(loaded)
}

/// What is wrong with what the crate read, as one short line.
fn shortened(message: &str) -> String {
    const SHOWN: usize = 120;
    plain(message).chars().take(SHOWN).collect()
}

fn checked(file: &Path, place: Place, points: Vec<DVec3>) -> Result<Vec<DVec3>, FileError> {
    match points.iter().find_map(|p| coordinate_fault(*p)) {
        Some(fault) => Err(FileError::new(file, place, fault)),
        None => Ok(points),
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
