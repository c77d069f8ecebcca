//! Strands whose control points have moved. Everything that follows from rest stays: lengths, turns, fibers. The normals
//! are history-free: the rest normal by the local rotation, and by what then is left between the tangents.

use super::local_rotation::LocalRotations;
use crate::yarn::pose::{PointMap, PointOrigin};
use crate::yarn::strand::Strands;
use crate::yarn::transport::carried_normal;
use glam::{DQuat, DVec3};

/// Where points and normals of some strands are, in the strands' own order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Control points in mm.
    pub points: Vec<DVec3>,
    /// Unit normals of knots; arbitrary at points that are no knot.
    pub normals: Vec<DVec3>,
    /// Unit tangents of knots; +X at points that are no knot.
    pub tangents: Vec<DVec3>,
    /// How the cloth around each point has turned since rest.
    pub rotations: Vec<DQuat>,
}

/// Strands at rest, ready to be put elsewhere.
#[derive(Clone, Debug)]
pub struct RestPose {
    strands: Strands,
    tangents: Vec<DVec3>,
    map: PointMap,
    /// For each given point one of the strands' that lies there: the last, whose tangent is a knot's.
    place_of_given: Vec<usize>,
    local: LocalRotations,
}

impl RestPose {
    /// Of strands as they lie; `None` where some given points are in no piece, as [`PointMap::new`] says.
    pub fn new(strands: &Strands) -> Option<Self> {
        let map = PointMap::new(strands)?;
        let mut place_of_given = vec![None; map.given_count()];
        let inner = knots(strands);
        for (place, origin) in map.origins().iter().enumerate() {
            if let PointOrigin::Given(given) = *origin {
                let found: &mut Option<usize> = &mut place_of_given[given as usize];
                if found.is_none() || inner[place] {
                    *found = Some(place);
                }
            }
        }
        let place_of_given = place_of_given.into_iter().collect::<Option<Vec<usize>>>()?;
        let local = LocalRotations::new(map.given(&strands.points));
        let tangents = strands.knot_tangents();
        Some(Self { strands: strands.clone(), tangents, map, place_of_given, local })
    }

    /// Control points that a pose is given by.
    pub fn given_count(&self) -> usize {
        self.map.given_count()
    }

    /// The pose with the given control points at `given` (mm): a function of these alone. `None` unless there are
    /// [`Self::given_count`].
    pub fn pose(&self, given: &[DVec3]) -> Option<Pose> {
        if given.len() != self.given_count() {
            return None;
        }
        let mut points = Vec::with_capacity(self.strands.points.len());
        self.map.place(given, &mut points);
        let tangents = self.strands.knot_tangents_at(&points);
        let of_given = |index: usize| {
            let place = self.place_of_given[index];
            [self.tangents[place], tangents[place]]
        };
        let of_given = self.local.rotations(given, of_given);
        let rotation = |origin: &PointOrigin| match *origin {
            PointOrigin::Given(index) | PointOrigin::Reflected { end: index, .. } => of_given[index as usize],
        };
        let rotations: Vec<DQuat> = self.map.origins().iter().map(rotation).collect();
        let normal = |place: usize| {
            let turned = rotations[place] * self.strands.normals[place];
            // What the cloth has taken along, the rest of the way from the tangent that it has taken along to the yarn's own.
            carried_normal(rotations[place] * self.tangents[place], tangents[place], turned)
        };
        let normals = (0..points.len()).map(normal).collect();
        Some(Pose { points, normals, tangents, rotations })
    }
}

/// Which of the strands' points carry a normal.
pub fn knots(strands: &Strands) -> Vec<bool> {
    let mut knots = vec![false; strands.points.len()];
    for piece in &strands.pieces {
        for offset in strands.knot_offsets() {
            knots[piece.first_point + offset] = true;
        }
    }
    knots
}
