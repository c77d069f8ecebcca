//! What is looked at, and how: the document, the picture of it, and what is compared with it.

use super::canvas::Canvas;
use super::comparing::Comparing;
use super::document::Document;
use super::live::Live;
use super::painter::{News, Painter, Shown, Wanted};
use super::panel::{PANEL_WIDTH, Panel};
use super::playing::{Playing, last};
use super::recent::Recent;
use super::{orbit, toolbar};
use crate::error::Error;
use crate::scene::SceneFile;
use crate::scene::file::CameraTable;
use crate::scene::light::LightTable;
use crate::shaders::ShaderSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use toml::Value;

/// Width of the figures, in points: the cloth must not change its size with what they say.
const FIGURES_POINTS: f32 = 250.0;
/// How long what is said to the user stays.
const SAID: Duration = Duration::from_secs(8);
/// How often a window asks whether what plays has a next frame, where no picture comes to ask for it.
const TICK: Duration = Duration::from_millis(100);

/// How pictures are drawn that the scene says nothing of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Look {
    /// Most samples a pixel.
    pub most_samples: u32,
    /// Count what is drawn.
    pub statistics: bool,
    /// What they are drawn with.
    pub shaders: ShaderSet,
}

/// A document on the desk.
pub struct Desk {
    /// What is edited.
    pub document: Document,
    pub(super) painter: Painter,
    pub(super) look: Look,
    #[cfg(feature = "hot-reload")]
    pub(super) reload: Option<super::reload::Reload>,
    /// From where it is looked at, once that was dragged: not part of what is undone.
    pub(super) camera: Option<CameraTable>,
    pub(super) shown: Option<Box<Shown>>,
    pub(super) canvas: Canvas,
    /// References of the scene.
    pub(super) comparing: Comparing,
    pub(super) live: Live,
    panel: Panel,
    pub(super) playing: Playing,
    pub(super) recent: Recent,
    pub(super) trouble: Option<String>,
    /// What was said to the user, and when.
    pub(super) said: Option<(String, Instant)>,
    /// A picture that is to be written once nothing better follows.
    pub(super) screenshot: Option<PathBuf>,
    asked: Option<(SceneFile, [u32; 2], bool)>,
    wanted_revision: u64,
    /// Pictures that were shown.
    pub pictures: u64,
    ended: Option<Error>,
    /// Ctrl+Q was pressed.
    pub quits: bool,
}

impl Desk {
    /// Puts a document on the desk; nothing is drawn before a size is known.
    pub fn new(document: Document, painter: Painter, look: Look, recent: Recent) -> Self {
        Self {
            document,
            painter,
            look,
            #[cfg(feature = "hot-reload")]
            reload: None,
            camera: None,
            shown: None,
            canvas: Canvas::default(),
            comparing: Comparing::default(),
            live: Live::default(),
            panel: Panel::default(),
            playing: Playing::new(),
            recent,
            trouble: None,
            said: None,
            screenshot: None,
            asked: None,
            wanted_revision: 0,
            pictures: 0,
            ended: None,
            quits: false,
        }
    }

    /// The scene as it is looked at.
    pub fn file(&self) -> SceneFile {
        let mut file = self.document.scene_file().clone();
        if let Some(camera) = &self.camera {
            file.camera = camera.clone();
        }
        if let Some(yaw_deg) = self.playing.yaw_deg(Instant::now()) {
            file.camera.yaw_deg = yaw_deg;
        }
        let count = self.shown.as_ref().and_then(|shown| shown.frame_count);
        if let Some(frame) =
            count.and_then(|count| self.playing.frame(&file.animation, count, Instant::now()))
        {
            file.animation.frame = Some(frame);
        }
        file
    }

    /// The camera with nothing left to be fitted, once a picture has shown which.
    pub fn fitted_camera(&self) -> Option<CameraTable> {
        self.camera.clone().or_else(|| self.shown.as_ref().map(|shown| shown.camera.clone()))
    }

    /// What is shown.
    pub fn shown(&self) -> Option<&Shown> {
        self.shown.as_deref()
    }

    /// Whether nothing better follows unless something changes.
    pub fn is_settled(&self) -> bool {
        #[cfg(feature = "hot-reload")]
        if self.reload.as_ref().is_some_and(super::reload::Reload::is_awaited) {
            return false;
        }
        let settled = |shown: &Shown| shown.settled && shown.revision == self.wanted_revision;
        self.trouble.is_some() || self.shown.as_deref().is_some_and(settled)
    }

