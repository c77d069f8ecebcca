//! The viewer's painter without its window: what it shows, in which order, and that it ends on the picture that
//! `worsted render` draws.
#![expect(clippy::unwrap_used, clippy::panic, reason = "the helpers of a test may fail it")]
#![cfg(feature = "viewer")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::kept::Kept;
use worsted::scene::Scene;
use worsted::shaders::ShaderSet;
use worsted::viewer::painter::{News, Painter, Shown, Wanted};
use worsted::vulkan::{Device, DeviceChoice};

#[path = "support/device.rs"]
mod device;
#[path = "../src/shaders/glsl.rs"]
mod glsl;

/// A file of a demo that is small enough to be drawn again and again.
const SCENE: &str = "models/demo.toml";
const SIZE: [u32; 2] = [96, 72];
/// Longer than any picture takes on the slowest machine.
const PATIENCE: Duration = Duration::from_secs(120);

fn shared() -> &'static Arc<Device> {
    device::shared(DeviceChoice::Software)
}

fn wanted(sets: &[&str]) -> Wanted {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    Wanted {
        file: Scene::load(Path::new(SCENE), &sets).unwrap().file,
        folder: PathBuf::from("models"),
        name: SCENE.to_owned(),
        size: SIZE,
        moving: false,
        statistics: false,
        most_samples: 16,
        shaders: ShaderSet::default(),
    }
}

fn painter() -> Painter {
    Painter::start(shared().clone(), Kept::NOTHING, || ())
}

fn next(painter: &Painter) -> Shown {
    match painter.news.recv_timeout(PATIENCE).expect("a picture") {
        News::Picture(shown) => *shown,
        News::Trouble(why) => panic!("{why}"),
        News::Ended(error) => panic!("{error}"),
    }
}

/// The first picture of this wish.
fn next_of(painter: &Painter, revision: u64) -> Shown {
    let mut shown = next(painter);
    while shown.revision < revision {
        shown = next(painter);
    }
    assert_eq!(shown.revision, revision);
    shown
}

/// Every picture up to the one that nothing better follows.
fn until_settled(painter: &Painter) -> Vec<Shown> {
    let mut all = vec![next(painter)];
    while !all.last().unwrap().settled {
        all.push(next(painter));
    }
    all
}

/// What `worsted render` draws.
fn rendered(sets: &[&str], samples: u32) -> Vec<[u8; 4]> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scene = Scene::load(Path::new(SCENE), &sets).unwrap();
    let sampling = Sampling::new(samples).unwrap();
    let request = Request { size: SIZE, sampling, statistics: false, profile: false };
    Renderer::new(shared(), scene, request).unwrap().render(&|_| ()).unwrap().display
}

#[test]
fn pictures_are_refined_until_they_are_what_render_draws() {
    let painter = painter();
    painter.want(wanted(&[]));
    let shown = until_settled(&painter);
    let samples: Vec<_> =
        shown.iter().map(|shown| (shown.picture.size == SIZE, shown.stats.samples)).collect();
    assert!(samples.ends_with(&[(true, 4), (true, 16)]), "{samples:?}");
    assert!(shown.last().unwrap().picture.display == rendered(&[], 16));
    let camera = &shown.last().unwrap().camera;
    assert!(camera.distance_mm.is_some() && camera.target_mm.is_some() && camera.pitch_deg.is_some());
    // Wanting the same again draws it again, and no table is baked twice.
    painter.want(wanted(&[]));
    assert!(until_settled(&painter).last().unwrap().picture.display == rendered(&[], 16));
}

#[test]
fn an_edit_is_seen_before_its_tables_are_there_and_ends_with_them() {
    let painter = painter();
    painter.want(wanted(&[]));
    until_settled(&painter);
    let sets = &["yarn.ply_pitch_mm=3.2"];
    let revision = painter.want(wanted(sets));
    let shown = until_settled(&painter);
    assert!(shown.iter().all(|shown| shown.revision == revision));
    assert!(!shown[0].own_tables && shown.last().unwrap().own_tables);
    assert!(shown.iter().filter(|shown| !shown.own_tables).all(|shown| shown.stats.samples <= 4));
    assert!(shown.last().unwrap().picture.display == rendered(sets, 16));
    // Of another shape: nothing stands for it.
    let sets = &["yarn.ply_count=2"];
    painter.want(wanted(sets));
    let shown = until_settled(&painter);
    assert!(shown.iter().all(|shown| shown.own_tables));
    assert!(shown.last().unwrap().picture.display == rendered(sets, 16));
}

