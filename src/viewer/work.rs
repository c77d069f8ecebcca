//! The painter's thread: what it has, and what it does next.

use super::draft::Detail;
use super::pace::{Pace, TARGET_MS};
use super::painter::{News, Order, Wanted};
use super::showing::{Followed, Showing};
use super::tried::Tried;
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
/// Time in which somebody who waits for a whole picture sees one that is nearly so.
const SOON_MS: f64 = 900.0;
/// Fiber curves handed to the device at once: between them a picture that nobody wants any more is given up.
const MOST_CURVES: u64 = 20_000;

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
    /// Coarser than the scene.
    Draft(Detail),
    /// The scene itself, small.
    Small,
    /// And whole, by its place among the refinements.
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
    paces: Paces,
    tried: Tried,
    wanted: Option<Order>,
    showing: Option<Showing>,
    /// A scene that is not shown before its tables are there.
    awaited: Option<Box<Scene>>,
    /// Whether what changed last was more than how it is looked at.
    remade: bool,
    /// Scenes that were made so far: tables are of one of them.
    made: u64,
    /// Who bakes the tables of one of them.
    baking: Option<JoinHandle<()>>,
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
            paces: Paces::default(),
            tried: Tried::default(),
            remade: true,
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
                        self.baking.take().map(JoinHandle::join);
                        self.trouble_is_told(move |work| work.take_tables(made, tables))?;
                    }
                    Message::Stop => return Ok(()),
                }
            }
            self.trouble_is_told(Self::draw)?;
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
            Err(Error::Vulkan(VulkanError::Shaders(why))) if self.goes_back(&why) => {
                return self.trouble_is_told(Self::follow);
            }
            Err(error @ Error::Vulkan(_)) => return Err(error),
            Err(error) => (self.tell)(News::Trouble(error.to_string())),
            Ok(()) => (),
        }
        Ok(())
    }

    /// Takes note that shaders are refused; whether there are others to draw with.
    fn goes_back(&mut self, why: &str) -> bool {
        let Some(Order { wanted, .. }) = &self.wanted else { return false };
        tracing::warn!("the device refuses shaders: {}", why.replace('\n', "; "));
        self.tried.refuse(&wanted.shaders, why)
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
        let shaders = self.tried.instead_of(&wanted.shaders);
        let reshaded = self.showing.as_mut().map(|showing| showing.set_shaders(&shaders)).transpose()?;
        let followed = match &mut self.showing {
            Some(showing) if showing.counts() == wanted.statistics => {
                showing.follow(&wanted.file, place, request, &mut self.models)?
            }
            _ => {
                let scene = Scene::of_file(wanted.file.clone(), place.0, place.1, &mut self.models)?;
                Followed::Awaited(Box::new(scene))
            }
        };
        match followed {
            Followed::Awaited(scene) => {
                self.made += 1;
                self.tried.try_again();
                self.awaited = Some(scene);
                // What is shown meanwhile is not what is wanted.
                self.next = Stage::Nothing;
                return Ok(());
            }
            Followed::Shown { remade } => {
                self.made += u64::from(remade);
                self.remade = remade;
                if remade {
                    self.tried.try_again();
                }
            }
            Followed::Already => (),
        }
        self.remade |= reshaded == Some(true);
        self.awaited = None;
        self.next = self.first();
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
        self.remade = true;
        self.next = self.first();
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
        if wanted.moving && self.awaited.is_none() {
            // What is dragged needs the processor, and tables of what it passes through nobody sees.
            return;
        }
        let (request, kept) = (request(wanted, wanted.size, REFINEMENTS[0]), self.kept.clone());
        let (made, inbox) = (self.made, self.inbox.clone());
        let bake = move || {
            // Where nobody wants them any more they are kept for the next time.
            drop(inbox.send(Message::Baked(made, Tables::bake(&scene, &request, &kept))));
        };
        self.baking = Some(std::thread::spawn(bake));
    }

    fn revision(&self) -> u64 {
        self.wanted.as_ref().map_or(0, |order| order.revision)
    }

    /// What is drawn first of what is shown anew.
    fn first(&self) -> Stage {
        let Some((Order { wanted, .. }, showing)) = self.wanted.as_ref().zip(self.showing.as_ref()) else {
            return Stage::Nothing;
        };
        if self.device.is_cpu() && showing.has_drafts() {
            let cores = !self.remade && !self.paces.fibers.whole_is_fast();
            return Stage::Draft(if cores { Detail::Cores } else { Detail::Fibers });
        }
        match self.paces.scene.whole_is_fast() && !wanted.moving {
            true => Stage::Whole(0),
            false => Stage::Small,
        }
    }

    /// What follows a picture, if nothing else is wanted meanwhile.
    fn after(&self, stage: Stage) -> Stage {
        let Some((Order { wanted, .. }, showing)) = self.wanted.as_ref().zip(self.showing.as_ref()) else {
            return Stage::Nothing;
        };
        let step = match stage {
            Stage::Nothing => return Stage::Nothing,
            Stage::Draft(_) | Stage::Small if wanted.moving => return Stage::Nothing,
            Stage::Draft(Detail::Cores) => return Stage::Draft(Detail::Fibers),
            Stage::Draft(Detail::Fibers) if self.paces.scene.is_slow(wanted.size, SOON_MS) => {
                return Stage::Small;
            }
            Stage::Draft(Detail::Fibers) | Stage::Small => 0,
            Stage::Whole(step) => step + 1,
        };
        // With tables of another scene nothing is worth refining.
        let allowed =
            |&&samples: &&u32| step == 0 || showing.stale.is_none() && samples <= wanted.most_samples;
        REFINEMENTS.get(step).filter(allowed).map_or(Stage::Nothing, |_| Stage::Whole(step))
    }

    /// Draws what is next.
    fn draw(&mut self) -> Result<(), Error> {
        let stage = std::mem::replace(&mut self.next, Stage::Nothing);
        let (Some(Order { wanted, revision, since }), Some(showing)) = (&self.wanted, &mut self.showing)
        else {
            return Ok(());
        };
        let shaders = self.tried.instead_of(&wanted.shaders);
        showing.set_shaders(&shaders)?;
        let newest = &self.newest;
        let goes_on = |_| !matches!(stage, Stage::Whole(_)) || newest.load(Ordering::Relaxed) == *revision;
        let (pace, asked) = match stage {
            Stage::Nothing => return Ok(()),
            Stage::Draft(detail) => {
                let pace = self.paces.of(detail);
                let size = pace.size(wanted.size);
                (Some(pace), Request { statistics: false, ..request(wanted, size, 1) })
            }
            Stage::Small => {
                let within_ms = if wanted.moving { TARGET_MS } else { SOON_MS };
                let size = self.paces.scene.size_within(wanted.size, within_ms);
                (Some(&mut self.paces.scene), request(wanted, size, REFINEMENTS[0]))
            }
            Stage::Whole(0) => (Some(&mut self.paces.scene), request(wanted, wanted.size, REFINEMENTS[0])),
            Stage::Whole(step) => (None, request(wanted, wanted.size, REFINEMENTS[step])),
        };
        let started = Instant::now();
        let draft = if let Stage::Draft(detail) = stage { Some(detail) } else { None };
        let renderer = match draft {
            Some(detail) => showing.draft(detail, asked)?,
            None => {
                showing.renderer.set_request(asked)?;
                &mut showing.renderer
            }
        };
        renderer.forget_pictures();
        let Some(picture) = renderer.render_while(&goes_on)? else {
            // Somebody wants another one: it is about to be received.
            return Ok(());
        };
        if let Some(pace) = pace {
            pace.learn(asked.size, wanted.size, started.elapsed());
        }
        let (moving, revision, delay) = (wanted.moving, *revision, since.elapsed());
        self.tried.drew(&shaders);
        self.next = self.after(stage);
        let Some(showing) = &self.showing else { return Ok(()) };
        let settled = self.next == Stage::Nothing && showing.stale.is_none() && !moving;
        let mut shown = showing.shown(picture, draft, (revision, settled), delay);
        let wanted = self.wanted.as_ref().map(|order| &order.wanted.shaders);
        shown.refused = wanted.and_then(|wanted| self.tried.why_not(wanted)).map(str::to_owned);
        (self.tell)(News::Picture(Box::new(shown)));
        Ok(())
    }
}

/// How long pictures take, each kind by itself.
#[derive(Default)]
struct Paces {
    scene: Pace,
    fibers: Pace,
    cores: Pace,
}

impl Paces {
    fn of(&mut self, detail: Detail) -> &mut Pace {
        match detail {
            Detail::Fibers => &mut self.fibers,
            Detail::Cores => &mut self.cores,
        }
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