    /// Hears what the painter has told.
    ///
    /// # Errors
    /// A device that failed.
    pub fn hear(&mut self, context: &egui::Context) -> Result<(), Error> {
        while let Ok(news) = self.painter.news.try_recv() {
            match news {
                News::Picture(shown) => {
                    log(&shown, self.canvas.wanted_size());
                    self.trouble = None;
                    self.pictures += 1;
                    self.canvas.take(context, &shown);
                    self.note(&shown);
                    self.shown = Some(shown);
                    self.write_screenshot();
                }
                News::Trouble(why) => self.trouble = Some(why),
                News::Ended(error) => self.ended = Some(error),
            }
        }
        self.canvas.hear(context);
        self.hear_reference(context);
        #[cfg(feature = "hot-reload")]
        self.hear_shaders();
        self.ended.take().map_or(Ok(()), Err)
    }

    /// Tells the document what keys that are absent came to.
    fn note(&mut self, shown: &Shown) {
        let camera = &shown.camera;
        if let Some(distance) = camera.distance_mm {
            self.document.note_automatic("camera.distance_mm", distance);
        }
        if let Some(pitch) = camera.pitch_deg {
            self.document.note_automatic("camera.pitch_deg", pitch);
        }
        if let Some(target) = camera.target_mm {
            self.document.note_automatic("camera.target_mm", target.to_vec());
            self.document.note_center_mm(target.into());
        }
    }

    /// Stops at the last frame of what does not repeat: only what stands still is drawn whole.
    fn end_playing(&mut self) {
        let animation = &self.document.scene_file().animation;
        let Some(count) = self.shown.as_ref().and_then(|shown| shown.frame_count) else { return };
        let frame = self.playing.frame(animation, count, Instant::now());
        if !animation.repeat && frame.is_some_and(|frame| frame >= last(count)) {
            self.playing.pause();
            self.scrub(last(count));
            self.document.end_gesture();
        }
    }

    /// The whole window. Returns after which time it wants to be shown again though nothing happens.
    pub fn show(&mut self, ui: &mut egui::Ui) -> Option<Duration> {
        let before = self.document.scene_file().camera.clone();
        self.keys(ui);
        toolbar::show(ui, self);
        let (panel, document) = (&mut self.panel, &mut self.document);
        let edited =
            egui::Panel::left("panel").default_size(PANEL_WIDTH).show(ui, |ui| panel.show(ui, document));
        if let Some(path) = edited.inner.saved.filter(|_| self.camera.is_some()) {
            // As it is looked at.
            self.save(&path);
        }
        if self.live.is_open {
            egui::Panel::right("live").exact_size(FIGURES_POINTS).show(ui, |ui| {
                egui::ScrollArea::vertical().show(ui, |ui| {
                    let compared = (&self.canvas.judged[..], self.canvas.known.as_deref());
                    Live::show(ui, self.shown.as_deref(), compared, &mut self.look.statistics);
                });
            });
        }
        egui::CentralPanel::default().frame(egui::Frame::NONE).show(ui, |ui| {
            #[cfg(feature = "hot-reload")]
            self.show_shader_trouble(ui, ui.max_rect());
            self.picture(ui);
        });
        if self.document.scene_file().camera != before {
            // What was typed counts, not what was dragged before.
            self.camera = None;
        }
        self.end_playing();
        self.want(ui.input(|input| input.pointer.any_down()));
        self.moves().then_some(TICK)
    }

    /// Tells the user something, for a while.
    pub(super) fn say(&mut self, said: impl Into<String>) {
        self.said = Some((said.into(), Instant::now()));
    }

    pub(super) fn say_if_wrong(&mut self, done: Result<(), String>) {
        if let Err(why) = done {
            self.say(why);
        }
    }

    fn moves(&self) -> bool {
        self.playing.plays() || self.playing.turns()
    }

    fn keys(&mut self, ui: &egui::Ui) {
        // Keys know what was held with them: by the time that they are looked at it may be let go.
        let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
        self.quits = pressed(egui::Modifiers::COMMAND, egui::Key::Q);
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        let pressed = |key| pressed(egui::Modifiers::NONE, key);
        if pressed(egui::Key::F) {
            self.fit();
        }
        if pressed(egui::Key::T) {
            self.toggle_turntable();
        }
        if pressed(egui::Key::Space) {
            self.toggle_playing();
        }
    }

