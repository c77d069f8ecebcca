//! Fabrics that move: a thread works out where they are ahead of the pictures, and of each frame the device gets the
//! control points and their skies, nothing else.

use super::Renderer;
use super::cloth::Cloth;
use super::layers::Neighbours;
use super::packing;
use super::tables::Skies;
use super::upload::packed_points;
use crate::gpu_types::ControlPoint;
use crate::motion::mover::Movers;
use crate::motion::pose::Pose;
use crate::passes::fiber_sets::FabricBuffers;
use crate::scene::{Fabric, Scene, SceneError};
use crate::vulkan::{Buffer, VulkanError};
use glam::{DQuat, DVec3};
use half::f16;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Frames that exist at once: one is drawn while the next is worked out.
const SETS: usize = 2;

/// What of a scene moves on the device.
#[derive(Default)]
pub(super) struct Moving {
    parts: Vec<MovingPart>,
    skies: Option<Skies>,
}

/// Buffers of a part of a fabric that moves, and which of the fabric's points they hold.
struct MovingPart {
    fabric: usize,
    points: Range<usize>,
    control_points: Buffer,
    skies: Option<Buffer>,
    /// Where the frames before and after have the points.
    neighbours: Option<[Buffer; 2]>,
}

impl Moving {
    /// Takes note of a fabric's parts as they were uploaded, if it moves.
    pub(super) fn add(
        &mut self,
        index: usize,
        fabric: &Fabric,
        points_per_buffer: usize,
        uploaded: &[(FabricBuffers, u32)],
    ) {
        if fabric.motion.is_none() {
            return;
        }
        let parts = packing::parts(&fabric.strands, points_per_buffer);
        self.parts.extend(parts.into_iter().zip(uploaded).map(|(part, (buffers, _))| MovingPart {
            fabric: index,
            points: part.points,
            control_points: buffers.control_points.clone(),
            skies: buffers.skies.clone(),
            neighbours: buffers.neighbours.clone(),
        }));
    }

    /// Keeps the skies at rest where something moves.
    pub(super) fn keep_skies(&mut self, skies: Option<Skies>) {
        self.skies = skies.filter(|_| !self.parts.is_empty());
    }
}

/// A frame of one fabric in the device's words.
#[derive(Debug, Default)]
struct PosedFabric {
    fabric: usize,
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
    control_points: Vec<ControlPoint>,
    skies: Option<Vec<[f16; 4]>>,
    /// Where it is before and after.
    neighbours: Option<[Vec<ControlPoint>; 2]>,
}

/// A frame of all fabrics that move, ready to be uploaded.
#[derive(Debug, Default)]
pub struct PosedFrame {
    /// Its time in frames.
    pub frame: f64,
    /// How long it took to read and work out, on another thread.
    pub taken: Duration,
    fabrics: Vec<PosedFabric>,
}

impl PosedFrame {
    /// Works a frame out in place of another.
    fn fill(
        &mut self,
        movers: &mut Movers,
        origin_mm: DVec3,
        skies: Option<&Skies>,
        mut neighbours: Option<&mut Neighbours>,
        frame: f64,
    ) -> Result<(), SceneError> {
        let started = Instant::now();
        self.frame = frame;
        self.fabrics.resize_with(movers.0.len(), PosedFabric::default);
        for (index, (mover, fabric)) in movers.0.iter_mut().zip(&mut self.fabrics).enumerate() {
            let packed = |p: &Pose| packed_points(&p.points, &p.normals, &p.tangents, origin_mm);
            let pose = match &mut neighbours {
                None => Arc::new(mover.pose_at(frame)?),
                Some(neighbours) => {
                    let [before, pose, after] = neighbours.poses(index, mover, frame)?;
                    fabric.neighbours = Some([packed(&before), packed(&after)]);
                    pose
                }
            };
            fabric.fabric = mover.fabric;
            fabric.control_points = packed(&pose);
            let of_fabric = skies.map(|skies| &skies[mover.fabric]);
            fabric.skies = of_fabric.map(|skies| turned_skies(skies, &pose.rotations));
            let Pose { points, normals, .. } = Arc::unwrap_or_clone(pose);
            (fabric.points, fabric.normals) = (points, normals);
        }
        self.taken = started.elapsed();
        Ok(())
    }
}

/// Skies that turn with the cloth around each point: what is open of them is the rest's.
pub fn turned_skies(skies: &[[f16; 4]], rotations: &[DQuat]) -> Vec<[f16; 4]> {
    let turned = |(sky, rotation): (&[f16; 4], &DQuat)| {
        let [_, x, y, z] = sky.map(f16::to_f64);
        let slope = *rotation * DVec3::new(x, y, z);
        let [x, y, z] = slope.to_array().map(f16::from_f64);
        [sky[0], x, y, z]
    };
    skies.par_iter().zip(rotations).map(turned).collect()
}

