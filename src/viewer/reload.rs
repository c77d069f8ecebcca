//! Shaders that are edited while a window is open: their folder is watched, and compiled on a thread of its own.

use super::desk::Desk;
use crate::error::Error;
use crate::shaders::ShaderSet;
use crate::shaders::folder::Folder;
use egui::{Align2, Color32, RichText, vec2};
use notify::event::{AccessKind, AccessMode};
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// An editor writes a file in several steps: they are over when nothing was heard for so long, or for the longest.
const QUIET: Duration = Duration::from_millis(150);
const LONGEST_NOISE: Duration = Duration::from_secs(2);
/// How often it is looked whether a folder that cannot be watched can be.
const LOST: Duration = Duration::from_millis(500);
/// How long the end waits for the compiler, which cannot be stopped.
const ENDING: Duration = Duration::from_secs(2);
/// The compiler goes down into expressions as deep as they are.
const STACK_BYTES: usize = 64 << 20;
/// Share of the picture's height that a message covers at most.
const MESSAGE_SHARE: f32 = 0.6;

/// Why shaders are not drawn with, or those that are to be.
type Outcome = Result<ShaderSet, String>;

enum Event {
    Changed,
    Stop,
}

/// A folder of shaders that is watched.
pub struct Reload {
    outcomes: Receiver<Outcome>,
    events: Sender<Event>,
    /// Closed when the thread ends.
    ended: Receiver<()>,
    thread: Option<JoinHandle<()>>,
    message: Option<String>,
    is_awaited: bool,
}

impl Reload {
    /// Watches this folder; `wake` is called where there is something to be heard.
    ///
    /// # Errors
    /// No thread for it.
    pub fn start(root: PathBuf, wake: impl Fn() + Send + 'static) -> Result<Self, Error> {
        let (events, heard) = channel();
        let (tell, outcomes) = channel();
        let (ends, ended) = channel();
        let inbox = events.clone();
        let watch = move || {
            let tell = Box::new(move |outcome| {
                // Where nobody listens any more there is nobody to wake.
                if tell.send(outcome).is_ok() {
                    wake();
                }
            });
            Watch::new(root, (inbox, heard), tell).run();
            drop(ends);
        };
        let thread = std::thread::Builder::new().name("shaders".into()).stack_size(STACK_BYTES).spawn(watch);
        let thread = thread.map_err(|why| Error::Failed(format!("a thread for shaders: {why}")))?;
        Ok(Self { outcomes, events, ended, thread: Some(thread), message: None, is_awaited: true })
    }

    /// Whether nothing is known of the folder yet.
    pub fn is_awaited(&self) -> bool {
        self.is_awaited
    }
}

impl Drop for Reload {
    fn drop(&mut self) {
        drop(self.events.send(Event::Stop));
        let is_over = self.ended.recv_timeout(ENDING) == Err(RecvTimeoutError::Disconnected);
        if let Some(thread) = self.thread.take().filter(|_| is_over) {
            // It has nothing more to say.
            drop(thread.join());
        }
    }
}

/// The thread's own.
struct Watch {
    root: PathBuf,
    folder: Folder,
    inbox: Sender<Event>,
    events: Receiver<Event>,
    tell: Box<dyn Fn(Outcome)>,
    told: Option<Outcome>,
    /// Something has changed since the folder was looked at.
    changed: Cell<bool>,
    stopped: Cell<bool>,
}

impl Watch {
    fn new(
        root: PathBuf,
        (inbox, events): (Sender<Event>, Receiver<Event>),
        tell: Box<dyn Fn(Outcome)>,
    ) -> Self {
        let folder = Folder::new(root.clone());
        let (changed, stopped) = (Cell::new(false), Cell::new(false));
        Self { root, folder, inbox, events, tell, told: None, changed, stopped }
    }

    fn run(&mut self) {
        while !self.stopped.get() {
            self.changed.set(false);
            // Anew each time: what is there now may be another folder of that name. And before it is looked at, or what
            // is written in between would be missed.
            let watcher = watcher(&self.root, &self.inbox);
            let (events, changed, stopped) = (&self.events, &self.changed, &self.stopped);
            let goes_on = || {
                events.try_iter().for_each(|event| note(event, changed, stopped));
                !changed.get() && !stopped.get()
            };
            if let Some(found) = self.folder.shaders(&goes_on) {
                let unwatched = watcher.as_ref().err().map(|why| {
                    format!("{}: cannot be watched: {why}", self.root.display()).replace('\n', " ")
                });
                self.say(found.and_then(|set| unwatched.map_or(Ok(set), Err)));
                self.wait(watcher.is_err().then_some(LOST));
            }
            self.wait_for_quiet();
        }
    }

