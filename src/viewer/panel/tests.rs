//! The panel under synthetic pointers and keys, without window and device.

mod files;

use super::*;
use crate::scene::parameters::{Kind, parameters};
use egui::accesskit::Role;
use egui::{Modifiers, Pos2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use toml::Value;

struct Desk {
    panel: Panel,
    document: Document,
    saved: Option<PathBuf>,
    copied: Vec<egui::OutputCommand>,
    home: tempfile::TempDir,
}

type Shown = Harness<'static, Desk>;

const SCENE: &str = "[fabric]\nmodel = 'yarn.obj'\nmm_per_unit = 1.0\n";

/// The panel of a scene of that text, showing what is searched for.
fn shown(text: &str, search: &str) -> Shown {
    opened("scene.toml", text, search)
}

fn opened(name: &str, text: &str, search: &str) -> Shown {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join(name);
    std::fs::write(&path, text).unwrap();
    std::fs::write(home.path().join("yarn.obj"), "v 0 0 0\nv 1 0 0\nv 2 1 0\nl 1 2 3\n").unwrap();
    let document = Document::open(&path).unwrap();
    let panel = Panel { search: search.into(), ..Panel::default() };
    let desk = Desk { panel, document, saved: None, copied: Vec::new(), home };
    let show = |ui: &mut Ui, desk: &mut Desk| {
        let before = desk.document.text();
        let response = desk.panel.show(ui, &mut desk.document);
        assert_eq!(response.changed, desk.document.text() != before, "every change is told");
        desk.saved = response.saved.or(desk.saved.take());
        desk.copied.extend(ui.ctx().output(|output| output.commands.clone()));
    };
    let mut shown = Harness::builder()
        .with_size(egui::vec2(PANEL_WIDTH, 700.0))
        .with_os(egui::os::OperatingSystem::Nix)
        .build_ui_state(show, desk);
    shown.run();
    shown
}

fn number(shown: &Shown, path: &str) -> f64 {
    let value = shown.state().document.get(path).unwrap();
    value.as_float().unwrap_or_else(|| value.as_integer().unwrap() as f64)
}

/// The one control of a role, in the row that is shown.
fn control(shown: &Shown, role: Role) -> Node<'_> {
    shown.get_by_role(role)
}

/// The name in front of a row; asking for its label gives the control that it is the label of.
fn name_of_row<'a>(shown: &'a Shown, path: &'a str) -> Node<'a> {
    let says = |text: Option<String>| text.as_deref() == Some(path);
    shown
        .root()
        .children_recursive()
        .find(|node| {
            let node = node.accesskit_node();
            node.role() == Role::Label && (says(node.label()) || says(node.value()))
        })
        .unwrap()
}

fn search(shown: &mut Shown, text: &str) {
    shown.state_mut().panel.search = text.into();
    shown.run();
}

/// Types a text into the `index`-th number that is shown.
fn type_number(shown: &mut Shown, index: usize, text: &str) {
    let numbers: Vec<_> = shown.get_all_by_role(Role::SpinButton).collect();
    numbers[index].click();
    shown.run();
    shown.key_press_modifiers(Modifiers::COMMAND, Key::A);
    shown.event(egui::Event::Text(text.into()));
    shown.run();
    shown.key_press(Key::Enter);
    shown.run();
}

fn drag(shown: &mut Shown, from: Pos2, to: Pos2) {
    shown.hover_at(from);
    shown.run();
    shown.drag_at(from);
    shown.run();
    for step in 1..=8 {
        shown.hover_at(from.lerp(to, step as f32 / 8.0));
        shown.run();
    }
    shown.drop_at(to);
    shown.run();
}

