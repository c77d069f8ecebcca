//! Realised fibers as the tracer keeps them: points in a row, whose number says where on which fiber one is.

use super::cone::{RoundedCone, enter};
use super::fibers::RealisedFiber;
use crate::math::frame::{direction_or, normal_perpendicular_to};
use glam::DVec3;

/// What coordinates are stored as; all arithmetic is in f64.
pub trait Stored: Copy + Send + Sync + Into<f64> {
    /// The nearest that can be stored.
    fn of(value: f64) -> Self;
}

impl Stored for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }
}

impl Stored for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

/// One unbroken fiber.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Run {
    first_point: u32,
    /// Points, the repeated first one of a closed run included.
    point_count: u32,
    fabric: u32,
    closed: bool,
}

/// A place on a fiber's axis: on the piece from point `point` to the next, `share` of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Number of the piece's first point.
    pub point: u32,
    /// 0 to 1.
    pub share: f64,
}

impl Place {
    fn number(self) -> f64 {
        f64::from(self.point) + self.share
    }
}

/// What a ray does not see of the fiber that it starts on, as up to two ranges of point numbers: a closed fiber's
/// may lie on both sides of its closing point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ignored([[f64; 2]; 2]);

impl Ignored {
    /// Nothing.
    pub const NONE: Self = Self([[0.0, -1.0]; 2]);

    /// Whether a ray goes on through this place.
    pub fn holds(&self, place: Place) -> bool {
        let number = place.number();
        self.0.iter().any(|range| (range[0]..=range[1]).contains(&number))
    }
}

/// What a fiber is where a ray met it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiberSurface {
    /// Index of the fabric.
    pub fabric: usize,
    /// The fiber's unit direction.
    pub tangent: DVec3,
    /// The round fiber's unit normal, perpendicular to the tangent.
    pub normal: DVec3,
}

/// All fibers of a scene, in mm relative to the scene's origin.
pub struct FiberGeometry<T> {
    /// Centre and radius.
    points: Vec<[T; 4]>,
    tangents: Vec<[T; 3]>,
    runs: Vec<Run>,
}

fn stored<T: Stored, const N: usize>(values: [f64; N]) -> [T; N] {
    values.map(T::of)
}

impl<T: Stored> FiberGeometry<T> {
    /// Packs fibers around `origin_mm`.
    pub fn new(fibers: Vec<RealisedFiber>, origin_mm: DVec3) -> Self {
        let count = fibers.iter().map(|fiber| fiber.points.len() + usize::from(fiber.closed)).sum();
        let mut all = Self {
            points: Vec::with_capacity(count),
            tangents: Vec::with_capacity(count),
            runs: Vec::with_capacity(fibers.len()),
        };
        // One by one, so that what is packed is freed.
        for fiber in fibers {
            let first_point = all.points.len() as u32;
            let closing = fiber.closed.then_some(0);
            for k in (0..fiber.points.len()).chain(closing) {
                all.points.push(stored((fiber.points[k] - origin_mm).extend(fiber.radii_mm[k]).to_array()));
                all.tangents.push(stored(fiber.tangents[k].to_array()));
            }
            all.runs.push(Run {
                first_point,
                point_count: all.points.len() as u32 - first_point,
                fabric: fiber.fabric as u32,
                closed: fiber.closed,
            });
        }
        all
    }