/// Frames worked out ahead, on a thread of their own: never more than two of them exist.
pub struct Poser {
    ready: Option<Receiver<Result<PosedFrame, SceneError>>>,
    empty: Option<SyncSender<PosedFrame>>,
    thread: Option<JoinHandle<Movers>>,
}

impl Poser {
    fn start(
        mut movers: Movers,
        origin_mm: DVec3,
        skies: Option<Skies>,
        mut neighbours: Option<Neighbours>,
        frames: impl Iterator<Item = f64> + Send + 'static,
    ) -> Self {
        let (ready_in, ready) = sync_channel(SETS);
        let (empty, empty_out) = sync_channel::<PosedFrame>(SETS);
        for _ in 0..SETS {
            // There is room for all of them.
            drop(empty.try_send(PosedFrame::default()));
        }
        let work = move || {
            for frame in frames {
                let Ok(mut set) = empty_out.recv() else { break };
                let filled = set.fill(&mut movers, origin_mm, skies.as_ref(), neighbours.as_mut(), frame);
                let filled = filled.map(|()| set);
                let failed = filled.is_err();
                if ready_in.send(filled).is_err() || failed {
                    break;
                }
            }
            movers
        };
        let thread = Some(std::thread::spawn(work));
        Self { ready: Some(ready), empty: Some(empty), thread }
    }

    /// The next frame, as soon as it is ready; none behind the last.
    ///
    /// # Errors
    /// A frame that cannot be read; none follows.
    pub fn next_frame(&mut self) -> Result<Option<PosedFrame>, SceneError> {
        if let Some(found) = self.ready.as_ref().and_then(|ready| ready.recv().ok()) {
            return found.map(Some);
        }
        match self.thread.take().map(JoinHandle::join) {
            Some(Err(_)) => {
                let message =
                    "expected every frame to be worked out, found that the thread for it ended".to_owned();
                Err(SceneError::Value { scene: "motion".to_owned(), message })
            }
            _ => Ok(None),
        }
    }

    /// Stops, and gives the movers back; none where the thread ended before its time.
    pub fn finish(mut self) -> Option<Movers> {
        self.stop()
    }

    fn stop(&mut self) -> Option<Movers> {
        // The thread ends where nobody is at the other end.
        (self.ready, self.empty) = (None, None);
        self.thread.take()?.join().ok()
    }

    /// Makes room for another frame.
    pub fn give_back(&self, frame: PosedFrame) {
        if let Some(empty) = &self.empty {
            // Where nobody takes it there is no frame left.
            drop(empty.try_send(frame));
        }
    }
}

impl Drop for Poser {
    fn drop(&mut self) {
        drop(self.stop());
    }
}

impl Renderer {
    /// Starts to work out these frames of the movers of the renderer's scene, in this order.
    pub fn poser(&self, movers: Movers, frames: impl Iterator<Item = f64> + Send + 'static) -> Poser {
        let file = &self.scene.file;
        let neighbours = file.layers.motion.then(|| Neighbours::new(file.animation.speed));
        Poser::start(movers, self.scene.origin_mm, self.moving.skies.clone(), neighbours, frames)
    }

    /// Puts the fabrics that move where a frame has them, for the pictures from now on, and returns the bytes that went
    /// to the device. The camera stays where it is if nothing of it is left to be fitted ([`Movers::fix_camera`]).
    ///
    /// # Errors
    /// Those of the device.
    pub fn pose(&mut self, posed: &mut PosedFrame) -> Result<u64, VulkanError> {
        let mut bytes = 0;
        for fabric in &mut posed.fabrics {
            for part in self.moving.parts.iter().filter(|part| part.fabric == fabric.fabric) {
                let points = &fabric.control_points[part.points.clone()];
                part.control_points.replace(points)?;
                bytes += size_of_val(points) as u64;
                if let Some((buffer, skies)) = part.skies.as_ref().zip(fabric.skies.as_ref()) {
                    let skies = &skies[part.points.clone()];
                    buffer.replace(skies)?;
                    bytes += size_of_val(skies) as u64;
                }
                let neighbours = part.neighbours.iter().flatten().zip(fabric.neighbours.iter().flatten());
                for (buffer, points) in neighbours {
                    let points = &points[part.points.clone()];
                    buffer.replace(points)?;
                    bytes += size_of_val(points) as u64;
                }
            }
            let strands = &mut self.scene.fabrics[fabric.fabric].strands;
            std::mem::swap(&mut strands.points, &mut fabric.points);
            std::mem::swap(&mut strands.normals, &mut fabric.normals);
        }
        self.cloth = Cloth::new(&self.scene);
        Ok(bytes)
    }

    /// The scene as it is drawn: fabrics that move are where the last frame put them.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}
