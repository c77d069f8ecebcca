//! Fabrics that move, put where they are at any time. What comes out depends on the time alone, not on what was asked for
//! before.

use super::pose::{Pose, RestPose};
use crate::io::error::{FileError, Place};
use crate::io::frames::FrameSource;
use crate::math::curve::{Basis, curve_point};
use crate::scene::animation::{AnimationTable, Interpolation};
use crate::scene::camera::Camera;
use crate::scene::motion::Motion;
use crate::scene::{Fabric, Scene, SceneError};
use glam::DVec3;
use std::sync::Arc;

/// Frames of a fabric that are held at once: what lies between two frames takes up to four.
const HELD: usize = 4;
/// Frames that a camera is fitted to, first and last among them.
const FITTED: u64 = 5;

/// One fabric that moves.
pub struct Mover {
    /// Its place among the scene's.
    pub fabric: usize,
    motion: Motion,
    source: FrameSource,
    rest: RestPose,
    interpolation: Interpolation,
    repeat: bool,
    /// Frames that were read last, the latest at the end, in mm.
    held: Vec<(u64, Arc<Vec<DVec3>>)>,
}

impl Mover {
    fn new(
        index: usize,
        fabric: &Fabric,
        motion: &Motion,
        animation: &AnimationTable,
    ) -> Result<Self, SceneError> {
        let unplaced = || {
            let message = "expected every point of the model to be on a yarn, to be moved by frames, found some that are not";
            SceneError::File(FileError::new(&motion.path, Place::File, message))
        };
        Ok(Self {
            fabric: index,
            source: motion.open()?,
            motion: motion.clone(),
            rest: RestPose::new(&fabric.strands).ok_or_else(unplaced)?,
            interpolation: animation.interpolation,
            repeat: animation.repeat,
            held: Vec::new(),
        })
    }

    /// Frames of its motion.
    pub fn frame_count(&self) -> u64 {
        self.source.count()
    }

    /// Where its frames come from.
    pub fn source(&self) -> &FrameSource {
        &self.source
    }

    /// The fabric at rest.
    pub fn rest(&self) -> &RestPose {
        &self.rest
    }

    /// Control points in mm at a time in frames, in the order of the model's that are kept.
    ///
    /// # Errors
    /// A time behind the last frame, unless motions repeat; a frame that cannot be read or is of another model.
    pub fn given_at(&mut self, frame: f64) -> Result<Vec<DVec3>, FileError> {
        let (before, share) = (frame.floor(), frame - frame.floor());
        let before = before as u64;
        let last = self.frame_count() - 1;
        if !self.repeat && (before > last || before == last && share > 0.0) {
            let message = format!(
                "expected a frame of 0 to {last}, found {frame}: animation.repeat = true begins again"
            );
            return Err(FileError::new(&self.motion.path, Place::Frame(before), message));
        }
        if share == 0.0 {
            return Ok(self.frame(before)?.to_vec());
        }
        let (from, to) = (self.frame(before)?, self.frame(before + 1)?);
        if self.interpolation == Interpolation::Linear {
            return Ok(from.iter().zip(&*to).map(|(from, to)| from.lerp(*to, share)).collect());
        }
        // Outside of all frames as at a yarn's end: reflected.
        let first = self.repeat || before > 0;
        let ahead = self.repeat || before + 1 < last;
        let earlier = if first { self.frame(self.earlier(before))? } else { reflected(&from, &to) };
        let later = if ahead { self.frame(before + 2)? } else { reflected(&to, &from) };
        let at = |i: usize| {
            curve_point(&[earlier[i], from[i], to[i], later[i]], Basis::CatmullRom, share).position
        };
        Ok((0..from.len()).map(at).collect())
    }

    /// Its pose at that time: of [`Self::given_at`] alone.
    ///
    /// # Errors
    /// As [`Self::given_at`].
    pub fn pose_at(&mut self, frame: f64) -> Result<Pose, FileError> {
        let given = self.given_at(frame)?;
        let (expected, found) = (self.rest.given_count(), given.len());
        self.rest.pose(&given).ok_or_else(|| {
            let message = format!("expected {expected} points, found {found}");
            FileError::new(&self.motion.path, Place::Frame(frame as u64), message)
        })
    }

