//! The layers of a picture, and for their motion where yarns are one picture earlier and one later.

use super::{Picture, Renderer, run, upload};
use crate::gpu_types::Frame;
use crate::io::error::FileError;
use crate::io::layers::Layers;
use crate::motion::mover::Mover;
use crate::motion::pose::Pose;
use crate::scene::camera::Camera;
use crate::vulkan::{ImageState, Taken, VulkanError};
use glam::DVec2;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// Poses of one mover that are kept: a frame's, and those beside it.
const HELD: usize = 3;

/// Works out poses beside those of the frames that are asked for. In sequence each is worked out once.
pub(super) struct Neighbours {
    step: f64,
    /// For each mover times, by their bits, and poses; the latest at the end.
    held: Vec<Vec<(u64, Arc<Pose>)>>,
}

impl Neighbours {
    /// Those `step` frames before and after.
    pub(super) fn new(step: f64) -> Self {
        Self { step, held: Vec::new() }
    }

    /// The poses of the `index`-th mover before a frame, in it and after it.
    ///
    /// # Errors
    /// As [`Mover::pose_at`].
    pub(super) fn poses(
        &mut self,
        index: usize,
        mover: &mut Mover,
        frame: f64,
    ) -> Result<[Arc<Pose>; 3], FileError> {
        if self.held.len() <= index {
            self.held.resize_with(index + 1, Vec::new);
        }
        let times = [mover.time_beside(frame, -self.step), frame, mover.time_beside(frame, self.step)];
        let held = &mut self.held[index];
        let mut pose = |time: f64| -> Result<Arc<Pose>, FileError> {
            if let Some((_, pose)) = held.iter().find(|(bits, _)| *bits == time.to_bits()) {
                return Ok(pose.clone());
            }
            let found = Arc::new(mover.pose_at(time)?);
            held.push((time.to_bits(), found.clone()));
            Ok(found)
        };
        let poses = [pose(times[0])?, pose(times[1])?, pose(times[2])?];
        held.drain(..held.len().saturating_sub(HELD));
        Ok(poses)
    }
}

impl Renderer {
    /// Draws the layers of the picture that is planned, where there are any.
    ///
    /// # Errors
    /// Those of the device.
    pub(super) fn draw_layers(
        &mut self,
        camera: &Camera,
        mut timings: Option<&mut HashMap<&'static str, Duration>>,
    ) -> Result<Taken, VulkanError> {
        let mut taken = Taken::NOTHING;
        let Some(layers) = &self.layers else { return Ok(taken) };
        // As the picture's first frame but that it looks at the centres of pixels; no light is read.
        let frame = upload::frame(&self.scene, camera, (&self.environment, 1.0), &self.request, 0);
        let clip_from_world = upload::columns(camera.clip_from_world(self.request.size, DVec2::ZERO));
        self.frame.write(0, &[Frame { clip_from_world, ..frame }])?;
        let parts = layers.parts(self.scene.file.quality.curves_per_submission);
        for part in 0..parts {
            let pass = layers.pass(part, parts);
            taken += run(&mut self.graph, &self.device, &[pass], timings.as_deref_mut())?;
        }
        Ok(taken)
    }

    /// The picture that was drawn.
    ///
    /// # Errors
    /// Those of the device.
    pub(super) fn read_picture(&self) -> Result<Picture, VulkanError> {
        Ok(Picture {
            size: self.request.size,
            linear: self.targets.picture.read(ImageState::STORAGE_COMPUTE)?,
            display: self.targets.display.read(ImageState::STORAGE_COMPUTE)?,
            layers: self.read_layers()?,
        })
    }

    fn read_layers(&self) -> Result<Option<Layers>, VulkanError> {
        let Some(pass) = &self.layers else { return Ok(None) };
        let [x, y] = self.request.size.map(|side| 0.5 * side as f32);
        // From halves of the picture's sides, y down, to pixels, y up. Adding 0 leaves no -0.
        let pixels = |[bx, by, fx, fy]: [f32; 4]| [bx * x, -by * y, fx * x, -fy * y].map(|value| value + 0.0);
        let motion = pass.read_motion()?;
        let motion = motion.map(|motion| motion.into_iter().map(pixels).collect());
        Ok(Some(Layers { motion, ids: pass.read_ids()? }))
    }
}
