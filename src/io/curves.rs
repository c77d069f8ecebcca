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