#[test]
fn a_value_that_is_dragged_there_and_back_leaves_no_trace() {
    let painter = painter();
    painter.want(wanted(&[]));
    until_settled(&painter);
    for pitch in ["4.25", "5.5", "7.0"] {
        let sets = &[&*format!("yarn.ply_pitch_mm={pitch}"), "camera.yaw_deg=5"];
        let revision = painter.want(Wanted { moving: true, ..wanted(sets) });
        let shown = next_of(&painter, revision);
        assert!(!shown.own_tables && !shown.settled);
        assert_eq!(shown.file.yarn["ply_pitch_mm"].as_float(), pitch.parse().ok());
    }
    painter.want(wanted(&["camera.yaw_deg=5"]));
    let shown = until_settled(&painter);
    assert!(shown.last().unwrap().picture.display == rendered(&["camera.yaw_deg=5"], 16));
}

#[test]
fn only_what_was_wanted_last_is_drawn_to_the_end() {
    let painter = painter();
    let mut last = 0;
    for yaw in 0..20 {
        last = painter.want(wanted(&[&format!("camera.yaw_deg={yaw}")]));
    }
    let shown = until_settled(&painter);
    assert_eq!(shown.last().unwrap().revision, last);
    assert!(shown.last().unwrap().picture.display == rendered(&["camera.yaw_deg=19"], 16));
    assert!(shown.iter().filter(|shown| shown.settled).count() == 1);
}

#[test]
fn while_something_moves_one_picture_answers_each_wish() {
    let painter = painter();
    painter.want(wanted(&[]));
    until_settled(&painter);
    for yaw in 1..6 {
        let moving = Wanted { moving: true, ..wanted(&[&format!("camera.yaw_deg={yaw}")]) };
        let revision = painter.want(moving);
        let shown = next(&painter);
        assert!(shown.revision == revision && !shown.settled && shown.stats.samples <= 4);
        assert_eq!(shown.file.camera.yaw_deg, f64::from(yaw));
    }
    assert!(painter.news.recv_timeout(Duration::from_millis(300)).is_err(), "nothing follows by itself");
}

#[test]
fn what_cannot_be_had_is_told_and_changes_nothing() {
    let painter = painter();
    painter.want(wanted(&[]));
    until_settled(&painter);
    let mut impossible = wanted(&[]);
    impossible.file.fabric[0].model = "nowhere.bcc".into();
    painter.want(impossible);
    let told = painter.news.recv_timeout(PATIENCE).unwrap();
    assert!(matches!(told, News::Trouble(why) if why.contains("nowhere.bcc") && !why.contains('\n')));
    painter.want(wanted(&["camera.yaw_deg=3"]));
    assert!(until_settled(&painter).last().unwrap().picture.display == rendered(&["camera.yaw_deg=3"], 16));
}

#[test]
fn a_painter_that_is_stopped_leaves_nothing_on_the_device() {
    let device = {
        let choice = DeviceChoice::Software;
        Device::new(&worsted::vulkan::DeviceOptions { choice, ..Default::default() }).unwrap()
    };
    let mut painter = Painter::start(device.clone(), Kept::NOTHING, || ());
    painter.want(wanted(&[]));
    next(&painter);
    painter.want(wanted(&["yarn.ply_pitch_mm=3"]));
    painter.stop();
    while painter.news.try_recv().is_ok() {}
    drop(painter);
    Device::shutdown(device).unwrap();
}

const TONEMAP: &str = "passes/tonemap.comp";
const SHADED: [&str; 2] = ["passes/fibers.frag", "passes/core.frag"];

/// The embedded shaders, in some of which a text that stands there once is replaced.
fn changed(shaders: &[&str], from: &str, to: &str) -> ShaderSet {
    let read = |path: &str| std::fs::read_to_string(Path::new("glsl").join(path)).map_err(|e| e.to_string());
    let compiled = |shader: &&str| {
        let text =
            |path: &str| Ok(if path == *shader { read(path)?.replacen(from, to, 1) } else { read(path)? });
        assert!(read(shader).unwrap().contains(from), "{shader}: {from}");
        let words = glsl::compile(shader, glsl::stage_of(shader).unwrap(), &text).unwrap();
        (shader.to_string(), words)
    };
    ShaderSet::replacing(shaders.iter().map(compiled).collect())
}

