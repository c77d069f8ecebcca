//! Where the picture is shown, beside or over another one, and what is dragged there.

use super::painter::Shown;
use super::references::{Found, Known, have_one_reference};
use crate::error::Error;
use crate::frame::Picture;
use crate::io::picture::{DisplayImage, LinearImage, read_exr};
use crate::metrics::error::compare;
use crate::scene::SceneFile;
use crate::scene::file::DisplayTable;
use egui::emath::GuiRounding;
use egui::{Color32, ColorImage, Rect, Sense, TextureHandle, TextureOptions, Vec2, pos2, vec2};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

/// Steps of a wheel in a point of scrolling.
const STEPS_PER_POINT: f64 = 1.0 / 40.0;
/// How near to the wipe's edge it is taken hold of, in points.
const EDGE_POINTS: f32 = 8.0;

/// What was dragged since the last time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drag {
    /// By the first button.
    pub orbit: Vec2,
    /// By the middle one, or the first with Shift.
    pub pan: Vec2,
    /// By the second one.
    pub light: Vec2,
    /// Steps of the wheel.
    pub wheel: f64,
    /// A drag is over.
    pub ended: bool,
    /// Height of the picture.
    pub height_points: f32,
}

/// What the picture is compared with.
struct Other {
    label: String,
    texture: TextureHandle,
    light: Arc<LinearImage>,
    /// A traced reference, not a picture that was kept: pictures have its size.
    is_reference: bool,
    /// The scene that it was traced of, where that is known.
    of: Option<SceneFile>,
}

impl Other {
    /// Whether errors of pictures of `file` against it say anything.
    fn fits(&self, file: &SceneFile) -> bool {
        self.of.as_ref().is_none_or(|of| have_one_reference(of, file))
    }
}

/// One picture's error and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// Mean FLIP over the pixels that yarn covers in either.
    pub flip: f64,
    /// Milliseconds that drawing took.
    pub ms: f64,
    /// Samples per pixel.
    pub samples: u32,
}

/// How two pictures are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shows {
    /// The picture alone.
    #[default]
    Picture,
    /// The other left of this share of the width.
    Wipe(f32),
    /// How far they differ.
    Heatmap,
}

/// The picture on the desk.
#[derive(Default)]
pub struct Canvas {
    texture: Option<TextureHandle>,
    display: DisplayTable,
    other: Option<Other>,
    /// How they are shown.
    pub shows: Shows,
    heatmap: Option<TextureHandle>,
    judging: Option<Receiver<(Judged, ColorImage)>>,
    /// Errors against the other picture, the last one at the end.
    pub judged: Vec<Judged>,
    /// What other ways to draw the scene are expected to do, where it is compared with a reference that was traced here.
    pub known: Option<Vec<Known>>,
    size_px: Option<[u32; 2]>,
    holds_edge: bool,
}

impl Canvas {
    /// The size that pictures are to have: that of the place for them, or of the reference that they are compared with.
    pub fn wanted_size(&self) -> Option<[u32; 2]> {
        let reference = self.other.as_ref().filter(|other| other.is_reference);
        reference.map(|other| [other.light.width, other.light.height]).or(self.size_px)
    }

    /// The size of the place for pictures.
    pub fn place_size(&self) -> Option<[u32; 2]> {
        self.size_px
    }

    /// What the picture is compared with, and whether a picture of `file` has anything to do with it.
    pub fn other(&self, file: impl FnOnce() -> SceneFile) -> Option<(&str, bool)> {
        self.other.as_ref().map(|other| (other.label.as_str(), other.fits(&file())))
    }

