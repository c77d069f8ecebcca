//! From the points of a moving fabric's files to mm in world axes.

use crate::io::curves::{CurveLayout, UpAxis};
use crate::io::error::FileError;
use crate::io::frames::FrameSource;
use crate::io::yarn_file::Loaded;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// How a fabric moves: where its frames are, and what its model's file was like.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The file, or the pattern of numbered files.
    pub path: PathBuf,
    layout: CurveLayout,
    kept_points: Option<Vec<usize>>,
    up_axis: UpAxis,
    mm_per_unit: f64,
    /// Frames of a glTF in a second.
    per_second: f64,
}

impl Motion {
    /// Of a model that was loaded at this scale; of a glTF's motion `per_second` frames are a second.
    pub fn new(path: &Path, loaded: &Loaded, mm_per_unit: f64, per_second: f64) -> Self {
        Self {
            path: path.to_owned(),
            layout: loaded.layout.clone(),
            kept_points: loaded.kept_points.clone(),
            up_axis: loaded.curves.up_axis.unwrap_or(UpAxis::Y),
            mm_per_unit,
            per_second,
        }
    }

    /// Opens the frames.
    ///
    /// # Errors
    /// As [`FrameSource::open`].
    pub fn open(&self) -> Result<FrameSource, FileError> {
        FrameSource::open(&self.path, &self.layout, self.per_second)
    }

    /// The fabric's control points in mm, in world axes, where those of the file lie at `points`: as many as the model's
    /// file has. Points that repairs of the model dropped are dropped.
    pub fn place(&self, points: &[DVec3]) -> Vec<DVec3> {
        let world = |p: DVec3| world_from_file(self.up_axis, p) * self.mm_per_unit;
        match &self.kept_points {
            None => points.iter().map(|p| world(*p)).collect(),
            Some(kept) => kept.iter().map(|index| world(points[*index])).collect(),
        }
    }
}

/// A point of a file with that up axis in the world's axes, Y up.
pub fn world_from_file(up: UpAxis, p: DVec3) -> DVec3 {
    match up {
        UpAxis::X => DVec3::new(-p.y, p.x, p.z),
        UpAxis::Y => p,
        UpAxis::Z => DVec3::new(p.x, p.z, -p.y),
    }
}
