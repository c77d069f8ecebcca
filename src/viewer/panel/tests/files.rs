//! Files, fabrics, and what leaves the panel.

use super::*;

#[test]
fn files_are_typed_and_taken_when_typing_ends() {
    let mut shown = shown(SCENE, "ambient.environment picture exr");
    let write = |shown: &mut Shown, text: &str| {
        let field = shown.get_all_by_role(Role::TextInput).last().unwrap();
        field.click();
        shown.run();
        shown.key_press_modifiers(Modifiers::COMMAND, Key::A);
        let typed = if text.is_empty() { egui::Event::Cut } else { egui::Event::Text(text.into()) };
        shown.event(typed);
        shown.run();
    };
    write(&mut shown, "sky.exr");
    assert_eq!(shown.state().document.get("ambient.environment"), None, "not yet");
    shown.key_press(Key::Enter);
    shown.run();
    assert_eq!(shown.state().document.get("ambient.environment"), Some(Value::from("sky.exr")));
    write(&mut shown, "");
    shown.key_press(Key::Enter);
    shown.run();
    assert_eq!(shown.state().document.get("ambient.environment"), None);
}

#[test]
fn a_fabric_that_says_its_own_yarn_is_the_one_that_is_edited() {
    let two = "[[fabric]]\nmodel = 'yarn.obj'\n[[fabric]]\nmodel = 'yarn.obj'\n";
    for (text, path) in [
        (format!("{SCENE}[fabric.yarn]\nply_count = 2\n"), "fabric.0.yarn.ply_count"),
        (SCENE.to_owned(), "yarn.ply_count"),
        (two.to_owned(), "yarn.ply_count"),
    ] {
        let mut shown = shown(&text, "yarn.ply_count");
        type_number(&mut shown, 0, "4");
        assert!(shown.state().document.is_typed(path), "{text}");
        assert_eq!(number(&shown, path), 4.0);
    }
    let mut shown = shown(two, "yarn.ply_count");
    control(&shown, Role::ComboBox).click();
    shown.run();
    shown.get_by_label("of fabric 2: yarn.obj").click();
    shown.run();
    type_number(&mut shown, 0, "5");
    assert_eq!((number(&shown, "yarn.ply_count"), number(&shown, "fabric.1.yarn.ply_count")), (3.0, 5.0));
}

#[test]
fn a_right_click_copies_the_set_line_and_hovering_says_what_it_is() {
    let mut shown = shown(SCENE, "fiber.beta_r_deg");
    type_number(&mut shown, 0, "7.5");
    name_of_row(&shown, "fiber.beta_r_deg").click_secondary();
    shown.run();
    shown.get_by_label("Copy as --set").click();
    shown.run();
    let copied = shown.state().copied.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    assert_eq!(copied.as_deref(), Some("--set fiber.beta_r_deg=7.5"));
    shown.get_by_label("fiber.beta_r_deg").hover();
    shown.run_steps(60);
    for line in ["Range: 0.5 to 60 degrees", "Khungurn et al. 2017: beta_R"] {
        assert!(shown.query_by_label(line).is_some(), "{line}");
    }
    assert!(shown.query_by_label_contains("Default: ").is_some());
}

#[test]
fn scenes_are_saved_by_key_and_under_another_name() {
    let mut shown = shown(SCENE, "yarn.ply_count");
    type_number(&mut shown, 0, "4");
    assert!(shown.state().document.is_unsaved() && shown.query_by_label("• scene.toml").is_some());
    shown.key_press_modifiers(Modifiers::COMMAND, Key::S);
    shown.run();
    let path = shown.state().home.path().join("scene.toml");
    assert_eq!(shown.state().saved.as_ref(), Some(&path));
    shown.run();
    assert!(std::fs::read_to_string(&path).unwrap().contains("ply_count = 4"));
    assert!(!shown.state().document.is_unsaved() && shown.query_by_label("scene.toml").is_some());
    // A place that is none is said, and the name can be mended.
    shown.get_by_label("Save as").click();
    shown.run();
    shown.state_mut().panel.save_as = Some(path.with_file_name("none/a.toml").display().to_string());
    shown.get_by_label("Write").click();
    shown.run();
    assert!(shown.query_by_label_contains("no folder").is_some());
    shown.state_mut().panel.save_as = Some(path.with_file_name("other.toml").display().to_string());
    shown.run();
    shown.get_by_label("Write").click();
    shown.run();
    assert!(shown.query_by_label_contains("no folder").is_none() && shown.query_by_label("Write").is_none());
    assert_eq!(
        Document::open(&path.with_file_name("other.toml")).unwrap().text(),
        shown.state().document.text()
    );
}

#[test]
fn a_bare_yarn_file_asks_for_the_name_of_its_scene() {
    let mut shown = opened("bare.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n", "yarn.ply_count");
    shown.get_by_label("Save").click();
    shown.run();
    let name = shown.state().panel.save_as.clone().unwrap();
    assert!(name.ends_with("bare.toml"), "{name}");
    shown.get_by_label("Cancel").click();
    shown.run();
    assert!(shown.query_by_label("Write").is_none() && !std::path::Path::new(&name).exists());
    shown.key_press_modifiers(Modifiers::COMMAND, Key::S);
    shown.run();
    shown.get_by_label("Write").click();
    shown.run();
    assert!(std::path::Path::new(&name).exists() && !shown.state().document.is_bare());
}
