//! The painter's thread: what it has, and what it does next.

use super::draft::Edit;
use super::painter::{News, Order};
use super::showing::{Followed, Showing};
use super::stages::{Paces, Situation, Stage, whole_request};
use super::tried::Tried;
use crate::error::Error;
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
use std::time::{Duration, Instant};

/// Fiber curves handed to the device at once: between them a picture that nobody wants any more is given up.
const MOST_CURVES: u64 = 20_000;

/// What comes to the thread.
pub(super) enum Message {
    /// What is wanted.
    Wanted(Order),
    /// Tables of the scene of this number, and how long they took.
    Baked(u64, Result<Tables, VulkanError>, Duration),
    /// No more.
    Stop,
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
    /// The wish that a picture answered last, and by which.
    drawn: (u64, Stage),
    /// What changed last.
    edit: Edit,
    /// Scenes that were made so far: tables are of one of them.
    made: u64,
    /// Who bakes the tables of one of them.
    baking: Option<JoinHandle<()>>,
    /// How long the last ones took.
    bakes_take: Duration,
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
            drawn: (0, Stage::Nothing),
            edit: Edit::Cloth,
            wanted: None,
            showing: None,
            awaited: None,
            made: 0,
            baking: None,
            bakes_take: Duration::ZERO,
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
                    Message::Baked(made, tables, taken) => {
                        self.bakes_take = taken;
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
        let request = whole_request(wanted);
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
            Followed::Shown { edit } => {
                self.made += u64::from(edit != Edit::View);
                self.edit = edit;
                if edit != Edit::View {
                    self.tried.try_again();
                }
            }
            Followed::Already => (),
        }
        if reshaded == Some(true) {
            // It may be seen anywhere.
            self.edit = Edit::Cloth;
        }
        self.awaited = None;
        self.next = self.first();
        Ok(())
    }

    fn take_tables(&mut self, made: u64, tables: Result<Tables, VulkanError>) -> Result<(), Error> {
        let tables = tables?;
        let Some(Order { wanted, .. }) = &self.wanted else { return Ok(()) };
        let request = whole_request(wanted);
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
        self.edit = Edit::Cloth;
        let (revision, last) = self.drawn;
        let last = if revision == self.revision() { last } else { Stage::Nothing };
        self.next = self.situation().map_or(Stage::Nothing, |now| self.paces.with_own_tables(last, &now));
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
        let (request, kept) = (whole_request(wanted), self.kept.clone());
        let (made, inbox) = (self.made, self.inbox.clone());
        let bake = move || {
            // Where nobody wants them any more they are kept for the next time.
            let started = Instant::now();
            let tables = Tables::bake(&scene, &request, &kept);
            drop(inbox.send(Message::Baked(made, tables, started.elapsed())));
        };
        self.baking = Some(std::thread::spawn(bake));
    }

    fn revision(&self) -> u64 {
        self.wanted.as_ref().map_or(0, |order| order.revision)
    }

    /// What decides what is drawn next; nothing is where nothing is shown.
    fn situation(&self) -> Option<Situation> {
        let (Order { wanted, .. }, showing) = self.wanted.as_ref().zip(self.showing.as_ref())?;
        Some(Situation {
            has_drafts: self.device.is_cpu() && showing.has_drafts(),
            edit: self.edit,
            moving: wanted.moving,
            stale: showing.stale.is_some(),
            bakes_take: self.bakes_take,
            size: wanted.size,
            most_samples: wanted.most_samples,
        })
    }

    /// What is drawn first of what is shown anew.
    fn first(&self) -> Stage {
        self.situation().map_or(Stage::Nothing, |now| self.paces.first(&now))
    }

    /// Draws what is next.
    fn draw(&mut self) -> Result<(), Error> {
        let stage = std::mem::replace(&mut self.next, Stage::Nothing);
        let (Some(Order { wanted, revision, since }), Some(showing)) = (&self.wanted, &mut self.showing)
        else {
            return Ok(());
        };
        if stage == Stage::Nothing {
            return Ok(());
        }
        let shaders = self.tried.instead_of(&wanted.shaders);
        showing.set_shaders(&shaders)?;
        let newest = &self.newest;
        let goes_on = |_| !matches!(stage, Stage::Whole(_)) || newest.load(Ordering::Relaxed) == *revision;
        let asked = self.paces.request(stage, wanted);
        let started = Instant::now();
        let draft = if let Stage::Draft(detail) = stage { Some(detail) } else { None };
        let renderer = match draft {
            Some(detail) => showing.draft(detail, asked)?,
            None => {
                let renderer = showing.renderer()?;
                renderer.set_request(asked)?;
                renderer
            }
        };
        renderer.forget_pictures();
        let Some(picture) = renderer.render_while(&goes_on)? else {
            // Somebody wants another one: it is about to be received.
            return Ok(());
        };
        self.paces.learn(stage, asked.size, wanted.size, started.elapsed());
        let (moving, revision, delay) = (wanted.moving, *revision, since.elapsed());
        if draft.is_none() {
            // Drafts have not all pipelines.
            self.tried.drew(&shaders);
        }
        self.drawn = (revision, stage);
        self.next = self.situation().map_or(Stage::Nothing, |now| self.paces.after(stage, &now));
        let Some(showing) = &self.showing else { return Ok(()) };
        let settled = self.next == Stage::Nothing && showing.stale.is_none() && !moving;
        let mut shown = showing.shown(picture, draft, (revision, settled), delay);
        let wanted = self.wanted.as_ref().map(|order| &order.wanted.shaders);
        shown.refused = wanted.and_then(|wanted| self.tried.why_not(wanted)).map(str::to_owned);
        (self.tell)(News::Picture(Box::new(shown)));
        Ok(())
    }
}

/// Whether two scenes differ at most in how they are looked at.
fn differ_in_view(a: &SceneFile, b: &SceneFile) -> bool {
    SceneFile { camera: b.camera.clone(), display: b.display.clone(), ..a.clone() } == *b
}
