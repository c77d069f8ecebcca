//! The control of each kind of parameter.

use super::rows::Edit;
use crate::scene::parameters::{Kind, Parameter};
use crate::viewer::lights::to_digits;
use egui::{ComboBox, DragValue, Response, Slider, SliderClamping, TextEdit, Ui};
use toml::Value;

/// Digits that are kept of what a drag gives.
const DRAGGED_DIGITS: usize = 5;
/// Digits that are shown.
const SHOWN_DIGITS: usize = 5;
/// The same of a color's components, of which three stand side by side.
const COMPONENT_DIGITS: usize = 3;
/// Digits that are kept of any number: what follows is noise.
const KEPT_DIGITS: usize = 12;
/// Width of lists of names and of fields for paths, in points.
const WIDE: f32 = 150.0;
/// Least and greatest width of a slider's rail, in points.
const SLIDER_WIDTHS: (f32, f32) = (24.0, 82.0);
/// Width of what stands behind a slider's rail but for its number: margins and the button that resets.
const BESIDE_SLIDER: f32 = 48.0;
/// Width of a letter.
const LETTER: f32 = 7.5;
/// Of what is usual, the share that one point of a drag is worth.
const DRAG_SHARE: f64 = 2e-3;

/// Shows the control of one value, and what a user does to it.
pub fn control(ui: &mut Ui, row: &Parameter, path: &str, value: &Value) -> (Response, Option<Edit>) {
    match row.kind {
        Kind::Switch => switch(ui, value),
        Kind::Number(..) | Kind::Pitch(..) => slider(ui, row, value, false),
        Kind::Count(..) => slider(ui, row, value, true),
        Kind::PowerOfTwo(low, high) => {
            let powers = (0..63).map(|power| 1_u64 << power).filter(|n| (low..=high).contains(n));
            let names: Vec<String> = powers.map(|n| n.to_string()).collect();
            let (response, chosen) = list(ui, path, &value.to_string(), names.iter().map(String::as_str));
            let parsed = chosen.and_then(|name| name.parse::<i64>().ok());
            (response, parsed.map(|n| Edit::Set(n.into())))
        }
        Kind::Name(names) => {
            let (response, chosen) =
                list(ui, path, value.as_str().unwrap_or_default(), names.iter().copied());
            (response, chosen.map(|name| Edit::Set(name.into())))
        }
        Kind::Preset(names) => {
            let (response, chosen) = list(ui, path, value.as_str().unwrap_or_default(), names().into_iter());
            (response, chosen.map(Edit::Preset))
        }
        Kind::Rgb(most) => color(ui, vector(value), most),
        Kind::Vector(..) | Kind::Direction => numbers(ui, row, &vector(value)),
        Kind::Spread(..) => numbers(ui, row, &vector(value)[..2]),
        Kind::File => file(ui, path, value.as_str().unwrap_or_default()),
    }
}

fn number(value: &Value) -> f64 {
    value.as_float().or(value.as_integer().map(|whole| whole as f64)).unwrap_or_default()
}

fn vector(value: &Value) -> [f64; 3] {
    std::array::from_fn(|i| value.get(i).map_or(0.0, number))
}

/// A unit as it stands behind a number.
fn suffix(row: &Parameter) -> &'static str {
    match row.unit {
        "degrees" => "°",
        "micrometres" => " µm",
        "per mm and ply" => " /mm",
        "pixels" => " px",
        "mm" => " mm",
        "rad" => " rad",
        "stops" => " stops",
        // Their keys say it.
        _ => "",
    }
}

fn shown(number: f64, digits: usize) -> String {
    // Whole numbers may be counts, of which every digit matters.
    if number.fract() == 0.0 { number.to_string() } else { to_digits(number, digits).to_string() }
}

/// Whether a user gave a number another value: a field that is entered and left gives what it showed.
fn is_changed(now: f64, before: f64, digits: usize) -> bool {
    now != before && shown(now, 17) != shown(before, digits)
}

fn switch(ui: &mut Ui, value: &Value) -> (Response, Option<Edit>) {
    let mut on = value.as_bool().unwrap_or_default();
    let response = ui.checkbox(&mut on, "");
    let edit = response.changed().then(|| Edit::Set(on.into()));
    (response, edit)
}

/// A slider over what is usual; a number that is typed may be any, and is refused by who checks the scene.
fn slider(ui: &mut Ui, row: &Parameter, value: &Value, whole: bool) -> (Response, Option<Edit>) {
    let before = number(value);
    let mut now = before;
    let letters = shown(before, SHOWN_DIGITS).len() + suffix(row).len();
    let room = ui.available_width() - BESIDE_SLIDER - LETTER * letters as f32;
    ui.spacing_mut().slider_width = room.clamp(SLIDER_WIDTHS.0, SLIDER_WIDTHS.1);
    let slider = Slider::new(&mut now, row.usual.0..=row.usual.1)
        .logarithmic(row.logarithmic)
        .clamping(SliderClamping::Never)
        .custom_formatter(|number, _| shown(number, SHOWN_DIGITS))
        .update_while_editing(false)
        .suffix(suffix(row));
    let response = ui.add(if whole { slider.step_by(1.0) } else { slider });
    let given = || if whole { whole_edit(now) } else { Edit::Set(to_digits(now, KEPT_DIGITS).into()) };
    let edit = is_changed(now, before, SHOWN_DIGITS).then(given);
    (response, edit)
}