/// No fiber is shaded at its vertices, where its fragment shader does nothing.
const AT_PIXELS: &str = "quality.vertex_shaded_samples=0";

#[test]
fn changed_shaders_change_the_picture_and_the_embedded_ones_bring_it_back() {
    let painter = painter();
    painter.want(wanted(&[AT_PIXELS]));
    let first = until_settled(&painter).pop().unwrap();
    let drawn = |shaders: &ShaderSet| {
        painter.want(Wanted { shaders: shaders.clone(), ..wanted(&[AT_PIXELS]) });
        let shown = until_settled(&painter).pop().unwrap();
        assert_eq!(shown.refused, None);
        shown
    };
    let swapped = drawn(&changed(&[TONEMAP], "vec4(encoded, alpha)", "vec4(encoded.bgr, alpha)"));
    let expected: Vec<_> = first.picture.display.iter().map(|&[r, g, b, a]| [b, g, r, a]).collect();
    assert!(swapped.picture.display == expected && swapped.picture.linear == first.picture.linear);
    assert_eq!(swapped.stats.pipelines_built, first.stats.pipelines_built + 1, "no other pipeline uses it");
    let radiance = "radiance = strand_color(strand);";
    let red = drawn(&changed(&SHADED, radiance, "radiance = vec4(strand_color(strand).r, 0.0, 0.0, 1.0);"));
    let covered: Vec<_> = red.picture.linear.iter().filter(|pixel| pixel[3] > 0.0).collect();
    assert!(covered.len() > 500 && covered.iter().all(|pixel| pixel[1] == 0.0 && pixel[2] == 0.0));
    assert!(covered.iter().any(|pixel| pixel[0] > 0.0));
    let again = drawn(&ShaderSet::default());
    assert!(again.picture.display == first.picture.display, "to the byte");
    assert_eq!(again.stats.pipelines_built, red.stats.pipelines_built, "what is embedded is there still");
}

#[test]
fn shaders_that_the_scene_has_no_place_for_are_refused_and_those_before_stay() {
    let painter = painter();
    let without = &["shadow.map=false", AT_PIXELS][..];
    let drawn = |sets: &[&str], shaders: &ShaderSet| {
        painter.want(Wanted { shaders: shaders.clone(), ..wanted(sets) });
        until_settled(&painter).pop().unwrap()
    };
    let swapped = changed(&[TONEMAP], "vec4(encoded, alpha)", "vec4(encoded.bgr, alpha)");
    let before = drawn(without, &swapped);
    let refused = |shaders: &ShaderSet, why: &str| {
        let shown = drawn(without, shaders);
        let said = shown.refused.clone().unwrap_or_default();
        assert!(said.contains(why), "expected {why:?} in {said:?}");
        assert!(shown.picture.display == before.picture.display, "{why}");
    };
    let radiance = "radiance = strand_color(strand);";
    let views = "radiance = strand_color(strand) + 0.0 * shadow_views[0].toward;";
    let of_shadows = changed(&SHADED, radiance, views);
    refused(&of_shadows, "set 0, binding 3");
    let of_vertices = "radiance = strand_color(strand) + 0.0 * vec4(fragment_radiance, 0.0);";
    refused(&changed(&SHADED[..1], radiance, of_vertices), "location 8");
    refused(&ShaderSet::replacing(BTreeMap::from([(TONEMAP.to_owned(), vec![1, 2, 3])])), "not SPIR-V");
    // What is wanted besides is done, and another scene may have a place for them.
    let elsewhere = drawn(&["shadow.map=false", AT_PIXELS, "camera.yaw_deg=9"], &of_shadows);
    assert!(elsewhere.refused.is_some() && elsewhere.picture.display != before.picture.display);
    let shadowed = drawn(&["shadow.map=true", AT_PIXELS], &of_shadows);
    assert_eq!(shadowed.refused, None);
    assert!(shadowed.picture.display == rendered(&["shadow.map=true", AT_PIXELS], 16));
}
