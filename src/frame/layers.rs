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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::mover::Movers;
    use crate::scene::Scene;

    /// A yarn of 5 frames.
    fn movers(sets: &[&str]) -> (tempfile::TempDir, Movers) {
        let folder = tempfile::tempdir().unwrap();
        let yarn = "v -6 0 0\nv -2 1 0\nv 2 -1 0\nv 6 0 0\nl 1 2 3 4\n";
        std::fs::write(folder.path().join("yarn.obj"), yarn).unwrap();
        let frames = (0..5).flat_map(|frame| {
            let [x, y] = [frame as f32, 0.1 * frame as f32];
            [-6.0 + x, y, 0.0, -2.0 + x, 1.0, 0.0, 2.0 + x, -1.0, y, 6.0 + x, 0.0, 0.0]
        });
        let bytes: Vec<u8> = frames.flat_map(f32::to_le_bytes).collect();
        std::fs::write(folder.path().join("frames.f32"), bytes).unwrap();
        let motion = format!("fabric.motion={}", folder.path().join("frames.f32").display());
        let sets: Vec<String> =
            [&["fabric.mm_per_unit=1", &motion], sets].concat().iter().map(|s| s.to_string()).collect();
        let movers = Movers::open(&Scene::load(&folder.path().join("yarn.obj"), &sets).unwrap()).unwrap();
        (folder, movers)
    }

    #[test]
    fn poses_are_those_of_their_times_and_in_sequence_none_is_worked_out_twice() {
        let (_folder, mut movers) = movers(&[]);
        let mut neighbours = Neighbours::new(1.0);
        let mover = &mut movers.0[0];
        let mut last: Option<[Arc<Pose>; 3]> = None;
        for frame in 0..5 {
            let found = neighbours.poses(0, mover, f64::from(frame)).unwrap();
            for (pose, time) in found.iter().zip([(frame - 1).max(0), frame, (frame + 1).min(4)]) {
                assert_eq!(**pose, mover.pose_at(f64::from(time)).unwrap(), "frame {frame}");
            }
            if let Some([_, now, after]) = last {
                assert!(Arc::ptr_eq(&now, &found[0]) && Arc::ptr_eq(&after, &found[1]), "frame {frame}");
            }
            assert!(neighbours.held[0].len() <= HELD);
            last = Some(found);
        }
        let elsewhere = neighbours.poses(0, mover, 1.5).unwrap();
        assert_eq!(*elsewhere[0], mover.pose_at(0.5).unwrap());
    }

    #[test]
    fn times_beside_one_keep_to_the_motions_own_rule() {
        let times = |sets: &[&str], frame: f64, step: f64| {
            let (_folder, movers) = movers(sets);
            [-step, step].map(|step| movers.0[0].time_beside(frame, step))
        };
        assert_eq!(times(&[], 0.0, 1.0), [0.0, 1.0]);
        assert_eq!(times(&[], 4.0, 0.5), [3.5, 4.0]);
        assert_eq!(times(&[], 1.0, 9.0), [0.0, 4.0]);
        assert_eq!(times(&["animation.repeat=true"], 0.0, 1.0), [4.0, 1.0]);
        assert_eq!(times(&["animation.repeat=true"], 4.5, 1.0), [3.5, 5.5]);
        assert_eq!(times(&["animation.repeat=true"], 1.0, 12.0), [4.0, 13.0]);
    }
}
