//! Scenes that are edited.

use super::*;
use crate::scene::Scene;
use crate::scene::parameters::{Group, Kind, parameters};

const YARN: &str = "v 0 0 0\nv 1 0 0\nv 2 1 0\nl 1 2 3\n";
const SCENE: &str =
    "# Mine.\n[fabric]\nmodel = 'yarn.obj' # from a friend\nmm_per_unit = 10.0\n\n[yarn]\nply_count = 2\n";

struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        let home = tempfile::tempdir().unwrap();
        std::fs::write(home.path().join("yarn.obj"), YARN).unwrap();
        Self(home)
    }

    fn file(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    fn open(&self, text: &str) -> Document {
        Document::open(&self.file("scene.toml", text)).unwrap()
    }
}

fn number(document: &Document, path: &str) -> f64 {
    let value = document.get(path).unwrap();
    value.as_float().unwrap_or_else(|| value.as_integer().unwrap() as f64)
}

/// A value of the parameter's that its default is not, within its range.
fn another(document: &Document, row: &Parameter, path: &str) -> Value {
    match (row.kind, document.get(path)) {
        (Kind::Switch, old) => Value::Boolean(old != Some(Value::Boolean(true))),
        (Kind::Name(names), old) => {
            let other = names.iter().find(|name| old.as_ref().and_then(Value::as_str) != Some(name));
            Value::from(*other.unwrap())
        }
        (Kind::Preset(names), old) => {
            let other = names().into_iter().find(|name| old.as_ref().and_then(Value::as_str) != Some(name));
            Value::from(other.unwrap())
        }
        (Kind::File, _) => Value::from("yarn.obj"),
        (Kind::PowerOfTwo(..), _) => Value::Integer(128),
        (Kind::Count(low, _), _) => Value::Integer(low as i64 + 5),
        (Kind::Rgb(_), _) => Value::from(vec![0.3, 0.25, 0.2]),
        (Kind::Vector(..) | Kind::Direction, _) => Value::from(vec![1.5, 2.0, 3.0]),
        (Kind::Spread(..), _) => Value::from(vec![0.5, 0.25]),
        (Kind::Number(..) | Kind::Pitch(..), _) => match row.key {
            "migration_min" => Value::Float(0.05),
            "migration_max" => Value::Float(1.25),
            key if key.starts_with("ellipse") => Value::Float(0.3),
            _ => Value::Float(0.45_f64.max(row.range().unwrap().0 * 1.5)),
        },
    }
}

fn numbered(row: &Parameter) -> String {
    let path = row.path();
    match row.table {
        "light" | "fabric" => path.replacen('.', ".0.", 1),
        _ => path,
    }
}

fn is_spot_only(row: &Parameter) -> bool {
    row.table == "light"
        && ["intensity", "position_mm", "outer_angle_deg", "inner_angle_deg"].contains(&row.key)
}

#[test]
fn every_parameter_is_set_saved_loaded_set_by_line_reset_and_undone() {
    let home = Home::new();
    for row in parameters() {
        let path = numbered(row);
        let spot = if is_spot_only(row) { "[[light]]\nkind = 'spot'\nposition_mm = [9, 9, 9]\n" } else { "" };
        let mut document = home.open(&format!("{SCENE}{spot}"));
        let before = document.scene_file().clone();
        let (old, value) = (document.get(&path), another(&document, row, &path));
        document.set(&path, value.clone()).unwrap();
        document.end_gesture();
        let changes = document.changes_since(&before);
        assert!(row.key == "model" || changes.touches(row.group), "{path}: {changes:?}");
        let found = document.get(&path).unwrap();
        assert!(!document.is_default(&path) || row.key == "model", "{path} = {found}");
        // By line, onto the file as it was.
        let assignments = [document.assignments(), vec![document.assignment(&path)]];
        for set in assignments.iter().filter(|_| row.key != "motion" && row.key != "environment") {
            let by_line = Scene::load(document.path(), set);
            match by_line {
                Ok(scene) => assert_eq!(&scene.file, document.scene_file(), "{set:?}"),
                Err(error) => assert!(row.key == "frame" && error.to_string().contains("motion"), "{error}"),
            }
        }
        // By file.
        let saved = home.0.path().join("saved.toml");
        document.save(&saved).unwrap();
        assert!(!document.is_unsaved());
        assert_eq!(Document::open(&saved).unwrap().scene_file(), document.scene_file(), "{path}");
        assert!(document.undo() && !document.undo());
        assert_eq!((document.get(&path), document.scene_file()), (old, &before), "{path}");
        assert!(document.redo() && document.get(&path) == Some(found.clone()), "{path}");
        if document.reset_value(&path).is_ok() {
            let told = document.reset_value(&path).unwrap();
            document.reset(&path).unwrap();
            assert!(document.is_default(&path) && document.get(&path) == told, "{path}");
        } else {
            assert!(document.reset(&path).is_err());
        }
    }
}