#[test]
fn every_parameter_is_found_by_its_key_and_none_is_wider_than_the_panel() {
    let lights = "[[light]]\n[[light]]\nkind = 'spot'\nposition_mm = [1, 2, 3]\n";
    // Values that differ have a button more.
    let set = "[fiber]\ncolor = [0.123, 0.123, 0.123]\ndiffuse = [0.123, 0.123, 0.123]\n\
               [yarn]\nply_pitch_mm = 0.001234\nhair_length_mm = [-123.45, 1234.5]\n\
               [camera]\ntarget_mm = [-1234.5, -1234.5, -1234.5]\n";
    let mut shown = shown(&format!("{SCENE}{lights}{set}"), "");
    for row in parameters() {
        let path = row.path();
        search(&mut shown, &path);
        let numbered = match (row.table, row.key) {
            ("light", "irradiance") => path.replacen('.', ".0.", 1),
            ("light", _) => path.replacen('.', ".1.", 1),
            ("fabric", _) => path.replacen('.', ".0.", 1),
            _ => path.clone(),
        };
        let found: Vec<_> = shown.query_all_by_label(&numbered).collect();
        assert!(!found.is_empty(), "{path}");
        let nodes = shown.root().children_recursive();
        let boxes = nodes.filter(|node| node.accesskit_node().bounding_box().is_some());
        let right = boxes.map(|node| node.rect().right()).fold(0.0, f32::max);
        assert!(right <= PANEL_WIDTH + 0.5, "{path}: {right}");
    }
    search(&mut shown, "khungurn beta_r");
    assert!(
        shown.query_by_label("fiber.beta_r_deg").is_some()
            && shown.query_by_label("yarn.ply_count").is_none()
    );
    search(&mut shown, "no such thing");
    assert!(shown.query_by_label("yarn.ply_count").is_none());
}

#[test]
fn a_drag_of_a_slider_is_one_step_to_undo() {
    let mut shown = shown(SCENE, "yarn.hair_density_per_mm");
    let before = number(&shown, "yarn.hair_density_per_mm");
    let rail = control(&shown, Role::Slider).rect();
    let at = |share: f32| Pos2::new(rail.left() + share * rail.width(), rail.center().y);
    drag(&mut shown, at(0.2), at(0.7));
    let dragged = number(&shown, "yarn.hair_density_per_mm");
    assert!((20.0..40.0).contains(&dragged) && dragged != before, "{dragged}");
    drag(&mut shown, at(0.7), at(0.4));
    let again = number(&shown, "yarn.hair_density_per_mm");
    assert!(again < dragged, "{again}");
    assert!(!shown.state().document.is_default("yarn.hair_density_per_mm"));
    shown.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    shown.run();
    assert_eq!(number(&shown, "yarn.hair_density_per_mm"), dragged);
    shown.get_by_label("Undo").click();
    shown.run();
    assert_eq!(number(&shown, "yarn.hair_density_per_mm"), before);
    assert_eq!(shown.state().document.can_undo_redo(), [false, true]);
    shown.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    shown.run();
    shown.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    shown.run();
    assert_eq!(number(&shown, "yarn.hair_density_per_mm"), again);
}

#[test]
fn a_number_is_typed_beyond_what_sliders_offer_and_refused_beyond_what_is_allowed() {
    let mut shown = shown(SCENE, "yarn.hair_density_per_mm");
    type_number(&mut shown, 0, "123.456");
    assert_eq!(number(&shown, "yarn.hair_density_per_mm"), 123.456);
    type_number(&mut shown, 0, "-1");
    assert_eq!(number(&shown, "yarn.hair_density_per_mm"), 123.456);
    let message = "yarn.hair_density_per_mm = -1: allowed is 0 to 1000 per mm and ply";
    assert!(shown.query_by_label(message).is_some(), "the error stands at the value");
    type_number(&mut shown, 0, "5");
    assert!(shown.query_by_label(message).is_none());
    search(&mut shown, "yarn.ply_count");
    type_number(&mut shown, 0, "4");
    assert_eq!(shown.state().document.get("yarn.ply_count"), Some(Value::Integer(4)));
    search(&mut shown, "quality.core_texture_rows");
    assert_eq!(shown.state().document.rejected(), None);
}

