//! One row of the panel: a parameter's name, its control, and the way back.

use super::ERROR_COLOR;
use super::controls::control;
use crate::scene::parameters::{Group, Kind, Parameter};
use crate::viewer::document::Document;
use egui::{Label, Response, RichText, Sense, Ui, WidgetInfo, WidgetType};
use toml::Value;

/// Width of names, in points.
const NAME_WIDTH: f32 = 112.0;
/// Endings of keys that say a unit, which stands behind the value.
const UNIT_ENDINGS: [&str; 7] = ["_per_mm", "_mm", "_deg", "_rad", "_um", "_px", "_stops"];

/// What a user does to a row's value.
pub enum Edit {
    /// Gives it a value.
    Set(Value),
    /// Takes it away.
    Reset,
    /// Chooses a preset of its table.
    Preset(String),
}

/// The name that stands in front of a parameter: its key without unit, or the symbol that this is.
pub fn name(row: &Parameter) -> String {
    let ending = UNIT_ENDINGS.iter().find_map(|ending| row.key.strip_suffix(ending));
    let name = ending.unwrap_or(row.key);
    if name.eq_ignore_ascii_case(row.symbol) { row.symbol.to_owned() } else { name.replace('_', " ") }
}

/// Shows one parameter of the document, at `path`, and edits it. Says whether it told of a refused value.
pub fn row(ui: &mut Ui, document: &mut Document, row: &Parameter, path: &str) -> bool {
    let is_default = document.is_default(path);
    let edit = ui.horizontal(|ui| line(ui, document, row, path, is_default)).inner;
    if let Some(edit) = edit {
        // An error is kept by the document and shown below.
        let _ = apply(document, path, edit);
    }
    let rejected = document.rejected().filter(|rejected| rejected.path == path);
    if let Some(rejected) = rejected {
        ui.label(RichText::new(&rejected.message).color(ERROR_COLOR).small());
    }
    rejected.is_some()
}

/// The name, the switch of what may be absent, the control, and the button that resets.
fn line(ui: &mut Ui, document: &Document, row: &Parameter, path: &str, is_default: bool) -> Option<Edit> {
    let value = document.get(path);
    let label = name_label(ui, row, path, is_default);
    let mut edit = about(&label, document, row, path, is_default);
    if let Some(on) = switch_of_optional(document, row, path, value.as_ref()) {
        edit = presence(ui, document, row, path, on).or(edit);
    }
    let untwisted = matches!(row.kind, Kind::Pitch(..)) && value.as_ref().is_some_and(Value::is_str);
    // A file's name is typed into an empty field.
    let empty = matches!(row.kind, Kind::File).then(|| Value::String(String::new()));
    match value.or(empty) {
        Some(_) if untwisted => drop(ui.weak("untwisted")),
        None => drop(ui.weak("automatic")),
        Some(value) => {
            let (response, change) = control(ui, row, path, &value);
            let response = response.labelled_by(label.id);
            edit = change.or(about(&response, document, row, path, is_default)).or(edit);
        }
    }
    let reset = !is_default && reset_button(ui, document, path);
    if reset { Some(Edit::Reset) } else { edit }
}

/// What hovering over a row's name or control tells, and the menu of a right click.
fn about(
    response: &Response,
    document: &Document,
    row: &Parameter,
    path: &str,
    is_default: bool,
) -> Option<Edit> {
    let mut edit = None;
    // Lists and pickers have a popup of their own, by the same response.
    egui::Popup::context_menu(response).id(response.id.with("row")).show(|ui| {
        if ui.button("Copy as --set").clicked() {
            ui.ctx().copy_text(document.set_line(path));
            ui.close();
        }
        if ui.add_enabled(!is_default, egui::Button::new("Reset")).clicked() {
            edit = Some(Edit::Reset);
            ui.close();
        }
    });
    response.clone().on_hover_ui(|ui| tooltip(ui, document, row, path));
    edit
}

fn apply(document: &mut Document, path: &str, edit: Edit) -> Result<(), String> {
    match edit {
        Edit::Set(value) => document.set(path, value),
        Edit::Reset => document.reset(path),
        Edit::Preset(name) => document.choose_preset(path.strip_suffix(".preset").unwrap_or(path), &name),
    }
}