#[test]
fn a_value_out_of_range_changes_nothing_and_says_what_is_allowed() {
    let home = Home::new();
    let mut document = home.open(SCENE);
    let before = document.text();
    for (path, value, expected) in [
        ("yarn.ply_count", Value::Integer(9), "yarn.ply_count = 9: allowed is 1 to 8"),
        (
            "yarn.ply_count",
            Value::from("two"),
            "yarn.ply_count = \"two\": expected a whole number, allowed is 1 to 8",
        ),
        ("camera.fov_y_deg", Value::Float(f64::NAN), "camera.fov_y_deg = NaN: allowed is 1 to 170"),
        ("camera.fov", Value::Float(3.0), "camera.fov: no such key"),
        ("light.0.kind", Value::from("lamp"), "light"),
        ("light.7.kind", Value::from("spot"), "light.7"),
        ("light.7.irradiance", Value::from(vec![1.0; 3]), "light.7.irradiance: there is no such table"),
        ("yarn.preset", Value::from("none"), "yarn.preset = \"none\": no such preset"),
    ] {
        let message = document.set(path, value).unwrap_err();
        assert!(message.starts_with(expected) && !message.contains('\n'), "{message}");
        assert_eq!(document.rejected(), Some(&Rejected { path: path.into(), message }));
        assert_eq!((document.text(), document.can_undo_redo()), (before.clone(), [false, false]));
    }
    document.set("yarn.ply_count", 3).unwrap();
    assert_eq!(document.rejected(), None);
    assert!(document.remove_light(1).is_err() && document.add_light("lamp").is_err());
    assert!(document.choose_preset("yarn", "none").is_err());
}

#[test]
fn a_drag_is_one_step_and_equal_values_are_none() {
    let mut document = Home::new().open(SCENE);
    for step in 0..20 {
        document.set("yarn.ply_pitch_mm", 3.0 + f64::from(step)).unwrap();
    }
    document.end_gesture();
    document.set("yarn.ply_pitch_mm", 22.0).unwrap();
    document.end_gesture();
    for step in 0..5 {
        document.set("yarn.ply_pitch_mm", 1.0 + f64::from(step)).unwrap();
    }
    assert!(document.undo());
    assert_eq!(number(&document, "yarn.ply_pitch_mm"), 22.0);
    assert!(document.undo() && !document.undo() && !document.is_unsaved());
    assert!(document.redo() && document.redo() && !document.redo());
    assert_eq!(number(&document, "yarn.ply_pitch_mm"), 5.0);
    assert_eq!(document.set_line("yarn.ply_pitch_mm"), "--set yarn.ply_pitch_mm=5.0");
}

#[test]
fn a_preset_takes_everything_else_out_of_its_table() {
    let mut document = Home::new().open(SCENE);
    document.set("yarn.hair_taper", 0.125).unwrap();
    document.choose_preset("yarn", "mohair").unwrap();
    assert!(document.is_typed("yarn.preset") && !document.is_typed("yarn.ply_count"));
    let mohair = crate::yarn::presets::yarn("mohair").unwrap();
    assert_eq!(document.get("yarn.ply_count"), Some(Value::from(mohair.ply_count)));
    assert_eq!(number(&document, "yarn.hair_density_per_mm"), mohair.hair_density_per_mm);
    assert!(document.undo());
    assert_eq!((number(&document, "yarn.ply_count"), number(&document, "yarn.hair_taper")), (2.0, 0.125));
    document.choose_preset("fabric.0.fiber", "silk").unwrap();
    assert_eq!(document.get("fabric.0.fiber.preset"), Some(Value::from("silk")));
    assert_eq!(document.get("fiber.preset"), Some(Value::from("wool")));
    // The preset and one change on top of it, as the scene's text has it.
    document.set("fabric.0.fiber.beta_r_deg", 9.5).unwrap();
    assert!(
        !document.is_default("fabric.0.fiber.beta_r_deg")
            && document.is_default("fabric.0.fiber.beta_tt_deg")
    );
    assert_eq!(document.set_line("fabric.0.fiber.beta_r_deg"), "--set fabric.fiber.beta_r_deg=9.5");
}