#[test]
fn presets_and_names_are_chosen_from_lists() {
    let mut shown = shown(SCENE, "yarn.preset");
    shown.state_mut().document.set("yarn.ply_count", 7).unwrap();
    shown.run();
    control(&shown, Role::ComboBox).click();
    shown.run();
    shown.get_by_label("mohair").click();
    shown.run();
    let document = &shown.state().document;
    assert_eq!(document.get("yarn.preset"), Some(Value::from("mohair")));
    assert!(!document.is_typed("yarn.ply_count"), "a preset takes what was set with it");
    search(&mut shown, "debug.view");
    control(&shown, Role::ComboBox).click();
    shown.run();
    shown.get_by_label("level of detail").click();
    shown.run();
    assert_eq!(shown.state().document.get("debug.view"), Some(Value::from("level_of_detail")));
    search(&mut shown, "quality.core_texture_rows");
    control(&shown, Role::ComboBox).click();
    shown.run();
    shown.get_by_label("128").click();
    shown.run();
    assert_eq!(shown.state().document.get("quality.core_texture_rows"), Some(Value::Integer(128)));
}

#[test]
fn what_differs_has_a_button_that_resets_it() {
    let mut shown =
        shown(&format!("{SCENE}[yarn]\npreset = 'silk1'\nply_clockwise = true\n"), "yarn.ply_clockwise");
    let silk = crate::yarn::presets::yarn("silk1").unwrap().ply_clockwise;
    let reset = "reset yarn.ply_clockwise";
    let switch = |shown: &mut Shown| {
        control(shown, Role::CheckBox).click();
        shown.run();
    };
    if silk {
        assert!(shown.query_by_label(reset).is_none(), "as the preset has it");
        switch(&mut shown);
    }
    assert_eq!(shown.state().document.get("yarn.ply_clockwise"), Some(Value::Boolean(!silk)));
    shown.get_by_label(reset).click();
    shown.run();
    assert!(!shown.state().document.is_typed("yarn.ply_clockwise"));
    assert!(shown.query_by_label(reset).is_none() && shown.state().document.is_default("yarn.ply_clockwise"));
}

#[test]
fn what_may_be_absent_has_a_switch() {
    let mut shown = shown(SCENE, "yarn.ply_pitch_mm");
    let preset = number(&shown, "yarn.ply_pitch_mm");
    let switch = |shown: &mut Shown, label: &str| {
        shown.get_by_label(label).click();
        shown.run();
    };
    switch(&mut shown, "twist yarn.ply_pitch_mm");
    assert_eq!(shown.state().document.get("yarn.ply_pitch_mm"), Some(Value::from("untwisted")));
    switch(&mut shown, "twist yarn.ply_pitch_mm");
    assert_eq!(number(&shown, "yarn.ply_pitch_mm"), preset);
    search(&mut shown, "camera.distance_mm");
    shown.state_mut().document.note_automatic("camera.distance_mm", 77.0);
    switch(&mut shown, "set camera.distance_mm");
    assert_eq!(number(&shown, "camera.distance_mm"), 77.0);
    switch(&mut shown, "set camera.distance_mm");
    assert_eq!(shown.state().document.get("camera.distance_mm"), None);
    search(&mut shown, "ambient.radiance");
    assert!(shown.query_by_label("set ambient.radiance").is_none(), "it is there whether it is set or not");
}

#[test]
fn vectors_spreads_and_colors_are_typed_by_component() {
    let mut shown = shown(SCENE, "yarn.loop_radius_mm");
    type_number(&mut shown, 1, "0.125");
    let typed = shown.state().document.get("yarn.loop_radius_mm").unwrap();
    assert_eq!(typed[1].as_float(), Some(0.125));
    search(&mut shown, "light.direction");
    type_number(&mut shown, 2, "0.75");
    let direction = shown.state().document.get("light.0.direction").unwrap();
    assert_eq!(direction, Value::from(vec![0.6, -0.7, 0.75]));
    search(&mut shown, "display.background");
    let exposed = shown.state().document.get("display.background").unwrap();
    type_number(&mut shown, 0, "0.11");
    let brighter = shown.state().document.get("display.background").unwrap();
    let ratio = |i: usize| brighter[i].as_float().unwrap() / exposed[i].as_float().unwrap();
    assert!((ratio(0) / ratio(2) - 1.0).abs() < 1e-3 && brighter[2].as_float() == Some(0.11), "{brighter}");
    search(&mut shown, "fiber.c_tt");
    type_number(&mut shown, 0, "0.25");
    assert_eq!(shown.state().document.get("fiber.c_tt").unwrap()[0].as_float(), Some(0.25));
}

