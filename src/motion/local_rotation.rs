//! How the cloth around a control point has turned since rest, from where its neighbours are alone: no history, so
//! that a frame is the same however it was reached.
//!
//! The rotation is the orthogonal factor of sum of w (moved - moved_0) (rest - rest_0)^T over the nearest points at
//! rest, of other strands too. Where these lie along a line the turn about it is not in them: then the sums over ever
//! coarser neighbourhoods, weighted ever less, decide, and last the turn of the point's own tangent. Each sum of a rigid
//! motion is that motion times a symmetric matrix, and so is their total: a rigid motion is found exactly.

use crate::math::rotation::{nearest_rotation, outer};
use glam::{DMat3, DQuat, DVec3};
use kiddo::SquaredEuclidean;
use kiddo::immutable::float::kdtree::ImmutableKdTree;
use rayon::prelude::*;
use std::num::NonZeroUsize;

/// Points around a place that have a say in its rotation.
pub const NEIGHBOURS: usize = 24;
/// One in so many points stands for the cloth at large.
const ANCHOR_STRIDE: usize = 16;
/// Anchors around a point between which their sums are blended.
const ANCHORS: usize = 4;
/// Weight of the anchors' sums, of the whole fabric's, and of the tangent's turn, against 1 of the neighbours'. With the
/// first, neighbours decide unless they lie within some 3% of their spread of a line.
const COARSE: f64 = 1e-3;
const WHOLE: f64 = 1e-6;
const TANGENT: f64 = 1e-9;

/// Points by their index, each with a weight.
#[derive(Clone, Copy, Debug)]
struct Near<const N: usize> {
    points: [u32; N],
    weights: [f32; N],
}

impl<const N: usize> Near<N> {
    /// The points nearest to `place` in the tree; weights fall smoothly to 0 at the first that is left out, so that
    /// nothing jumps from one place to the next.
    fn new(tree: &ImmutableKdTree<f64, u64, 3, 32>, place: DVec3, size: usize) -> Self {
        let count = NonZeroUsize::MIN.saturating_add(N.min(size - 1));
        let found = tree.nearest_n::<SquaredEuclidean>(&place.to_array(), count);
        let reach = found.last().map_or(0.0, |last| last.distance).max(f64::MIN_POSITIVE);
        // Of fewer points than there are places all count.
        let all = size <= N;
        let mut near = Self { points: [0; N], weights: [0.0; N] };
        for (k, found) in found.iter().take(N).enumerate() {
            let share = if all { 0.0 } else { found.distance / reach };
            near.points[k] = found.item as u32;
            near.weights[k] = ((1.0 - share) * (1.0 - share)) as f32;
        }
        near
    }

    fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.points.iter().zip(&self.weights).map(|(point, weight)| (*point as usize, f64::from(*weight)))
    }
}

/// Neighbourhoods of points at rest.
#[derive(Clone, Debug)]
pub struct LocalRotations {
    rest: Vec<DVec3>,
    near: Vec<Near<NEIGHBOURS>>,
    /// Indices of those points that stand for the cloth at large.
    anchors: Vec<u32>,
    /// Of each anchor, among the anchors.
    near_anchor: Vec<Near<NEIGHBOURS>>,
    /// Of each point, among the anchors; weights add up to 1.
    blend: Vec<Near<ANCHORS>>,
}

impl LocalRotations {
    /// Of points at `rest`, whose order along the yarns says which of them stand for all.
    pub fn new(rest: Vec<DVec3>) -> Self {
        let anchors: Vec<u32> = (0..rest.len() as u32).step_by(ANCHOR_STRIDE).collect();
        let places: Vec<DVec3> = anchors.iter().map(|anchor| rest[*anchor as usize]).collect();
        let near = nearest(&rest, &rest);
        let near_anchor = nearest(&places, &places);
        let mut blend: Vec<Near<ANCHORS>> = nearest(&places, &rest);
        for near in &mut blend {
            let sum: f32 = near.weights.iter().sum();
            // Where all are equally far none has any weight.
            let equal = [1.0 / ANCHORS as f32; ANCHORS];
            near.weights = if sum > 1e-6 { near.weights.map(|weight| weight / sum) } else { equal };
        }
        Self { rest, near, anchors, near_anchor, blend }
    }

    /// Points at rest.
    pub fn point_count(&self) -> usize {
        self.rest.len()
    }

    /// The rotation of every point from rest to `moved`, of which there are as many; `tangents` are a point's unit
    /// tangents at rest and moved.
    pub fn rotations(&self, moved: &[DVec3], tangents: impl Fn(usize) -> [DVec3; 2] + Sync) -> Vec<DQuat> {
        let place = |anchor: usize| self.anchors[anchor] as usize;
        let coarse: Vec<DMat3> = (0..self.anchors.len())
            .into_par_iter()
            .map(|anchor| {
                let near = self.near_anchor[anchor].iter().map(|(other, weight)| (place(other), weight));
                self.sum(moved, place(anchor), near)
            })
            .collect();
        let whole = WHOLE * self.sum(moved, 0, (0..self.anchors.len()).map(|anchor| (place(anchor), 1.0)));
        let of_point = |point: usize| {
            let fine = self.sum(moved, point, self.near[point].iter());
            let blended: DMat3 =
                self.blend[point].iter().map(|(anchor, weight)| coarse[anchor] * weight).sum();
            let [from, to] = tangents(point);
            let turn = DMat3::from_quat(DQuat::from_rotation_arc(from, to));
            nearest_rotation(fine + COARSE * blended + whole + TANGENT * turn)
        };
        (0..self.rest.len()).into_par_iter().map(of_point).collect()
    }

    /// Sum about `center` over weighted points, as a share of what it is at rest: size and weights cancel. The whole
    /// where all points coincide is zero.
    fn sum(&self, moved: &[DVec3], center: usize, near: impl Iterator<Item = (usize, f64)>) -> DMat3 {
        let (rest_0, moved_0) = (self.rest[center], moved[center]);
        let mut size = 0.0;
        let sum = near.fold(DMat3::ZERO, |sum, (point, weight)| {
            let rest = self.rest[point] - rest_0;
            size += weight * rest.length_squared();
            sum + outer(weight * (moved[point] - moved_0), rest)
        });
        if size > 0.0 { sum * size.recip() } else { DMat3::ZERO }
    }
}

/// The neighbourhoods of places among `points`.
fn nearest<const N: usize>(points: &[DVec3], places: &[DVec3]) -> Vec<Near<N>> {
    if points.is_empty() {
        return Vec::new();
    }
    let entries: Vec<[f64; 3]> = points.iter().map(|point| point.to_array()).collect();
    let tree = ImmutableKdTree::<f64, u64, 3, 32>::new_from_slice(&entries);
    places.par_iter().map(|place| Near::new(&tree, *place, points.len())).collect()
}
