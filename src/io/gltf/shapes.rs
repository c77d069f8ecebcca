//! The lines of a glTF's meshes: which vertices follow one another, and where they are before anything moves.

use super::accessor::Reader;
use crate::io::chains::{Chain, Elements};
use crate::io::error::{FileError, Place};
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};
use std::collections::HashSet;

/// Sets of four joints that a vertex may have.
const JOINT_SETS: u32 = 4;

/// One primitive's lines and all that moves them.
#[derive(Debug)]
pub struct Shape {
    /// Its mesh.
    pub mesh: usize,
    /// Of all vertices.
    pub positions: Vec<[f32; 3]>,
    /// For each morph target what it adds to them at a weight of 1; nothing where it moves none.
    pub targets: Vec<Vec<[f32; 3]>>,
    /// Joints of each vertex and their weights, four at a time; empty without a skin.
    pub joints: Vec<Vec<[u32; 4]>>,
    /// As many.
    pub weights: Vec<Vec<[f32; 4]>>,
    /// Curves through the vertices.
    pub chains: Vec<Chain>,
    /// Vertices where three or more ends meet.
    pub junctions: usize,
}

impl Shape {
    /// Points of all curves.
    pub fn point_count(&self) -> usize {
        self.chains.iter().map(|chain| chain.vertices.len()).sum()
    }

    /// Reads a primitive that has lines, or the edges of its triangles where those are asked for; none of another kind.
    ///
    /// # Errors
    /// What accessors refuse; vertices that are not there.
    pub fn read(
        reader: Reader<'_>,
        mesh: usize,
        primitive: &Primitive<'_>,
        triangles: bool,
    ) -> Result<Option<Self>, FileError> {
        let is_line = matches!(primitive.mode(), Mode::Lines | Mode::LineLoop | Mode::LineStrip);
        let is_face = matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan);
        if !(is_line && !triangles || is_face && triangles) {
            return Ok(None);
        }
        let error = |message: &str| {
            let message = format!("primitive {}: {message}", primitive.index());
            FileError::new(reader.buffers.file, Place::Item("mesh", mesh), message)
        };
        let positions = primitive.get(&Semantic::Positions);
        let positions = positions.ok_or_else(|| error("expected positions, found none"))?;
        if positions.view().is_none() {
            return Err(error("expected positions in a buffer, found none"));
        }
        let positions = reader.floats::<3>(&positions, usize::MAX)?;
        let count = positions.len();
        let order = match primitive.indices() {
            Some(_) if primitive.indices().is_some_and(|a| a.view().is_none()) => {
                return Err(error("expected indices in a buffer, found none"));
            }
            Some(indices) => {
                reader.integers::<1>(&indices, usize::MAX)?.into_iter().map(|[i]| i as usize).collect()
            }
            None => (0..count).collect::<Vec<_>>(),
        };
        if let Some(index) = order.iter().find(|index| **index >= count) {
            return Err(error(&format!("expected an index below {count}, found {index}")));
        }
        let (chains, junctions) = elements(primitive.mode(), &order).chained(count);
        let mut targets = Vec::new();
        for target in primitive.morph_targets() {
            let moved = target.positions().map(|positions| reader.floats::<3>(&positions, count));
            targets.push(moved.transpose()?.unwrap_or_default());
        }
        let (mut joints, mut weights) = (Vec::new(), Vec::new());
        for set in 0..JOINT_SETS {
            let (Some(of), Some(by)) =
                (primitive.get(&Semantic::Joints(set)), primitive.get(&Semantic::Weights(set)))
            else {
                break;
            };
            joints.push(reader.integers::<4>(&of, count)?);
            weights.push(reader.floats::<4>(&by, count)?);
        }
        // A target that moves no positions has none; a vertex without joints would have nowhere to be.
        let of_targets = targets.iter().map(Vec::len).filter(|found| *found != 0);
        let of_skins = joints.iter().map(Vec::len).chain(weights.iter().map(Vec::len));
        if let Some(found) = of_targets.chain(of_skins).find(|found| *found != count) {
            return Err(error(&format!("expected {count} vertices in every attribute, found {found}")));
        }
        Ok(Some(Self { mesh, positions, targets, joints, weights, chains, junctions }))
    }
}

/// The runs of vertices of a primitive's lines or edges; a vertex that repeats the one before starts none.
fn elements(mode: Mode, order: &[usize]) -> Elements {
    let mut elements = Elements::default();
    match mode {
        Mode::Lines => {
            order.chunks_exact(2).filter(|e| e[0] != e[1]).for_each(|e| elements.push([e[0], e[1]]))
        }
        Mode::LineStrip if order.len() >= 2 => elements.push(order.iter().copied()),
        Mode::LineLoop if order.len() >= 2 => elements.push(order.iter().copied().chain([order[0]])),
        Mode::Triangles => edges(order.chunks_exact(3).map(|t| [t[0], t[1], t[2]]), &mut elements),
        Mode::TriangleStrip => edges(order.windows(3).map(|t| [t[0], t[1], t[2]]), &mut elements),
        Mode::TriangleFan if order.len() >= 3 => {
            edges(order[1..].windows(2).map(|t| [order[0], t[0], t[1]]), &mut elements);
        }
        _ => {}
    }
    elements
}

/// Every edge of some triangles once.
fn edges(triangles: impl Iterator<Item = [usize; 3]>, elements: &mut Elements) {
    let mut seen = HashSet::new();
    for [a, b, c] in triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if from != to && seen.insert([from.min(to), from.max(to)]) {
                elements.push([from, to]);
            }
        }
    }
}