    /// Takes a picture to show.
    pub fn take(&mut self, context: &egui::Context, shown: &Shown) {
        let image = color_image(shown.picture.size, &shown.picture.display);
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => self.texture = Some(context.load_texture("picture", image, TextureOptions::LINEAR)),
        }
        self.display.clone_from(&shown.file.display);
        self.judge(context, shown);
    }

    /// Keeps the picture as it is, to compare others with it.
    pub fn keep(&mut self, context: &egui::Context, shown: &Shown) {
        let texture = context.load_texture(
            "kept",
            color_image(shown.picture.size, &shown.picture.display),
            TextureOptions::LINEAR,
        );
        let light = Arc::new(light_of(&shown.picture));
        let label = "the picture kept".into();
        self.set_other(Other { label, texture, light, is_reference: false, of: None });
    }

    /// Compares with a picture of linear radiance.
    ///
    /// # Errors
    /// One that cannot be read, or shown.
    pub fn compare_with(&mut self, path: &Path, context: &egui::Context) -> Result<(), Error> {
        let label = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.set_reference(context, label, read_exr(path)?, None)
    }

    /// Compares with a reference that was traced of a scene.
    ///
    /// # Errors
    /// One that cannot be shown.
    pub fn compare_with_found(
        &mut self,
        context: &egui::Context,
        found: Found,
        of: SceneFile,
    ) -> Result<(), Error> {
        self.set_reference(context, "the reference".into(), found.light, Some(of))?;
        self.known = Some(found.known);
        Ok(())
    }

    fn set_reference(
        &mut self,
        context: &egui::Context,
        label: String,
        light: LinearImage,
        of: Option<SceneFile>,
    ) -> Result<(), Error> {
        let image = shown_image(&light, &self.display)?;
        let texture = context.load_texture("reference", image, TextureOptions::LINEAR);
        self.set_other(Other { label, texture, light: Arc::new(light), is_reference: true, of });
        Ok(())
    }

    fn set_other(&mut self, other: Other) {
        self.other = Some(other);
        self.shows = Shows::Wipe(0.5);
        (self.heatmap, self.judging) = (None, None);
        self.judged.clear();
        self.known = None;
    }

    /// Compares with nothing any more.
    pub fn forget_other(&mut self) {
        (self.other, self.heatmap, self.judging) = (None, None, None);
        self.shows = Shows::Picture;
        self.judged.clear();
        self.known = None;
    }

    /// Starts to work out how far the picture is from the other, on another thread, unless one is at it.
    fn judge(&mut self, context: &egui::Context, shown: &Shown) {
        let Some(other) = &self.other else { return };
        let same_size = [other.light.width, other.light.height] == shown.picture.size;
        if self.judging.is_some() || !same_size || !shown.own_tables || !other.fits(&shown.file) {
            return;
        }
        let (tell, judging) = channel();
        let (test, reference, display) =
            (light_of(&shown.picture), other.light.clone(), self.display.measured());
        let (ms, samples) = (shown.stats.frame_ms.median, shown.stats.samples);
        let context = context.clone();
        std::thread::spawn(move || {
            // Pictures that cannot be compared have no error.
            if let Ok(found) = compare(&test, &reference, &display) {
                let flip = found.error.covered.flip_mean;
                let map = found.flip.heatmap();
                let image = color_image([map.width, map.height], &map.pixels);
                drop(tell.send((Judged { flip, ms, samples }, image)));
                context.request_repaint();
            }
        });
        self.judging = Some(judging);
    }

    /// Hears what came of that.
    pub fn hear(&mut self, context: &egui::Context) {
        use std::sync::mpsc::TryRecvError;
        let Some(judging) = &self.judging else { return };
        match judging.try_recv() {
            Ok((judged, image)) => {
                self.judged.push(judged);
                self.heatmap = Some(context.load_texture("heatmap", image, TextureOptions::NEAREST));
                self.judging = None;
            }
            Err(TryRecvError::Disconnected) => self.judging = None,
            Err(TryRecvError::Empty) => (),
        }
    }

    /// Shows it, and says what was dragged.
    pub fn show(&mut self, ui: &mut egui::Ui, trouble: Option<&str>, said: Option<&str>) -> Drag {
        let (place, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let scale = ui.ctx().pixels_per_point();
        // Pixels of the picture lie on those of the window: between them it would be blurred.
        let place = place.round_to_pixels(scale);
        let side = |points: f32| ((points * scale).round() as u32).max(1);
        self.size_px = Some([side(place.width()), side(place.height())]);
        ui.painter().rect_filled(place, 0.0, Color32::from_gray(18));
        let Some(texture) = self.texture.clone() else {
            let waiting = trouble.unwrap_or("drawing ...");
            ui.painter().text(
                place.center(),
                egui::Align2::CENTER_CENTER,
                waiting,
                egui::FontId::proportional(16.0),
                Color32::LIGHT_GRAY,
            );
            return Drag::default();
        };
        let frame = self.frame_of(place);
        self.paint(ui, frame, &texture);
        let words = trouble.map(|why| (why, Color32::LIGHT_RED)).or(said.map(|said| (said, Color32::WHITE)));
        if let Some((words, color)) = words {
            let at = place.left_bottom() + vec2(8.0, -8.0);
            let font = egui::FontId::proportional(14.0);
            ui.painter().text(at, egui::Align2::LEFT_BOTTOM, words, font, color);
        }
        self.drag(ui, &response, frame)
    }

    /// The place of the picture: all, or with a reference of another shape as much as it fills.
    fn frame_of(&self, place: Rect) -> Rect {
        let Some(other) = self.other.as_ref().filter(|other| other.is_reference) else { return place };
        let size = vec2(other.light.width as f32, other.light.height as f32);
        let scale = (place.width() / size.x).min(place.height() / size.y);
        Rect::from_center_size(place.center(), size * scale)
    }

    fn paint(&self, ui: &egui::Ui, frame: Rect, texture: &TextureHandle) {
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let painter = ui.painter();
        match (self.shows, &self.other, &self.heatmap) {
            (Shows::Heatmap, Some(_), Some(heatmap)) => {
                painter.image(heatmap.id(), frame, whole, Color32::WHITE);
            }
            (Shows::Wipe(share), Some(other), _) => {
                painter.image(texture.id(), frame, whole, Color32::WHITE);
                let edge = frame.left() + share * frame.width();
                let left = Rect::from_min_max(frame.min, pos2(edge, frame.bottom()));
                let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(share, 1.0));
                painter.image(other.texture.id(), left, uv, Color32::WHITE);
                painter.vline(edge, frame.y_range(), (1.5, Color32::WHITE));
            }
            _ => {
                painter.image(texture.id(), frame, whole, Color32::WHITE);
            }
        }
    }

    fn drag(&mut self, ui: &egui::Ui, response: &egui::Response, frame: Rect) -> Drag {
        use egui::PointerButton as Button;
        let mut drag =
            Drag { height_points: frame.height(), ended: response.drag_stopped(), ..Drag::default() };
        if let Shows::Wipe(share) = &mut self.shows {
            let edge = frame.left() + *share * frame.width();
            let at = response.interact_pointer_pos();
            if response.drag_started_by(Button::Primary) {
                // Where it was pressed: a drag is one only some way from there.
                let pressed = ui.input(|input| input.pointer.press_origin());
                self.holds_edge = pressed.is_some_and(|at| (at.x - edge).abs() < EDGE_POINTS);
            }
            if let Some(at) = at.filter(|_| self.holds_edge && response.dragged_by(Button::Primary)) {
                *share = ((at.x - frame.left()) / frame.width()).clamp(0.0, 1.0);
                return drag;
            }
        }
        if response.drag_stopped() {
            self.holds_edge = false;
        }
        let shift = ui.input(|input| input.modifiers.shift);
        let moved = response.drag_delta();
        if response.dragged_by(Button::Middle) || response.dragged_by(Button::Primary) && shift {
            drag.pan = moved;
        } else if response.dragged_by(Button::Primary) {
            drag.orbit = moved;
        } else if response.dragged_by(Button::Secondary) {
            drag.light = moved;
        }
        if response.hovered() {
            drag.wheel = STEPS_PER_POINT * f64::from(ui.input(|input| input.smooth_scroll_delta().y));
        }
        drag
    }
}

fn light_of(picture: &Picture) -> LinearImage {
    let [width, height] = picture.size;
    LinearImage { width, height, pixels: picture.linear.clone() }
}

fn color_image(size: [u32; 2], pixels: &[[u8; 4]]) -> ColorImage {
    ColorImage::from_rgba_unmultiplied(size.map(|side| side as usize), pixels.as_flattened())
}

/// A picture of radiance as the scene shows it.
fn shown_image(light: &LinearImage, display: &DisplayTable) -> Result<ColorImage, Error> {
    let mut over = light.clone();
    for pixel in &mut over.pixels {
        let behind = 1.0 - pixel[3];
        for (color, background) in pixel.iter_mut().zip(display.background) {
            *color += behind * background as f32;
        }
        pixel[3] = 1.0;
    }
    let shown = DisplayImage::from_linear(&over, &display.measured())
        .map_err(|why| Error::Failed(why.to_string()))?;
    Ok(color_image([shown.width, shown.height], &shown.pixels))
}
