//! What a scene file says, and the fabrics, camera and features that follow from it.

pub mod animation;
pub mod camera;
pub mod effective;
pub mod fabric;
pub mod features;
pub mod fiber_table;
pub mod file;
pub mod keys;
pub mod light;
pub mod light_reach;
pub mod load;
pub mod models;
pub mod motion;
pub mod needs;
pub mod overrides;
pub mod parameters;
pub mod shadow;
pub mod shadow_light;
pub mod tables;
pub mod yarn_table;

use crate::io::error::{FileError, plain};
use crate::io::picture::LinearImage;
use crate::knit::error::KnitError;
use camera::Camera;
pub use fabric::Fabric;
use file::CameraTable;
pub use file::SceneFile;
use glam::DVec3;
use std::sync::Arc;

/// Why a scene cannot be had; each is one line.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A file is missing, unreadable or wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// Fabric that cannot be knitted.
    #[error(transparent)]
    Knit(#[from] KnitError),
    /// Anything else the scene file says that cannot be.
    #[error("{scene}: {}", plain(message))]
    Value {
        /// The scene or yarn file.
        scene: String,
        /// The key, what was expected and what was found.
        message: String,
    },
}

/// A scene with its fabrics loaded: lengths in mm, world space Y up.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What the file said, with defaults filled in.
    pub file: SceneFile,
    /// Its fabrics; at least one.
    pub fabrics: Vec<Fabric>,
    /// Centre of everything, or where fabrics lie far apart, what the camera looked at when it was loaded. Positions
    /// go to the device relative to it, so that a model far from the file's origin keeps its digits.
    pub origin_mm: DVec3,
    /// The picture of the light from everywhere, if the file names one that gives light.
    pub environment: Option<Arc<LinearImage>>,
}

impl Scene {
    /// The camera that the scene asks for, for a picture of `size` pixels.
    pub fn camera(&self, size: [u32; 2]) -> Camera {
        Camera::new(&self.file.camera, size, self.origin_mm, self.hull_points(), self.thickest_mm())
    }

    /// The table of the same camera with nothing left to be fitted.
    pub fn fitted_camera(&self, size: [u32; 2]) -> CameraTable {
        Camera::fitted(&self.file.camera, size, self.origin_mm, self.hull_points(), self.thickest_mm())
    }

    /// Positions that the picture must hold, relative to the origin.
    pub fn hull_points(&self) -> impl Iterator<Item = DVec3> + Clone {
        let origin = self.origin_mm;
        self.fabrics.iter().flat_map(Fabric::hull_points).map(move |p| p - origin)
    }

    /// The largest outer radius of its yarns, in mm.
    pub fn thickest_mm(&self) -> f64 {
        self.fabrics.iter().map(|f| f.yarn.outer_radius_mm()).fold(0.0, f64::max)
    }
}