fn whole_edit(number: f64) -> Edit {
    // A number that is none whole is refused as such.
    Edit::Set(if number.fract() == 0.0 { Value::Integer(number as i64) } else { Value::Float(number) })
}

/// Gives numbers that a user left alone their old values, and the others no more digits than mean something; says
/// whether there are such.
fn keep_untouched(now: &mut [f64], before: &[f64], digits: usize) -> bool {
    let mut touched = false;
    for (now, before) in now.iter_mut().zip(before) {
        let changed = is_changed(*now, *before, digits);
        *now = if changed { to_digits(*now, KEPT_DIGITS) } else { *before };
        touched |= changed;
    }
    touched
}

/// Several numbers side by side; the first of two is a mean and the second its deviation.
fn numbers(ui: &mut Ui, row: &Parameter, before: &[f64]) -> (Response, Option<Edit>) {
    let mut now = before.to_vec();
    let (low, high) = row.usual;
    let count = before.len();
    let mut all: Option<Response> = None;
    for (index, number) in now.iter_mut().enumerate() {
        if count == 2 && index == 1 {
            ui.label("±");
        }
        let field = DragValue::new(number)
            .speed(DRAG_SHARE * (high - low))
            .custom_formatter(|number, _| shown(number, SHOWN_DIGITS))
            .update_while_editing(false)
            .suffix(if count == 2 && index == 1 { suffix(row) } else { "" });
        let response = ui.add(field);
        all = Some(all.map_or(response.clone(), |all| all | response));
    }
    let edit = keep_untouched(&mut now, before, SHOWN_DIGITS).then(|| Edit::Set(now.into()));
    (all.unwrap_or_else(|| ui.label("")), edit)
}

/// Linear RGB. What may be brighter than 1 has its hue in the button and its largest component beside it.
fn color(ui: &mut Ui, before: [f64; 3], most: f64) -> (Response, Option<Edit>) {
    let strength = before.into_iter().fold(0.0, f64::max);
    let bright = most > 1.0;
    let scale = if bright && strength > 0.0 { strength } else { 1.0 };
    let mut picked = before.map(|c| (c / scale) as f32);
    let response = ui.color_edit_button_rgb(&mut picked);
    let mut now = before;
    if response.changed() {
        let brightest = picked.into_iter().fold(0.0_f32, f32::max);
        // A hue of its own brightness would get darker with every frame of a drag.
        let even = if bright && brightest > 0.0 { f64::from(brightest) } else { 1.0 };
        now = picked.map(|c| to_digits(f64::from(c) / even * scale, DRAGGED_DIGITS));
    }
    let response =
        if bright { response | brightness(ui, &mut now) } else { response | components(ui, &mut now) };
    (response, (now != before).then(|| Edit::Set(now.to_vec().into())))
}

fn brightness(ui: &mut Ui, rgb: &mut [f64; 3]) -> Response {
    let before = rgb.iter().copied().fold(0.0, f64::max);
    let mut strength = before;
    let field = DragValue::new(&mut strength)
        .speed(0.01 * before.max(0.1))
        .range(0.0..=f64::INFINITY)
        .custom_formatter(|number, _| shown(number, SHOWN_DIGITS))
        .update_while_editing(false)
        .prefix("× ");
    let response = ui.add(field).on_hover_text("Largest component");
    if is_changed(strength, before, SHOWN_DIGITS) {
        *rgb = rgb
            .map(|c| if before > 0.0 { to_digits(c * strength / before, DRAGGED_DIGITS) } else { strength });
    }
    response
}

fn components(ui: &mut Ui, rgb: &mut [f64; 3]) -> Response {
    let before = *rgb;
    let fields = rgb.each_mut().map(|c| {
        let field = DragValue::new(c)
            .speed(DRAG_SHARE)
            .custom_formatter(|number, _| shown(number, COMPONENT_DIGITS))
            .update_while_editing(false);
        ui.add(field)
    });
    let [red, green, blue] = fields;
    keep_untouched(rgb, &before, COMPONENT_DIGITS);
    red | green | blue
}

fn list<'a>(
    ui: &mut Ui,
    path: &str,
    selected: &str,
    names: impl Iterator<Item = &'a str>,
) -> (Response, Option<String>) {
    let mut chosen = None;
    let list = ComboBox::from_id_salt(path).width(WIDE).truncate().selected_text(selected.replace('_', " "));
    let response = list.show_ui(ui, |ui| {
        for name in names {
            let clicked = ui.selectable_label(name == selected, name.replace('_', " ")).clicked();
            if clicked && name != selected {
                chosen = Some(name.to_owned());
            }
        }
    });
    (response.response, chosen)
}

/// A path, taken when typing ends.
fn file(ui: &mut Ui, path: &str, before: &str) -> (Response, Option<Edit>) {
    let id = ui.make_persistent_id(path);
    let kept: Option<String> = ui.data(|data| data.get_temp(id));
    let mut text = kept.unwrap_or_else(|| before.to_owned());
    let response = ui.add(TextEdit::singleline(&mut text).desired_width(WIDE));
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
        return (response, None);
    }
    ui.data_mut(|data| data.remove::<String>(id));
    let edit = match text.trim() {
        typed if !response.lost_focus() || typed == before => None,
        "" => Some(Edit::Reset),
        typed => Some(Edit::Set(typed.into())),
    };
    (response, edit)
}
