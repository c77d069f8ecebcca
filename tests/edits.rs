//! A renderer whose scene is edited draws what one that was built for the edited scene draws.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

use std::path::Path;
use worsted::frame::sampling::Sampling;
use worsted::frame::tables::Tables;
use worsted::frame::{Picture, Renderer, Request};
use worsted::io::kept::Kept;
use worsted::scene::Scene;
use worsted::vulkan::{Device, DeviceChoice, DeviceOptions};

#[path = "support/device.rs"]
mod device;
use device::shared;

const SIZE: [u32; 2] = [96, 72];

fn scene(sets: &[&str]) -> Scene {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    Scene::load(Path::new("models/demo.toml"), &sets).unwrap()
}

fn request(size: [u32; 2], samples: u32) -> Request {
    Request { size, sampling: Sampling::new(samples).unwrap(), statistics: false, profile: false }
}

fn renderer(sets: &[&str]) -> Renderer {
    Renderer::new(shared(DeviceChoice::Software), scene(sets), request(SIZE, 4)).unwrap()
}

fn fresh(sets: &[&str], size: [u32; 2], samples: u32) -> Picture {
    Renderer::new(shared(DeviceChoice::Software), scene(sets), request(size, samples))
        .unwrap()
        .render(&|_| ())
        .unwrap()
}

fn assert_same(found: &Picture, expected: &Picture, what: &str) {
    assert_eq!(found.size, expected.size, "{what}");
    assert!(found.linear == expected.linear, "{what}: the radiance differs");
    assert!(found.display == expected.display, "{what}: the display differs");
}

/// Edits with other tables, and what they are called.
const EDITS: [(&str, &[&str]); 5] = [
    ("a pitch", &["yarn.ply_pitch_mm=3.1"]),
    ("hairs", &["yarn.hair_density_per_mm=6", "yarn.hair_length_mm=[3, 0.5]"]),
    ("a color", &["fiber.color=[0.4, 0.05, 0.05]"]),
    ("plies", &["yarn.ply_count=2"]),
    ("no shadows", &["shadow.map=false", "shadow.self=false", "shading.model='simple'"]),
];

#[test]
fn an_edited_scene_is_drawn_as_if_it_had_been_there_from_the_start() {
    let mut renderer = renderer(&[]);
    renderer.render(&|_| ()).unwrap();
    for (what, sets) in EDITS {
        let edited = scene(sets);
        let tables = Tables::bake(&edited, &request(SIZE, 4), &Kept::NOTHING).unwrap();
        renderer.edit(edited, tables).unwrap();
        assert_same(&renderer.render(&|_| ()).unwrap(), &fresh(sets, SIZE, 4), what);
    }
}

#[test]
fn what_needs_no_table_is_edited_in_place_and_all_else_is_not() {
    let mut edited = renderer(&[]);
    for sets in [
        &["camera.yaw_deg=70", "camera.distance_mm=30"][..],
        &["light=[{direction = [1, -1, 0], irradiance = [3, 1, 1]}]"],
        &["display.exposure_stops=1.5", "display.tone='filmic'", "display.background=[1, 0, 0]"],
        &[],
    ] {
        assert!(edited.edit_in_place(&scene(sets).file).unwrap(), "{sets:?}");
        assert_same(&edited.render(&|_| ()).unwrap(), &fresh(sets, SIZE, 4), &format!("{sets:?}"));
    }
    let before = edited.render(&|_| ()).unwrap();
    for set in [
        "yarn.ply_pitch_mm=3",
        "light=[{angular_size_deg = 9}]",
        "shading.ambient=false",
        "seed=4",
        "quality.max_subdivisions=3",
    ] {
        assert!(!edited.edit_in_place(&scene(&[set]).file).unwrap(), "{set}");
    }
    assert_same(
        &edited.render(&|_| ()).unwrap(),
        &before,
        "what could not be edited in place is not edited at all",
    );
}

#[test]
fn sizes_and_samples_may_change_but_for_the_samples_of_a_frame() {
    let mut renderer = renderer(&[]);
    renderer.render(&|_| ()).unwrap();
    for (size, samples) in [([48, 36], 4), ([96, 72], 16), ([50, 50], 4), (SIZE, 4)] {
        renderer.set_request(request(size, samples)).unwrap();
        assert_same(
            &renderer.render(&|_| ()).unwrap(),
            &fresh(&[], size, samples),
            &format!("{size:?} {samples}"),
        );
    }
    assert!(renderer.set_request(request(SIZE, 1)).is_err());
    assert!(renderer.set_request(Request { statistics: true, ..request(SIZE, 4) }).is_err());
}