    /// The time `step` frames from one at which the motion can be seen: those that repeat go around, others stay where they
    /// begin and end.
    pub fn time_beside(&self, frame: f64, step: f64) -> f64 {
        let (time, count) = (frame + step, self.frame_count() as f64);
        match self.repeat {
            true if time < 0.0 => time.rem_euclid(count),
            true => time,
            false => time.clamp(0.0, count - 1.0),
        }
    }

    /// The frame before one, where motions repeat.
    fn earlier(&self, frame: u64) -> u64 {
        frame.checked_sub(1).unwrap_or(self.frame_count() - 1)
    }

    fn frame(&mut self, frame: u64) -> Result<Arc<Vec<DVec3>>, FileError> {
        let frame = if self.repeat { frame % self.frame_count() } else { frame };
        let found = self.held.iter().position(|(held, _)| *held == frame);
        let entry = match found {
            Some(place) => self.held.remove(place),
            None => {
                if self.held.len() == HELD {
                    self.held.remove(0);
                }
                (frame, Arc::new(self.motion.place(&self.source.read(frame)?)))
            }
        };
        let points = entry.1.clone();
        self.held.push(entry);
        Ok(points)
    }
}

/// `from` reflected, away from `next`.
fn reflected(from: &[DVec3], next: &[DVec3]) -> Arc<Vec<DVec3>> {
    Arc::new(from.iter().zip(next).map(|(from, next)| 2.0 * *from - *next).collect())
}

/// All fabrics of a scene that move.
#[derive(Default)]
pub struct Movers(pub Vec<Mover>);

impl Movers {
    /// Those of a scene as it was loaded: at rest.
    ///
    /// # Errors
    /// Frames that cannot be opened or are of other models.
    pub fn open(scene: &Scene) -> Result<Self, SceneError> {
        let moving = scene
            .fabrics
            .iter()
            .enumerate()
            .filter_map(|(index, fabric)| Some((index, fabric, fabric.motion.as_ref()?)));
        let mover = |(index, fabric, motion)| Mover::new(index, fabric, motion, &scene.file.animation);
        moving.map(mover).collect::<Result<_, _>>().map(Self)
    }

    /// Frames that all of them have; none where nothing moves.
    pub fn frame_count(&self) -> Option<u64> {
        self.0.iter().map(Mover::frame_count).min()
    }

    /// Fixes a camera that is fitted to the cloth where it sees the first frame, the last, and some between whole, so that
    /// it stays there whatever is shown. `size` is the picture's, in pixels.
    ///
    /// # Errors
    /// Frames that cannot be read.
    pub fn fix_camera(&mut self, scene: &mut Scene, size: [u32; 2]) -> Result<(), SceneError> {
        let Some(count) = self.frame_count() else { return Ok(()) };
        let resting = scene.fabrics.iter().filter(|fabric| fabric.motion.is_none());
        let mut points: Vec<DVec3> = resting.flat_map(Fabric::hull_points).collect();
        let mut frames: Vec<u64> = (0..FITTED).map(|k| k * (count - 1) / (FITTED - 1)).collect();
        frames.dedup();
        for mover in &mut self.0 {
            for frame in &frames {
                points.extend(mover.given_at(*frame as f64)?);
            }
        }
        let origin = scene.origin_mm;
        let around = points.iter().map(|p| *p - origin);
        let radius_mm = scene.thickest_mm();
        scene.file.camera = Camera::fitted(&scene.file.camera, size, origin, around, radius_mm);
        Ok(())
    }

    /// Puts the fabrics of a scene where they are at a time, in place: for what reads a scene as it stands.
    ///
    /// # Errors
    /// As [`Mover::given_at`].
    pub fn put(&mut self, scene: &mut Scene, frame: f64) -> Result<(), SceneError> {
        for mover in &mut self.0 {
            let pose = mover.pose_at(frame)?;
            let strands = &mut scene.fabrics[mover.fabric].strands;
            (strands.points, strands.normals) = (pose.points, pose.normals);
        }
        Ok(())
    }
}