#[test]
fn a_color_that_is_picked_keeps_its_brightness() {
    let mut shown = shown(SCENE, "light.irradiance");
    let before = shown.state().document.get("light.0.irradiance").unwrap();
    let button = shown.get_by_label("light.0.irradiance").rect();
    let at = button.center();
    shown.hover_at(at);
    shown.drag_at(at);
    shown.drop_at(at);
    shown.run();
    let picker = shown.get_all_by_role(Role::SpinButton).count();
    assert!(picker > 3, "the picker is open: {picker} numbers");
    // The square of hue and value lies below the button.
    let (from, to) = (at + egui::vec2(40.0, 200.0), at + egui::vec2(20.0, 190.0));
    drag(&mut shown, from, to);
    let after = shown.state().document.get("light.0.irradiance").unwrap();
    let most = |rgb: &Value| (0..3).map(|i| rgb[i].as_float().unwrap()).fold(0.0, f64::max);
    assert!(after != before, "{after}");
    assert!((most(&after) - most(&before)).abs() < 1e-3, "{before} {after}");
    assert!(shown.state_mut().document.undo() && !shown.state_mut().document.undo(), "one step");
}

#[test]
fn lights_are_added_changed_and_removed() {
    let mut shown = shown(SCENE, "light.kind");
    shown.get_by_label("spot").click();
    shown.run();
    assert_eq!(shown.state().document.light_count(), 2);
    assert!(shown.query_by_label("Light 2: spot").is_some());
    search(&mut shown, "light.outer_angle_deg");
    type_number(&mut shown, 0, "30");
    assert_eq!(number(&shown, "light.1.outer_angle_deg"), 30.0);
    shown.get_by_label("Remove light 1").click();
    shown.run();
    assert_eq!(number(&shown, "light.0.outer_angle_deg"), 30.0);
    shown.get_by_label("Undo").click();
    shown.run();
    assert_eq!(shown.state().document.light_count(), 2);
}

#[test]
fn rows_that_are_not_touched_change_nothing() {
    // Every control at once, of each kind of light, with all groups open.
    let lights = "[[light]]\n[[light]]\nkind = 'spot'\nposition_mm = [1, 2, 3]\n[[light]]\nkind = 'point'\n\
                  position_mm = [1e9, 2e-7, 3]\nintensity = [1e6, 0, 0.123456789]\n";
    let mut shown = shown(&format!("{SCENE}{lights}[yarn]\nply_pitch_mm = 123456.789\n"), "a");
    let before = shown.state().document.text();
    for text in ["e", "yarn", "light", "i", ""] {
        search(&mut shown, text);
    }
    for row in parameters().iter().filter(|row| !matches!(row.kind, Kind::Preset(_))) {
        search(&mut shown, &row.path());
    }
    // Numbers that are entered and left, of which fewer digits are shown.
    for path in [
        "light.intensity",
        "yarn.ply_pitch_mm",
        "quality.points_per_buffer",
        "display.background",
        "fiber.c_tt",
    ] {
        search(&mut shown, path);
        for index in 0..shown.query_all_by_role(Role::SpinButton).count() {
            let field = shown.get_all_by_role(Role::SpinButton).nth(index).unwrap();
            field.click();
            shown.run();
            assert!(shown.ctx.text_edit_focused(), "{path}: the number is being typed");
            shown.key_press(Key::Enter);
            shown.run();
        }
    }
    assert_eq!((shown.state().document.text(), shown.state().document.revision()), (before, 0));
}
