//! The painter's thread: what it has, and what it does next.

use super::pace::Pace;
use super::painter::{News, Order, Wanted};
use super::showing::{Followed, Showing};
use crate::error::Error;
use crate::frame::Request;
use crate::frame::sampling::Sampling;
use crate::frame::tables::Tables;
use crate::io::kept::Kept;
use crate::scene::Scene;
use crate::scene::file::{LayersTable, SceneFile};
use crate::scene::models::Models;
use crate::vulkan::{Device, VulkanError};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvError, Sender, TryRecvError};
use std::thread::JoinHandle;
use std::time::Instant;

/// Samples of the pictures that follow one another while nothing changes.
const REFINEMENTS: [u32; 3] = [4, 16, 64];
/// Fiber curves handed to the device at once: between them a picture that nobody wants any more is given up.
const MOST_CURVES: u64 = 50_000;

/// What comes to the thread.
pub(super) enum Message {
    /// What is wanted.
    Wanted(Order),
    /// Tables of the scene of this number.
    Baked(u64, Result<Tables, VulkanError>),
    /// No more.
    Stop,
}

/// What is drawn next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Nothing,
    Small,
    Whole(usize),
}

/// The thread's own.
pub(super) struct Work {
    device: Arc<Device>,
    kept: Kept,
    messages: Receiver<Message>,
    /// For those who bake.
    inbox: Sender<Message>,
    tell: Box<dyn Fn(News) + Send>,
    newest: Arc<AtomicU64>,
    models: Models,
    pace: Pace,
    wanted: Option<Order>,
    showing: Option<Showing>,
    /// A scene that is not shown before its tables are there.
    awaited: Option<Box<Scene>>,
    /// Scenes that were made so far: tables are of one of them.
    made: u64,
    /// Of which one tables are being baked.
    baking: Option<(u64, JoinHandle<()>)>,
    next: Stage,
}

impl Work {
    pub(super) fn new(
        device: Arc<Device>,
        kept: Kept,
        (inbox, messages): (Sender<Message>, Receiver<Message>),
        tell: Box<dyn Fn(News) + Send>,
        newest: Arc<AtomicU64>,
    ) -> Self {
        Self {
            device,
            kept,
            messages,
            inbox,
            tell,
            newest,
            models: Models::default(),
            pace: Pace::default(),
            wanted: None,
            showing: None,
            awaited: None,
            made: 0,
            baking: None,
            next: Stage::Nothing,
        }
    }

    /// Tells that it ended for this reason.
    pub(super) fn end(&self, error: Error) {
        (self.tell)(News::Ended(error));
    }

    /// Does all that comes, until it is told to stop.
    pub(super) fn run(&mut self) -> Result<(), Error> {
        while let Some(messages) = self.receive() {
            for message in messages {
                match message {
                    Message::Wanted(order) => {
                        self.wanted = Some(order);
                        self.trouble_is_told(Self::follow)?;
                    }
                    Message::Baked(made, tables) => {
                        self.baking.take().map(|(_, thread)| thread.join());
                        self.trouble_is_told(move |work| work.take_tables(made, tables))?;
                    }
                    Message::Stop => return Ok(()),
                }
            }
            self.draw()?;
            self.bake();
        }
        Ok(())
    }

    /// What has come, of wishes the last alone; waits where there is nothing to draw. `None` at the end.
    fn receive(&mut self) -> Option<Vec<Message>> {
        let mut messages = Vec::new();
        if self.next == Stage::Nothing {
            match self.messages.recv() {
                Ok(message) => messages.push(message),
                Err(RecvError) => return None,
            }
        }
        loop {
            match self.messages.try_recv() {
                Ok(message) => {
                    if matches!(message, Message::Wanted(..)) {
                        messages.retain(|message| !matches!(message, Message::Wanted(..)));
                    }
                    messages.push(message);
                }
                Err(TryRecvError::Empty) => return Some(messages),
                Err(TryRecvError::Disconnected) => return None,
            }
        }
    }

    /// Does something, and tells of scenes that cannot be had; a device that fails is the end.
    fn trouble_is_told(&mut self, act: impl FnOnce(&mut Self) -> Result<(), Error>) -> Result<(), Error> {
        match act(self) {
            Err(error @ Error::Vulkan(VulkanError::TooLarge { .. })) => {
                (self.tell)(News::Trouble(error.to_string()))
            }
            Err(error @ Error::Vulkan(_)) => return Err(error),
            Err(error) => (self.tell)(News::Trouble(error.to_string())),
            Ok(()) => (),
        }
        Ok(())
    }

