//! Draws what is wanted on a thread of its own, so that a window never waits for cloth.

use super::work::{Message, Work};
use crate::error::Error;
use crate::frame::Picture;
use crate::frame::stats::Stats;
use crate::io::kept::Kept;
use crate::scene::file::{CameraTable, SceneFile};
use crate::shaders::ShaderSet;
use crate::vulkan::Device;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A picture that somebody wants.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// What it shows, checked.
    pub file: SceneFile,
    /// What the file's paths are relative to.
    pub folder: PathBuf,
    /// What errors call it.
    pub name: String,
    /// Width and height in pixels once nothing moves.
    pub size: [u32; 2],
    /// Something is dragged or plays: a small picture now is better than a whole one later.
    pub moving: bool,
    /// Whether to count what is drawn.
    pub statistics: bool,
    /// Most samples a pixel, to which pictures are refined.
    pub most_samples: u32,
    /// What it is drawn with.
    pub shaders: ShaderSet,
}

/// A picture, and what is known of it.
pub struct Shown {
    /// The picture.
    pub picture: Picture,
    /// What drawing it took.
    pub stats: Stats,
    /// What it shows.
    pub file: SceneFile,
    /// From where, with nothing left to be fitted.
    pub camera: CameraTable,
    /// Frames of what moves in it.
    pub frame_count: Option<u64>,
    /// Whether the tables are its own, not those of a scene before.
    pub own_tables: bool,
    /// Whether nothing better follows unless something changes.
    pub settled: bool,
    /// Which of what was wanted it shows, counted from 1.
    pub revision: u64,
    /// From when it was wanted until it was drawn.
    pub delay: Duration,
    /// Why it is drawn with other shaders than those that were wanted, if it is.
    pub refused: Option<String>,
    /// What a user should know of how its yarns were read.
    pub notes: Vec<String>,
}

/// What the painter tells.
pub enum News {
    /// A picture.
    Picture(Box<Shown>),
    /// What is wanted cannot be had, as one line; the picture before stays.
    Trouble(String),
    /// The device failed: nothing more follows.
    Ended(Error),
}

/// What is wanted, and since when.
pub(super) struct Order {
    pub wanted: Box<Wanted>,
    pub revision: u64,
    pub since: Instant,
}

/// The thread that draws.
pub struct Painter {
    inbox: Sender<Message>,
    /// What it tells, in order.
    pub news: Receiver<News>,
    newest: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Painter {
    /// Starts it; `wake` is called after each of its news.
    pub fn start(device: Arc<Device>, kept: Kept, wake: impl Fn() + Send + 'static) -> Self {
        let (inbox, messages) = channel();
        let (tell, news) = channel();
        let newest = Arc::new(AtomicU64::new(0));
        let tell = Box::new(move |told| {
            // Where nobody listens any more there is nobody to wake.
            if tell.send(told).is_ok() {
                wake();
            }
        });
        let mut work = Work::new(device, kept, (inbox.clone(), messages), tell, newest.clone());
        let run = move || {
            if let Err(error) = work.run() {
                work.end(error);
            }
        };
        Self { inbox, news, newest, thread: Some(std::thread::spawn(run)) }
    }

    /// Wants another picture from now on; what was wanted before is forgotten. Returns its revision.
    pub fn want(&self, wanted: Wanted) -> u64 {
        let revision = self.newest.fetch_add(1, Ordering::Relaxed) + 1;
        let order = Order { wanted: Box::new(wanted), revision, since: Instant::now() };
        // A thread that ended has said why.
        drop(self.inbox.send(Message::Wanted(order)));
        revision
    }

    /// Stops, and waits until nothing of it is on the device.
    pub fn stop(&mut self) {
        self.newest.fetch_add(1, Ordering::Relaxed);
        drop(self.inbox.send(Message::Stop));
        if let Some(thread) = self.thread.take() {
            // It has said why it ended, if it did.
            drop(thread.join());
        }
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        self.stop();
    }
}