#[test]
fn a_picture_that_is_given_up_leaves_no_trace() {
    let sets = &["quality.curves_per_submission=1000"];
    let mut renderer = renderer(sets);
    let expected = renderer.render(&|_| ()).unwrap();
    let asked = std::cell::Cell::new(0);
    let stops = |_| {
        asked.set(asked.get() + 1);
        asked.get() < 3
    };
    assert!(renderer.render_while(&stops).unwrap().is_none());
    assert_eq!(asked.get(), 3, "it stops where it is told to");
    assert_same(&renderer.render(&|_| ()).unwrap(), &expected, "after one that was given up");
}

#[test]
fn old_tables_stand_for_new_ones_only_where_they_have_the_same_shape() {
    let of = |sets: &[&str]| (scene(sets), request(SIZE, 4));
    let (old, asked) = of(&[]);
    let tables = Tables::bake(&old, &asked, &Kept::NOTHING).unwrap();
    let stands = |sets: &[&str]| tables.may_stand_for(&scene(sets), &asked);
    assert!(stands(&[]) && stands(&["yarn.ply_pitch_mm=3"]) && stands(&["fiber.color=[0.4, 0.1, 0.1]"]));
    assert!(stands(&["shadow.self=false"]), "a table too many does no harm");
    for set in [
        "yarn.ply_count=2",
        "yarn.fibers_per_ply=1",
        "quality.scattering_entries=16",
        "quality.self_shadow_texels=16",
        "quality.core_texture_rows=16",
        "occlusion.mode='texture'",
        "yarn.ellipse_short_mm=0.01",
    ] {
        assert!(!stands(&[set]), "{set}");
    }
    // And what is drawn with them is near: the picture is of the new yarn.
    let mut renderer = Renderer::new(shared(DeviceChoice::Software), old, asked).unwrap();
    let before = renderer.render(&|_| ()).unwrap();
    renderer.edit(scene(&["yarn.ply_pitch_mm=3"]), tables.clone()).unwrap();
    let preview = renderer.render(&|_| ()).unwrap();
    let right = fresh(&["yarn.ply_pitch_mm=3"], SIZE, 4);
    let difference = |a: &Picture, b: &Picture| -> f64 {
        let pixels = a.display.iter().zip(&b.display);
        pixels.map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>()).sum()
    };
    assert!(
        difference(&preview, &right) < 0.1 * difference(&before, &right),
        "the preview is far from the picture"
    );
}

#[test]
fn tables_are_on_a_device_once_and_go_with_the_last_that_draws_with_them() {
    let options = DeviceOptions { choice: DeviceChoice::Software, ..Default::default() };
    let device = Device::new(&options).unwrap();
    let bytes_of = |name: &str| device.memory_bytes().get(name).copied().unwrap_or(0);
    let tables = Tables::bake(&scene(&[]), &request(SIZE, 4), &Kept::NOTHING).unwrap();
    let of = |sets: &[&str]| {
        Renderer::with_tables(&device, scene(sets), request(SIZE, 4), tables.clone(), &Kept::NOTHING).unwrap()
    };
    let first = of(&[]);
    let once = ["core normals", "scattering table", "self-shadow table"].map(bytes_of);
    assert!(once.iter().all(|bytes| *bytes > 0), "{once:?}");
    let second = of(&["yarn.ply_pitch_mm=3"]);
    assert_eq!(["core normals", "scattering table", "self-shadow table"].map(bytes_of), once);
    assert!(bytes_of("curves") > 0);
    drop((first, second, tables));
    Device::shutdown(device).unwrap();
}

#[test]
fn a_fabric_comes_to_rest_only_where_it_is_made_anew() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("waving.gltf");
    let knit = std::process::Command::new(env!("CARGO_BIN_EXE_worsted"))
        .args(["knit", "stockinette", "--wales", "2", "--courses", "2", "--animate", "wave", "-o"])
        .arg(&path)
        .status();
    assert!(knit.unwrap().success());
    let scene = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        Scene::load(&path, &sets).unwrap()
    };
    let at = ["animation.frame=2"];
    let mut renderer = Renderer::new(shared(DeviceChoice::Software), scene(&at), request(SIZE, 4)).unwrap();
    assert!(renderer.edit_in_place(&scene(&["animation.frame=5"]).file).unwrap());
    assert!(!renderer.edit_in_place(&scene(&[]).file).unwrap(), "to rest");
    renderer = Renderer::new(shared(DeviceChoice::Software), scene(&[]), request(SIZE, 4)).unwrap();
    assert!(!renderer.edit_in_place(&scene(&at).file).unwrap(), "from rest");
}