#[test]
fn keys_that_cannot_stand_together_make_room() {
    let mut document = Home::new().open(SCENE);
    document.set("fiber.color", vec![0.4, 0.1, 0.05]).unwrap();
    document.set("fiber.c_tt", vec![0.5, 0.5, 0.5]).unwrap();
    assert!(!document.is_typed("fiber.color"));
    document.set("fiber.color", vec![0.4, 0.1, 0.05]).unwrap();
    assert!(!document.is_typed("fiber.c_tt") && document.undo() && document.is_typed("fiber.c_tt"));
    document.set("ambient.environment", "sky.exr").unwrap();
    assert_eq!(document.get("ambient.radiance"), None);
    document.set("ambient.radiance", vec![0.5; 3]).unwrap();
    assert!(!document.is_typed("ambient.environment"));
}

#[test]
fn lights_change_their_kind_come_and_go() {
    let home = Home::new();
    let mut document = home.open(SCENE);
    document.note_center_mm(DVec3::new(0.0, 5.0, 0.0));
    let loads = |document: &Document| {
        let scene = Scene::load(document.path(), &document.assignments()).unwrap();
        assert_eq!(&scene.file, document.scene_file(), "{:?}", document.assignments());
    };
    for kind in ["spot", "point", "directional", "point"] {
        document.set("light.0.kind", kind).unwrap();
        document.end_gesture();
        assert_eq!(document.get("light.0.kind"), Some(Value::from(kind)));
        loads(&document);
    }
    document.add_light("spot").unwrap();
    document.add_light("directional").unwrap();
    assert_eq!(document.light_count(), 3);
    loads(&document);
    assert!(
        document.set_line("light.1.kind").starts_with("--set 'light=["),
        "{}",
        document.set_line("light.1.kind")
    );
    document.save(&home.0.path().join("lights.toml")).unwrap();
    document.set("light.1.inner_angle_deg", 12.0).unwrap();
    assert_eq!(document.set_lines(), ["--set light.1.inner_angle_deg=12.0"]);
    document.set("light.1.kind", "directional").unwrap();
    loads(&document);
    for _ in 0..3 {
        document.remove_light(0).unwrap();
        loads(&document);
    }
    assert_eq!(document.light_count(), 0);
    document.add_light("point").unwrap();
    assert_eq!(document.light_count(), 1);
    while document.undo() {}
    assert_eq!((document.light_count(), document.is_typed("light")), (1, false));
}

#[test]
fn lines_say_what_differs_from_the_file_and_nothing_else() {
    let home = Home::new();
    let text = format!("{SCENE}ply_pitch_mm = 4.5\n[camera]\nyaw_deg = 30.0\ndistance_mm = 90.0\n");
    let mut document = home.open(&text);
    assert!(document.assignments().is_empty());
    document.reset("camera.distance_mm").unwrap();
    document.reset("yarn.ply_pitch_mm").unwrap();
    document.set("yarn.hair_pitch_mm", 4).unwrap();
    document.set("fabric.0.mm_per_unit", 12.5).unwrap();
    document.set("camera.target_mm", vec![1.0, 2.0, 3.0]).unwrap();
    let pitch = number(&document, "yarn.ply_pitch_mm");
    assert_eq!(
        document.set_lines(),
        [
            "--set camera.distance_mm=null".to_owned(),
            "--set 'camera.target_mm=[1.0, 2.0, 3.0]'".into(),
            "--set fabric.mm_per_unit=12.5".into(),
            "--set yarn.hair_pitch_mm=4".into(),
            format!("--set yarn.ply_pitch_mm={pitch:?}"),
        ]
    );
    let scene = Scene::load(document.path(), &document.assignments()).unwrap();
    assert_eq!(scene.fabrics[0].yarn.ply_pitch_mm, Some(pitch));
    document.set("yarn.ply_pitch_mm", "untwisted").unwrap();
    assert_eq!(document.set_line("yarn.ply_pitch_mm"), "--set yarn.ply_pitch_mm=untwisted");
    document.set("ambient.environment", "it's a sky.exr").unwrap();
    assert_eq!(
        document.set_line("ambient.environment"),
        r#"--set 'ambient.environment="it'\''s a sky.exr"'"#
    );
}