    /// First points of all pieces.
    pub fn pieces(&self) -> impl Iterator<Item = u32> + '_ {
        self.runs
            .iter()
            .flat_map(|run| run.first_point..(run.first_point + run.point_count).saturating_sub(1))
    }

    /// Unbroken fibers.
    pub fn run_count(&self) -> usize {
        self.runs.len()
    }

    /// Straight pieces of them.
    pub fn piece_count(&self) -> usize {
        self.points.len() - self.runs.len()
    }

    /// Memory taken.
    pub fn bytes(&self) -> usize {
        self.points.len() * (size_of::<[T; 4]>() + size_of::<[T; 3]>()) + self.runs.len() * size_of::<Run>()
    }

    fn center(&self, point: u32) -> DVec3 {
        let [x, y, z, _] = self.points[point as usize];
        DVec3::new(x.into(), y.into(), z.into())
    }

    fn tangent(&self, point: u32) -> DVec3 {
        DVec3::from_array(self.tangents[point as usize].map(Into::into))
    }

    /// The piece that begins at this point.
    pub fn piece(&self, point: u32) -> RoundedCone {
        let radius = |point: u32| self.points[point as usize][3].into();
        RoundedCone {
            ends: [self.center(point), self.center(point + 1)],
            radii: [radius(point), radius(point + 1)],
        }
    }

    /// Where a ray enters the piece, if it does so ahead of its origin.
    pub fn enter(&self, point: u32, origin: DVec3, direction: DVec3) -> Option<(f64, Place)> {
        let cone = self.piece(point);
        let t = enter(&cone, origin, direction).filter(|t| *t > 0.0)?;
        let axis = cone.ends[1] - cone.ends[0];
        let along = (origin + t * direction - cone.ends[0]).dot(axis) / axis.length_squared();
        Some((t, Place { point, share: along.clamp(0.0, 1.0) }))
    }

    /// The fiber where a ray met it at `position`. Directions are interpolated along the piece, so that no corner
    /// between pieces is seen.
    pub fn surface(&self, place: Place, position: DVec3) -> FiberSurface {
        let Place { point, share } = place;
        let (from, to) = (self.tangent(point), self.tangent(point + 1));
        let chord = direction_or(self.center(point + 1) - self.center(point), from);
        let tangent = direction_or(from.lerp(to, share), chord);
        let center = self.center(point).lerp(self.center(point + 1), share);
        let normal = normal_perpendicular_to(tangent, direction_or(position - center, chord));
        FiberSurface { fabric: self.runs[self.run_of(point)].fabric as usize, tangent, normal }
    }

    fn run_of(&self, point: u32) -> usize {
        self.runs.partition_point(|run| run.first_point <= point).saturating_sub(1)
    }

    /// The part of the fiber within `distance_mm` of a place along its axis, both ways.
    pub fn around(&self, place: Place, distance_mm: f64) -> Ignored {
        let run = self.runs[self.run_of(place.point)];
        let [first, last] = [run.first_point, run.first_point + run.point_count - 1];
        let (low, rest_low) = self.walk_back(place, distance_mm, first);
        let (high, rest_high) = self.walk_on(place, distance_mm, last);
        let mut ranges = [[low, high], [0.0, -1.0]];
        if run.closed && rest_low > 0.0 {
            let end = Place { point: last - 1, share: 1.0 };
            ranges[1] = [self.walk_back(end, rest_low, first).0, f64::from(last)];
        } else if run.closed && rest_high > 0.0 {
            let start = Place { point: first, share: 0.0 };
            ranges[1] = [f64::from(first), self.walk_on(start, rest_high, last).0];
        }
        Ignored(ranges)
    }

    fn piece_length(&self, point: u32) -> f64 {
        self.center(point).distance(self.center(point + 1))
    }

    /// Point number `distance` mm before a place, not before the point `first`; and what is left of the distance.
    fn walk_back(&self, place: Place, mut distance: f64, first: u32) -> (f64, f64) {
        let Place { mut point, mut share } = place;
        loop {
            let length = self.piece_length(point);
            if distance <= share * length {
                return (f64::from(point) + share - distance / length.max(f64::MIN_POSITIVE), 0.0);
            }
            distance -= share * length;
            if point == first {
                return (f64::from(first), distance);
            }
            (point, share) = (point - 1, 1.0);
        }
    }

    /// The same after a place, not after the point `last`.
    fn walk_on(&self, place: Place, mut distance: f64, last: u32) -> (f64, f64) {
        let Place { mut point, mut share } = place;
        loop {
            let length = self.piece_length(point);
            if distance <= (1.0 - share) * length {
                return (f64::from(point) + share + distance / length.max(f64::MIN_POSITIVE), 0.0);
            }
            distance -= (1.0 - share) * length;
            if point + 1 == last {
                return (f64::from(last), distance);
            }
            (point, share) = (point + 1, 0.0);
        }
    }
}

#[cfg(test)]
#[path = "geometry_tests.rs"]
mod tests;
