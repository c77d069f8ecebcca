//! The panel at the window's side: every parameter of the scene, made of [`crate::scene::parameters`].

mod controls;
mod groups;
mod rows;
#[cfg(test)]
mod tests;

use super::document::Document;
use egui::{Color32, Key, KeyboardShortcut, Modifiers, RichText, TextEdit, Ui};
use std::path::PathBuf;

/// Width in points at which every control has room.
pub const PANEL_WIDTH: f32 = 340.0;
/// Of messages about values that were refused.
const ERROR_COLOR: Color32 = Color32::from_rgb(240, 80, 70);

const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
const REDO_TOO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Y);
const SAVE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::S);

/// What the panel remembers between frames.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// What is looked for; all parameters where empty.
    pub search: String,
    /// The fabric whose yarn and fiber are edited; those of all fabrics where `Some(None)`, not chosen yet where `None`.
    scope: Option<Option<usize>>,
    /// The name that is being typed to save as.
    save_as: Option<String>,
    /// Why saving failed.
    failure: Option<String>,
    /// A refused value was shown where it belongs.
    rejection_shown: bool,
}

/// What happened in a panel.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PanelResponse {
    /// The document differs from before: compare by [`Document::changes_since`].
    pub changed: bool,
    /// It was saved there.
    pub saved: Option<PathBuf>,
}

impl Panel {
    /// Shows the panel and edits the document. Drags change it at every frame; what follows from it is for others to make.
    pub fn show(&mut self, ui: &mut Ui, document: &mut Document) -> PanelResponse {
        let before = document.revision();
        let mut response = PanelResponse::default();
        self.shortcuts(ui, document, &mut response);
        let spacing = ui.spacing_mut();
        (spacing.item_spacing, spacing.button_padding) = (egui::vec2(4.0, 3.0), egui::vec2(2.0, 1.0));
        (spacing.interact_size.x, spacing.indent) = (32.0, 8.0);
        self.header(ui, document, &mut response);
        ui.separator();
        self.messages(ui, document);
        let shown_before = std::mem::take(&mut self.rejection_shown);
        egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| self.groups(ui, document));
        if self.rejection_shown != shown_before {
            ui.ctx().request_repaint();
        }
        if !ui.input(|input| input.pointer.any_down()) {
            document.end_gesture();
        }
        response.changed = document.revision() != before;
        response
    }

    /// Keys that work wherever the pointer is; while text is typed, Ctrl+Z is the text's.
    fn shortcuts(&mut self, ui: &Ui, document: &mut Document, response: &mut PanelResponse) {
        if !ui.ctx().text_edit_focused() {
            // The longer one first: Shift is no hindrance to the shorter one.
            let pressed = |shortcut| ui.input_mut(|input| input.consume_shortcut(shortcut));
            if pressed(&REDO) || pressed(&REDO_TOO) {
                document.redo();
            } else if pressed(&UNDO) {
                document.undo();
            }
        }
        if ui.input_mut(|input| input.consume_shortcut(&SAVE)) {
            self.save(document, response);
        }
    }

    fn header(&mut self, ui: &mut Ui, document: &mut Document, response: &mut PanelResponse) {
        ui.horizontal(|ui| {
            let [undo, redo] = document.can_undo_redo();
            if ui.add_enabled(undo, egui::Button::new("Undo")).on_hover_text("Ctrl+Z").clicked() {
                document.undo();
            }
            if ui.add_enabled(redo, egui::Button::new("Redo")).on_hover_text("Ctrl+Shift+Z, Ctrl+Y").clicked()
            {
                document.redo();
            }
            if ui.button("Save").on_hover_text("Ctrl+S").clicked() {
                self.save(document, response);
            }
            if ui.button("Save as").on_hover_text("Under another name, from here on").clicked() {
                self.ask_for_name(document);
            }
            let name = document.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
            let unsaved = document.is_unsaved();
            let (text, hint) = if unsaved { (format!("• {name}"), "not saved") } else { (name, "saved") };
            let hint = format!("{} ({hint})", document.path().display());
            ui.add(egui::Label::new(text).truncate()).on_hover_text(hint);
        });
        self.name_to_save_as(ui, document, response);
        ui.add(
            TextEdit::singleline(&mut self.search)
                .hint_text("Search parameters")
                .desired_width(f32::INFINITY),
        );
    }

    fn ask_for_name(&mut self, document: &Document) {
        let path = document.path();
        let path = if document.is_bare() { path.with_extension("toml") } else { path.to_owned() };
        self.save_as = Some(path.display().to_string());
    }

    fn name_to_save_as(&mut self, ui: &mut Ui, document: &mut Document, response: &mut PanelResponse) {
        let Some(name) = &mut self.save_as else { return };
        let (mut agreed, mut given_up) = (false, false);
        ui.horizontal(|ui| {
            let field = ui.add(TextEdit::singleline(name).hint_text("scene.toml").desired_width(220.0));
            agreed = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            agreed |= ui.button("Write").clicked();
            given_up = ui.button("Cancel").clicked();
        });
        let path = PathBuf::from(name.trim());
        if given_up {
            self.save_as = None;
        } else if agreed {
            self.save_to(document, path, response);
        }
    }

    /// Saves where the scene is from; a bare yarn file has no scene yet, so that its name is asked for.
    fn save(&mut self, document: &mut Document, response: &mut PanelResponse) {
        if document.is_bare() {
            self.ask_for_name(document);
        } else {
            self.save_to(document, document.path().to_owned(), response);
        }
    }

    fn save_to(&mut self, document: &mut Document, path: PathBuf, response: &mut PanelResponse) {
        self.failure = document.save(&path).err().map(|error| error.to_string());
        if self.failure.is_none() {
            self.save_as = None;
            response.saved = Some(path);
        }
    }

    /// What went wrong and has no row of its own.
    fn messages(&mut self, ui: &mut Ui, document: &Document) {
        let rejected = document.rejected().filter(|_| !self.rejection_shown);
        for message in self.failure.iter().chain(rejected.map(|rejected| &rejected.message)) {
            ui.label(RichText::new(message).color(ERROR_COLOR).small());
        }
    }
}