    /// The picture, and what is dragged on it.
    fn picture(&mut self, ui: &mut egui::Ui) {
        let Some(camera) = self.fitted_camera() else {
            self.canvas.show(ui, self.trouble.as_deref(), None);
            return;
        };
        let said = self.said.as_ref().filter(|(_, when)| when.elapsed() < SAID);
        if said.is_some() {
            ui.ctx().request_repaint_after(SAID);
        }
        let drag = self.canvas.show(ui, self.trouble.as_deref(), said.map(|(said, _)| said.as_str()));
        let points = |v: egui::Vec2| [f64::from(v.x), f64::from(v.y)];
        let height = f64::from(drag.height_points);
        if drag.orbit != egui::Vec2::ZERO {
            self.playing.turn(None, Instant::now());
            self.camera = Some(orbit::orbit(&camera, points(drag.orbit)));
        } else if drag.pan != egui::Vec2::ZERO {
            self.camera = Some(orbit::pan(&camera, points(drag.pan), height));
        } else if drag.wheel != 0.0 {
            self.camera = Some(orbit::dolly(&camera, drag.wheel));
        } else if drag.light != egui::Vec2::ZERO {
            self.turn_light(&camera, points(drag.light));
        }
        if drag.ended {
            self.document.end_gesture();
        }
    }

    /// Turns the first light as if it were dragged over the picture.
    fn turn_light(&mut self, camera: &CameraTable, drag: [f64; 2]) {
        let lights = self.document.scene_file().light();
        let Some(light) = lights.first().filter(|light| light.direction.is_some() || !light.is_local())
        else {
            self.say("the first light has no direction to turn");
            return;
        };
        let turned = orbit::turn_light(LightTable::direction(light).to_array(), camera, drag);
        let value = Value::Array(turned.map(Value::Float).to_vec());
        let set = self.document.set("light.0.direction", value);
        self.say_if_wrong(set);
    }

    /// Looks at all of it.
    pub fn fit(&mut self) {
        let Some(camera) = self.fitted_camera() else { return };
        self.camera = Some(CameraTable { fit: true, distance_mm: None, target_mm: None, ..camera });
    }

    /// Lets the camera go around, or stand still.
    pub fn toggle_turntable(&mut self) {
        let Some(camera) = self.fitted_camera() else { return };
        let now = Instant::now();
        match self.playing.yaw_deg(now) {
            Some(yaw_deg) => {
                self.playing.turn(None, now);
                self.camera = Some(CameraTable { yaw_deg, ..camera });
            }
            None => self.playing.turn(Some(camera.yaw_deg), now),
        }
    }

    /// Plays, or stops where it is.
    pub fn toggle_playing(&mut self) {
        let Some(count) = self.shown.as_ref().and_then(|shown| shown.frame_count) else { return };
        let frame = self.file().animation.frame;
        if self.playing.plays() {
            self.playing.pause();
            self.scrub(frame.unwrap_or(0.0));
        } else {
            let at_end = frame.is_some_and(|frame| frame >= last(count));
            self.playing.play(if at_end { 0.0 } else { frame.unwrap_or(0.0) }, Instant::now());
        }
    }

    /// Shows one frame.
    pub fn scrub(&mut self, frame: f64) {
        let set = self.document.set("animation.frame", frame);
        self.say_if_wrong(set);
    }

    /// Wants a picture, if what is wanted is another one than before.
    fn want(&mut self, pointer_down: bool) {
        let file = self.file();
        let Some(size) = self.canvas.wanted_size() else { return };
        let changed =
            self.asked.as_ref().is_none_or(|(asked, of_size, _)| *asked != file || *of_size != size);
        let was_moving = self.asked.as_ref().is_some_and(|(.., moving)| *moving);
        let moving = self.moves() || pointer_down && (changed || was_moving);
        self.hold_tracing(moving);
        let look_changed = self.live.look_changed(&self.look);
        if !changed && moving == was_moving && !look_changed {
            return;
        }
        // What plays waits for its picture: the next wish is for the time when that is there.
        let awaits = self.shown.as_ref().is_some_and(|shown| shown.revision < self.wanted_revision);
        if self.moves() && was_moving && awaits && self.trouble.is_none() && !look_changed {
            return;
        }
        self.wanted_revision = self.painter.want(Wanted {
            file: file.clone(),
            folder: self.document.folder().to_owned(),
            name: self.document.path().display().to_string(),
            size,
            moving,
            statistics: self.look.statistics,
            most_samples: self.look.most_samples,
            shaders: self.look.shaders.clone(),
        });
        self.asked = Some((file, size, moving));
    }
}

/// A line for whoever follows what is drawn (`-v`).
fn log(shown: &Shown, wanted: Option<[u32; 2]>) {
    let ([width, height], [whole_width, whole_height]) =
        (shown.stats.size, wanted.unwrap_or(shown.stats.size));
    let state = match (shown.settled, shown.own_tables) {
        (true, _) => ", settled",
        (false, true) => "",
        (false, false) => ", with tables of the scene before",
    };
    tracing::info!(
        "picture {}: {width}x{height} of {whole_width}x{whole_height}, {} samples, {:.0} ms, {:.0} ms after it was wanted{state}",
        shown.revision,
        shown.stats.samples,
        shown.stats.frame_ms.median,
        1e3 * shown.delay.as_secs_f64(),
    );
}
