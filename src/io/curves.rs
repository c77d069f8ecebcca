//! Yarn centre lines as plain data, in the file's own units and axes.

pub use crate::math::curve::{Basis, Curve};

/// The axis of the file that points away from the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UpAxis {
    /// X up.
    X,
    /// Y up: the renderer's own convention.
    Y,
    /// Z up.
    Z,
}

/// Everything a yarn file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveSet {
    /// How every curve of the set is to be read.
    pub basis: Basis,
    /// The up axis where the file states one.
    pub up_axis: Option<UpAxis>,
    /// The yarns.
    pub curves: Vec<Curve>,
}

impl CurveSet {
    /// Number of control points of all curves together.
    pub fn point_count(&self) -> usize {
        self.curves.iter().map(|c| c.points.len()).sum()
    }
}

/// How many points each curve of a file has, and whether it is closed: what all frames of a motion must share.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CurveLayout(Vec<(usize, bool)>);

impl CurveLayout {
    /// Of curves of so many points each, closed or not.
    pub fn new(curves: impl Iterator<Item = (usize, bool)>) -> Self {
        Self(curves.collect())
    }

    /// That of some curves.
    pub fn of(set: &CurveSet) -> Self {
        Self::new(set.curves.iter().map(|curve| (curve.points.len(), curve.closed)))
    }

    /// Points of all curves together.
    pub fn point_count(&self) -> usize {
        self.0.iter().map(|(points, _)| points).sum()
    }

    /// One line that says how `other` is not the same, if it is not.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let (expected, found) = (self.0.len(), other.0.len());
        if expected != found {
            return Some(format!("expected {expected} curves as in the model at rest, found {found}"));
        }
        let mut pairs = self.0.iter().zip(&other.0).enumerate();
        let (curve, (expected, found)) = pairs.find(|(_, (expected, found))| expected != found)?;
        let shown = |(points, closed): (usize, bool)| {
            format!("{points} points, {}", if closed { "closed" } else { "open" })
        };
        let (expected, found) = (shown(*expected), shown(*found));
        Some(format!("curve {curve}: expected {expected} as in the model at rest, found {found}"))
    }
}
