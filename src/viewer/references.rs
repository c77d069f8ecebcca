//! What pictures are compared with: a traced reference of the scene. Who opens the window says how one is made.

use super::changes::Changes;
use crate::error::Error;
use crate::io::picture::LinearImage;
use crate::scene::SceneFile;
use crate::scene::parameters::Group;
use crate::vulkan::Device;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

/// Steps of the share done.
const SHARES: f64 = 1e4;
/// How often one that waits looks whether it may go on.
const HELD_FOR: Duration = Duration::from_millis(20);
/// What errors do not come from: what the reference is traced of does not know of it.
const NOT_TRACED: [Group; 6] =
    [Group::Shadow, Group::Occlusion, Group::Quality, Group::Display, Group::Debug, Group::Layers];

/// A reference that somebody wants.
#[derive(Clone)]
pub struct Asked {
    /// The scene, as it is looked at.
    pub file: SceneFile,
    /// What the file's paths are relative to.
    pub folder: PathBuf,
    /// What errors call it.
    pub name: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u64,
    /// What pictures are drawn on.
    pub device: Arc<Device>,
}

/// What one way to draw is expected to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// What it is called.
    pub name: String,
    /// Wall time of a picture in ms.
    pub ms: f64,
    /// Mean FLIP over the pixels that yarn covers.
    pub flip: f64,
}

/// A reference.
pub struct Found {
    /// Its radiance.
    pub light: LinearImage,
    /// What other ways to draw the scene are expected to do on this device; empty where nothing was measured.
    pub known: Vec<Known>,
}

/// Finds references, or makes them.
pub trait References: Send + Sync {
    /// The reference, kept or traced; none if `goes_on`, which is told the share done, says to stop.
    ///
    /// # Errors
    /// A scene that cannot be had or traced; files that cannot be written.
    fn reference(&self, asked: &Asked, goes_on: &dyn Fn(f64) -> bool) -> Result<Option<Found>, Error>;
}

/// Whether a reference of the one scene is one of the other as well.
pub fn have_one_reference(a: &SceneFile, b: &SceneFile) -> bool {
    let changes = Changes::between(a, b);
    changes.is_nothing() || changes.is_only(&NOT_TRACED)
}

/// How a reference is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Samples a pixel.
    pub samples: u64,
    /// What the picture's sides are divided by.
    pub divisor: u32,
}

impl Default for Effort {
    /// As many samples as references of `worsted bench` have.
    fn default() -> Self {
        Self { samples: 64, divisor: 2 }
    }
}

/// One that is being traced, on a thread of its own.
pub struct Tracing {
    /// What is traced.
    pub asked: Asked,
    share: Arc<AtomicU32>,
    stops: Arc<AtomicBool>,
    waits: Arc<AtomicBool>,
    done: Receiver<Result<Option<Found>, Error>>,
}

impl Tracing {
    /// Starts; `wake` is called when it is done, and now and then before.
    pub fn start(references: Arc<dyn References>, asked: Asked, wake: impl Fn() + Send + 'static) -> Self {
        let share = Arc::new(AtomicU32::new(0));
        let [stops, waits] = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
        let (tell, done) = channel();
        let (told, stopped, held, of) = (share.clone(), stops.clone(), waits.clone(), asked.clone());
        std::thread::spawn(move || {
            let goes_on = |share: f64| {
                let step = (SHARES * share.clamp(0.0, 1.0)) as u32;
                if told.swap(step, Ordering::Relaxed) / 100 != step / 100 {
                    wake();
                }
                while held.load(Ordering::Relaxed) && !stopped.load(Ordering::Relaxed) {
                    std::thread::sleep(HELD_FOR);
                }
                !stopped.load(Ordering::Relaxed)
            };
            let found = references.reference(&of, &goes_on);
            // Nobody listens where the window is closed.
            drop(tell.send(found));
            wake();
        });
        Self { asked, share, stops, waits, done }
    }

    /// Lets it wait, or go on.
    pub fn hold(&self, waits: bool) {
        self.waits.store(waits, Ordering::Relaxed);
    }

    /// Share that is done.
    pub fn share(&self) -> f64 {
        f64::from(self.share.load(Ordering::Relaxed)) / SHARES
    }

    /// Gives it up; what was traced so far is kept by who traces.
    pub fn stop(&self) {
        self.stops.store(true, Ordering::Relaxed);
    }

    /// What came of it, once something has.
    pub fn hear(&self) -> Option<Result<Option<Found>, Error>> {
        match self.done.try_recv() {
            Ok(found) => Some(found),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => {
                Some(Err(Error::Failed("expected a reference, found that tracing it ended".into())))
            }
        }
    }
}

impl Drop for Tracing {
    fn drop(&mut self) {
        self.stop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::overrides::apply;

    #[test]
    fn a_reference_stays_one_while_nothing_changes_that_it_is_traced_of() {
        let with = |set: &str| -> SceneFile {
            let mut table = toml::from_str("[[fabric]]\nmodel = 'a'\n").unwrap();
            apply(&mut table, set).unwrap();
            table.try_into().unwrap()
        };
        let before = with("seed=0");
        for set in ["shadow.map=false", "quality.level_of_detail=false", "display.exposure_stops=1"] {
            assert!(have_one_reference(&before, &with(set)), "{set}");
        }
        for set in ["yarn.ply_count=2", "camera.yaw_deg=3", "light=[]", "seed=4", "fiber.preset=silk"] {
            assert!(!have_one_reference(&before, &with(set)), "{set}");
        }
    }
}
