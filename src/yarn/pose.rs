//! Where the control points of ready strands come from, so that they can be put elsewhere: rest lengths, turns and
//! everything else that follows from the rest pose stays.

use super::strand::Strands;
use crate::math::curve::Basis;
use glam::DVec3;

/// What a point of [`Strands::points`] is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointOrigin {
    /// The control point of that index among all that were given, curve by curve.
    Given(u32),
    /// A phantom point: `end` reflected, away from `next`.
    Reflected {
        /// Index of the curve's end.
        end: u32,
        /// Index of the point beside it.
        next: u32,
    },
}

/// The origin of every point of some strands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PointMap {
    origins: Vec<PointOrigin>,
    given_count: usize,
}

impl PointMap {
    /// That of `strands`, or `None` where some given points are in no piece, so that they cannot be counted: a curve
    /// of one point, or a Bezier curve with points left over.
    pub fn new(strands: &Strands) -> Option<Self> {
        let mut origins = Vec::with_capacity(strands.points.len());
        let mut given = 0u32;
        for (pieces, closed) in pieces_of_curves(strands)?.into_iter().zip(&strands.closed) {
            let count = match (strands.basis, closed) {
                (Basis::Bezier, true) => 3 * pieces,
                (Basis::Bezier, false) => 3 * pieces + 1,
                (_, true) => pieces,
                (_, false) => pieces + 1,
            };
            let end = given.checked_add(count)?;
            let all = (given..end).map(PointOrigin::Given);
            let (first, last) = (PointOrigin::Given(given), PointOrigin::Given(end - 1));
            match (strands.basis, closed) {
                (Basis::Bezier, closed) => origins.extend(all.chain(closed.then_some(first))),
                (_, true) => {
                    let second = PointOrigin::Given(given + 1 % count);
                    origins.extend([last].into_iter().chain(all).chain([first, second]));
                }
                (_, false) => {
                    let before = PointOrigin::Reflected { end: given, next: given + 1 };
                    let after = PointOrigin::Reflected { end: end - 1, next: end - 2 };
                    origins.extend([before].into_iter().chain(all).chain([after]));
                }
            }
            given = end;
        }
        let complete = origins.len() == strands.points.len() && given as usize == strands.control_point_count;
        complete.then_some(Self { origins, given_count: given as usize })
    }

    /// Control points as given.
    pub fn given_count(&self) -> usize {
        self.given_count
    }

    /// One for each point of the strands.
    pub fn origins(&self) -> &[PointOrigin] {
        &self.origins
    }

    /// Fills `points` with those of the strands whose given control points lie at `given`, of which there must be
    /// [`Self::given_count`].
    pub fn place(&self, given: &[DVec3], points: &mut Vec<DVec3>) {
        points.clear();
        points.extend(self.origins.iter().map(|origin| match *origin {
            PointOrigin::Given(index) => given[index as usize],
            PointOrigin::Reflected { end, next } => 2.0 * given[end as usize] - given[next as usize],
        }));
    }

    /// The given points among the strands' own.
    pub fn given(&self, points: &[DVec3]) -> Vec<DVec3> {
        let mut given = vec![DVec3::ZERO; self.given_count];
        for (origin, point) in self.origins.iter().zip(points) {
            if let PointOrigin::Given(index) = origin {
                given[*index as usize] = *point;
            }
        }
        given
    }
}

/// Pieces of every curve; `None` where a curve has none.
fn pieces_of_curves(strands: &Strands) -> Option<Vec<u32>> {
    let mut counts = vec![0u32; strands.closed.len()];
    for piece in &strands.pieces {
        counts[piece.curve] += 1;
    }
    counts.iter().all(|count| *count > 0).then_some(counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::curve::Curve;
    use crate::math::rng::Rng;
    use crate::yarn::presets;
    use crate::yarn::strand::strands;

    fn curves(counts: &[(usize, bool)], seed: u64) -> Vec<Curve> {
        let mut rng = Rng::new(seed, &[]);
        let mut point = || DVec3::from_array(std::array::from_fn(|_| rng.uniform()));
        counts
            .iter()
            .map(|&(count, closed)| Curve { points: (0..count).map(|_| point()).collect(), closed })
            .collect()
    }

    #[test]
    fn points_put_elsewhere_are_those_of_strands_made_there() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let shapes = [(2, false), (3, true), (7, false), (6, true)];
        let bezier = [(4, false), (3, true), (7, false), (6, true)];
        for (basis, shape) in [
            (Basis::CatmullRom, shapes),
            (Basis::BSpline, shapes),
            (Basis::Polyline, shapes),
            (Basis::Bezier, bezier),
        ] {
            let rest = strands(&curves(&shape, 1), basis, &yarn, 0);
            let elsewhere = curves(&shape, 2);
            let expected = strands(&elsewhere, basis, &yarn, 0);
            let map = PointMap::new(&rest).unwrap();
            let given: Vec<DVec3> = elsewhere.iter().flat_map(|curve| curve.points.clone()).collect();
            assert_eq!(map.given_count(), given.len());
            let mut points = Vec::new();
            map.place(&given, &mut points);
            assert_eq!(points, expected.points, "{basis:?}");
            assert_eq!(map.given(&points), given, "{basis:?}");
        }
    }

    #[test]
    fn points_in_no_piece_are_refused() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let map = |shape, basis| PointMap::new(&strands(&curves(&[shape], 1), basis, &yarn, 0));
        assert!(map((1, false), Basis::CatmullRom).is_none());
        assert!(map((6, false), Basis::Bezier).is_none());
        assert!(map((7, false), Basis::Bezier).is_some());
    }
}