#[test]
fn a_saved_scene_keeps_its_comments_and_finds_its_files_from_another_folder() {
    let home = Home::new();
    let mut document = home.open(SCENE);
    document.set("yarn.ply_count", 4).unwrap();
    let away = home.0.path().join("away");
    std::fs::create_dir(&away).unwrap();
    document.save(&away.join("scene.toml")).unwrap();
    let text = std::fs::read_to_string(away.join("scene.toml")).unwrap();
    assert!(text.starts_with("# Mine.\n[fabric]\nmodel = \"../yarn.obj\" # from a friend\n"), "{text}");
    let scene = Scene::load(&away.join("scene.toml"), &[]).unwrap();
    assert_eq!(&scene.file, document.scene_file());
    assert_eq!(scene.fabrics[0].yarn.ply_count, 4);
    let again = Scene::from_file(document.scene_file().clone(), document.folder(), "scene").unwrap();
    assert_eq!(again.fabrics[0].yarn, scene.fabrics[0].yarn);
    // What is undone behind the save finds them as well.
    assert!(document.undo() && document.is_unsaved());
    Scene::from_file(document.scene_file().clone(), document.folder(), "scene").unwrap();
    for (path, expected) in [("scene.txt", "ends in .toml"), ("none/scene.toml", "no folder")] {
        let error = document.save(&away.join(path)).unwrap_err().to_string();
        assert!(error.contains(expected) && !error.contains('\n'), "{error}");
        assert!(!away.join(path).exists() && document.path().starts_with(&away));
    }
}

#[test]
fn a_bare_yarn_file_becomes_a_scene_around_it() {
    let home = Home::new();
    let yarn = home.0.path().join("yarn.obj");
    let mut document = Document::open(&yarn).unwrap();
    assert!(document.is_bare() && !document.is_unsaved());
    document.set("yarn.ply_count", 2).unwrap();
    document.set("fabric.0.mm_per_unit", 10.0).unwrap();
    let bare = Scene::load(&yarn, &document.assignments()).unwrap();
    document.save(&home.0.path().join("made.toml")).unwrap();
    let made = Scene::load(&home.0.path().join("made.toml"), &[]).unwrap();
    assert_eq!(bare.fabrics[0].yarn, made.fabrics[0].yarn);
    assert_eq!((bare.fabrics[0].mm_per_unit, made.fabrics[0].mm_per_unit), (10.0, 10.0));
    assert!(!document.is_bare() && std::fs::read_to_string(&yarn).unwrap() == YARN);
    for (name, text, expected) in
        [("a.toml", "[camera]\nfov_y_deg = 500\n", "line 2: camera.fov_y_deg"), ("b.toml", "a b", "line 1")]
    {
        let error = Document::open(&home.file(name, text)).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains(name) && !error.contains('\n'), "{error}");
    }
    assert!(Document::open(&home.0.path().join("none.bcc")).is_err());
}

#[test]
fn where_a_key_is_absent_a_value_to_start_from_is_accepted() {
    let mut document = Home::new().open(SCENE);
    document.note_automatic("camera.distance_mm", 123.0);
    assert_eq!(document.start_value("camera.distance_mm"), Some(Value::Float(123.0)));
    let optional =
        |row: &&Parameter| row.optional && row.group != Group::Light && !matches!(row.kind, Kind::File);
    for row in parameters().iter().filter(optional) {
        let path = numbered(row);
        let start = document.start_value(&path).unwrap();
        document.set(&path, start).unwrap();
        assert!(document.undo());
    }
    let diffuse = document.start_value("fiber.color").unwrap();
    assert!(diffuse[0].as_float().unwrap() > 0.2, "{diffuse}");
}