    /// Follows what is wanted as far as what is there can.
    fn follow(&mut self) -> Result<(), Error> {
        let Some(Order { wanted, .. }) = &mut self.wanted else { return Ok(()) };
        let quality = &mut wanted.file.quality;
        quality.curves_per_submission = quality.curves_per_submission.min(MOST_CURVES);
        // Nothing in a window shows them.
        wanted.file.layers = LayersTable::default();
        let request = request(wanted, wanted.size, REFINEMENTS[0]);
        let place = (wanted.folder.as_path(), wanted.name.as_str());
        if let Some(awaited) =
            self.awaited.as_mut().filter(|awaited| differ_in_view(&awaited.file, &wanted.file))
        {
            awaited.file = wanted.file.clone();
            return Ok(());
        }
        let followed = match &mut self.showing {
            Some(showing) if showing.counts() == wanted.statistics => {
                showing.follow(&wanted.file, place, request, &mut self.models)?
            }
            _ => {
                let scene = Scene::of_file(wanted.file.clone(), place.0, place.1, &mut self.models)?;
                Followed::Awaited(Box::new(scene))
            }
        };
        if let Some(showing) = &mut self.showing {
            showing.set_shaders(wanted.shaders.clone().unwrap_or_default())?;
        }
        let restart =
            if self.pace.whole_is_fast() && !wanted.moving { Stage::Whole(0) } else { Stage::Small };
        match followed {
            Followed::Awaited(scene) => {
                self.made += 1;
                self.awaited = Some(scene);
                // What is shown meanwhile is not what is wanted.
                self.next = Stage::Nothing;
                return Ok(());
            }
            Followed::Shown { remade } => self.made += u64::from(remade),
            Followed::Already => (),
        }
        self.awaited = None;
        self.next = restart;
        Ok(())
    }

    fn take_tables(&mut self, made: u64, tables: Result<Tables, VulkanError>) -> Result<(), Error> {
        let tables = tables?;
        let Some(Order { wanted, .. }) = &self.wanted else { return Ok(()) };
        let request = request(wanted, wanted.size, REFINEMENTS[0]);
        let own = made == self.made;
        match (self.awaited.take(), &mut self.showing) {
            (Some(scene), showing) if own || tables.may_stand_for(&scene, &request) => match showing {
                Some(showing) if showing.counts() == wanted.statistics => {
                    showing.show(*scene, tables, own)?
                }
                _ => {
                    let kept = &self.kept;
                    // What was shown goes first: there may not be room for both.
                    *showing = None;
                    *showing = Some(Showing::new(&self.device, *scene, request, tables, kept, own)?);
                }
            },
            (None, Some(showing)) if own => showing.settle(tables)?,
            (awaited, _) => {
                self.awaited = awaited;
                return Ok(());
            }
        }
        self.next = if self.pace.whole_is_fast() { Stage::Whole(0) } else { Stage::Small };
        Ok(())
    }

    /// Bakes, on another thread, what is not right yet, once nothing else is to be done first.
    fn bake(&mut self) {
        if self.baking.is_some() || self.newest.load(Ordering::Relaxed) != self.revision() {
            return;
        }
        let stale = self.showing.as_ref().and_then(|showing| showing.stale.as_ref());
        let Some(scene) = self.awaited.as_deref().or(stale).cloned() else { return };
        let Some(Order { wanted, .. }) = &self.wanted else { return };
        let (request, kept) = (request(wanted, wanted.size, REFINEMENTS[0]), self.kept.clone());
        let (made, inbox) = (self.made, self.inbox.clone());
        let bake = move || {
            // Where nobody wants them any more they are kept for the next time.
            drop(inbox.send(Message::Baked(made, Tables::bake(&scene, &request, &kept))));
        };
        self.baking = Some((made, std::thread::spawn(bake)));
    }

    fn revision(&self) -> u64 {
        self.wanted.as_ref().map_or(0, |order| order.revision)
    }

    /// Draws what is next.
    fn draw(&mut self) -> Result<(), Error> {
        let (Some(Order { wanted, revision, since }), Some(showing)) = (&self.wanted, &mut self.showing)
        else {
            self.next = Stage::Nothing;
            return Ok(());
        };
        let (size, samples) = match self.next {
            Stage::Nothing => return Ok(()),
            Stage::Small => (self.pace.size(wanted.size), REFINEMENTS[0]),
            Stage::Whole(step) => (wanted.size, REFINEMENTS[step]),
        };
        showing.renderer.set_request(request(wanted, size, samples))?;
        showing.renderer.forget_pictures();
        let (newest, small) = (&self.newest, self.next == Stage::Small);
        let goes_on = |_| small || newest.load(Ordering::Relaxed) == *revision;
        let started = Instant::now();
        let picture = showing.renderer.render_while(&goes_on)?;
        if samples == REFINEMENTS[0] && picture.is_some() {
            self.pace.learn(size, wanted.size, started.elapsed());
        }
        let stale = showing.stale.is_some();
        let after = match self.next {
            Stage::Small if !wanted.moving => Some(0),
            Stage::Whole(step) => Some(step + 1),
            _ => None,
        };
        let after = after.filter(|&step| step == 0 || !stale);
        let after = after
            .filter(|&step| REFINEMENTS.get(step).is_some_and(|&samples| samples <= wanted.most_samples));
        self.next = after.map_or(Stage::Nothing, Stage::Whole);
        let Some(picture) = picture else {
            // Somebody wants another one: it is about to be received.
            self.next = Stage::Nothing;
            return Ok(());
        };
        let settled = self.next == Stage::Nothing && !stale && !wanted.moving;
        let shown = showing.shown(picture, (*revision, settled), since.elapsed());
        (self.tell)(News::Picture(Box::new(shown)));
        Ok(())
    }
}

fn request(wanted: &Wanted, size: [u32; 2], samples: u32) -> Request {
    let sampling = Sampling::new(samples).unwrap_or(Sampling::FOUR);
    Request { size, sampling, statistics: wanted.statistics, profile: false }
}

/// Whether two scenes differ at most in how they are looked at.
fn differ_in_view(a: &SceneFile, b: &SceneFile) -> bool {
    SceneFile { camera: b.camera.clone(), display: b.display.clone(), ..a.clone() } == *b
}