    /// Says what came of it, if that is news.
    fn say(&mut self, outcome: Outcome) {
        if self.told.as_ref() == Some(&outcome) {
            return;
        }
        match &outcome {
            Ok(set) => {
                let names: Vec<&str> = set.replaced().collect();
                let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
                tracing::info!("shaders of {} in place of this build's: {names}", self.root.display());
            }
            Err(why) => tracing::warn!("shaders are not drawn with: {}", why.replace('\n', "; ")),
        }
        self.told = Some(outcome.clone());
        (self.tell)(outcome);
    }

    /// Waits until something happens, or for so long.
    fn wait(&self, longest: Option<Duration>) {
        let event = match longest {
            Some(longest) => self.events.recv_timeout(longest),
            None => self.events.recv().map_err(RecvTimeoutError::from),
        };
        self.hear(event);
    }

    fn wait_for_quiet(&self) {
        let started = Instant::now();
        while !self.stopped.get() && started.elapsed() < LONGEST_NOISE {
            let event = self.events.recv_timeout(QUIET);
            if event.is_err() {
                return self.hear(event);
            }
            self.hear(event);
        }
    }

    fn hear(&self, event: Result<Event, RecvTimeoutError>) {
        match event {
            Ok(event) => note(event, &self.changed, &self.stopped),
            Err(RecvTimeoutError::Timeout) => (),
            Err(RecvTimeoutError::Disconnected) => self.stopped.set(true),
        }
    }
}

fn note(event: Event, changed: &Cell<bool>, stopped: &Cell<bool>) {
    match event {
        Event::Changed => changed.set(true),
        Event::Stop => stopped.set(true),
    }
}

/// Tells of every change below a folder, but not that it was read.
fn watcher(root: &Path, inbox: &Sender<Event>) -> notify::Result<RecommendedWatcher> {
    let inbox = inbox.clone();
    let written = EventKind::Access(AccessKind::Close(AccessMode::Write));
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
        let read = event.is_ok_and(|event| event.kind.is_access() && event.kind != written);
        if !read {
            // A thread that ended wants to know no more.
            drop(inbox.send(Event::Changed));
        }
    })?;
    watcher.watch(root, RecursiveMode::Recursive)?;
    Ok(watcher)
}

impl Desk {
    /// Takes over what was compiled since the last time.
    pub(super) fn hear_shaders(&mut self) {
        let Some(reload) = &mut self.reload else { return };
        while let Ok(outcome) = reload.outcomes.try_recv() {
            reload.is_awaited = false;
            match outcome {
                Ok(set) => (self.look.shaders, reload.message) = (set, None),
                Err(why) => reload.message = Some(why),
            }
        }
    }

    /// Shows over the picture, which is at this place, why shaders are not drawn with.
    pub(super) fn show_shader_trouble(&self, ui: &egui::Ui, place: egui::Rect) {
        let Some(reload) = &self.reload else { return };
        let refused = || self.shown.as_ref().and_then(|shown| shown.refused.as_deref());
        let Some(message) = reload.message.as_deref().or_else(refused) else { return };
        // An area stays as large as it was at first: another message is another one.
        let id = egui::Id::new(("shaders", message, place.width() as u32, place.height() as u32));
        let area = egui::Area::new(id).pivot(Align2::LEFT_TOP);
        let inset = vec2(8.0, 8.0);
        area.fixed_pos(place.min + inset).constrain_to(place).show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style()).fill(Color32::from_black_alpha(220)).show(ui, |ui| {
                ui.set_width(place.width() - 4.0 * inset.x);
                let head = "Drawn with the shaders before, until this is mended:";
                ui.label(RichText::new(head).color(Color32::WHITE));
                let scroll = egui::ScrollArea::vertical().max_height(MESSAGE_SHARE * place.height());
                scroll.auto_shrink([false, true]).show(ui, |ui| {
                    let text = RichText::new(message).monospace().color(Color32::LIGHT_RED);
                    ui.add(egui::Label::new(text).wrap().selectable(true));
                });
            });
        });
    }
}