fn name_label(ui: &mut Ui, row: &Parameter, path: &str, is_default: bool) -> Response {
    let text = RichText::new(name(row));
    let text = if is_default { text } else { text.strong().underline() };
    let size = egui::vec2(NAME_WIDTH, ui.spacing().interact_size.y);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let response = ui
        .allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_width(NAME_WIDTH);
            ui.add(Label::new(text).truncate().sense(Sense::click()))
        })
        .inner;
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, path));
    response
}

/// Whether the row's parameter is there, of those that a switch takes away.
fn switch_of_optional(
    document: &Document,
    row: &Parameter,
    path: &str,
    value: Option<&Value>,
) -> Option<bool> {
    match row.kind {
        Kind::Pitch(..) => Some(value.and_then(Value::as_str) != Some("untwisted")),
        Kind::File => None,
        _ if !row.optional || row.group == Group::Light => None,
        _ if value.is_none() => Some(false),
        // The one that stands for its absence needs no switch.
        _ => (document.reset_value(path) == Ok(None)).then_some(true),
    }
}

/// The switch in front of what may be absent.
fn presence(ui: &mut Ui, document: &Document, row: &Parameter, path: &str, mut on: bool) -> Option<Edit> {
    let pitch = matches!(row.kind, Kind::Pitch(..));
    let response = ui.checkbox(&mut on, "");
    let (text, purpose) = if pitch { ("twisted", "twist") } else { ("set by hand", "set") };
    response
        .widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, on, format!("{purpose} {path}")));
    let changed = response.changed();
    response.on_hover_text(text);
    if !changed {
        return None;
    }
    match (on, pitch) {
        (false, true) => Some(Edit::Set("untwisted".into())),
        (false, false) => Some(Edit::Reset),
        // As the preset has it, where it is twisted.
        (true, true) => match document.reset_value(path) {
            Ok(Some(preset)) if !preset.is_str() => Some(Edit::Set(preset)),
            _ => document.start_value(path).map(Edit::Set),
        },
        (true, false) => document.start_value(path).map(Edit::Set),
    }
}

/// The button that gives back the preset's value or the default; says whether it was clicked.
fn reset_button(ui: &mut Ui, document: &Document, path: &str) -> bool {
    let response = ui.small_button("⟲");
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("reset {path}")));
    let clicked = response.clicked();
    response.on_hover_ui(|ui| drop(ui.label(format!("Back to {}", told(&document.reset_value(path))))));
    clicked
}

fn told(value: &Result<Option<Value>, String>) -> String {
    match value {
        Ok(Some(value)) => value.to_string(),
        Ok(None) => "automatic".into(),
        Err(message) => message.clone(),
    }
}

/// What a parameter is, its unit, its range, what a paper calls it, and what it is without being set.
fn tooltip(ui: &mut Ui, document: &Document, row: &Parameter, path: &str) {
    ui.set_max_width(300.0);
    ui.label(RichText::new(path).strong());
    ui.label(row.about);
    let unit = if row.unit.is_empty() { String::new() } else { format!(" {}", row.unit) };
    let allowed = match (row.range(), row.kind) {
        (Some((low, high)), Kind::Spread(..)) => {
            Some(format!("mean {low} to {high}{unit}, deviation 0 to {high}{unit}"))
        }
        (Some((low, high)), Kind::Pitch(..)) => Some(format!("{low} to {high}{unit}, or untwisted")),
        (Some((low, high)), Kind::Rgb(_)) => Some(format!("{low} to {high}, linear RGB")),
        (Some((low, high)), _) => Some(format!("{low} to {high}{unit}")),
        (None, Kind::Name(names)) => Some(names.join(", ")),
        _ => None,
    };
    if let Some(allowed) = allowed {
        ui.label(format!("Range: {allowed}"));
    }
    if !row.symbol.is_empty() {
        ui.label(format!("{}: {}", row.paper, row.symbol));
    }
    ui.label(format!("Default: {}", told(&document.reset_value(path))));
}
