//! `worsted play`: pictures that are there are kept, and taken for no others; what is wrong names the frame.

use super::process::{Workplace, assert_good, swatch};
use serde_json::Value;
use std::os::unix::fs::PermissionsExt;
use worsted::io::bcc::{read_bcc, write_bcc};
use worsted::io::curves::CurveSet;
use worsted::io::picture::read_exr;

/// The swatch close up in a thin yarn, in pictures of few pixels.
const SMALL: [&str; 12] = [
    "--device",
    "software",
    "--size",
    "32x24",
    "--samples",
    "1",
    "--set",
    "fabric.mm_per_unit=1",
    "--set",
    "yarn.fibers_per_ply=6",
    "--set",
    "camera.distance_mm=60",
];

/// The shipped swatch, moved along.
fn moved(by_mm: f64) -> CurveSet {
    let mut set = read_bcc(swatch().as_ref()).unwrap().curves;
    for (curve, point) in
        set.curves.iter_mut().enumerate().flat_map(|(i, c)| c.points.iter_mut().map(move |p| (i, p)))
    {
        point.x += by_mm * (1.0 + 0.1 * curve as f64) + 0.1 * by_mm * point.y;
    }
    set
}

/// A place with raw frames and numbered files of the same four frames.
fn place() -> Workplace {
    let place = Workplace::new();
    let mut raw = Vec::new();
    for frame in 0..4 {
        let set = moved(f64::from(frame));
        let points = set.curves.iter().flat_map(|curve| &curve.points).flat_map(|p| p.as_vec3().to_array());
        raw.extend(points.flat_map(f32::to_le_bytes));
        write_bcc(&place.path(&format!("cloth.{frame:02}.bcc")), &set).unwrap();
    }
    place.write("frames.f32", raw);
    place
}

fn play(place: &Workplace, motion: &str, more: &[&str]) -> std::process::Output {
    let swatch = swatch();
    place.run(&[&["play", &swatch, "--motion", motion, "-q"][..], &SMALL, more].concat())
}

#[test]
fn both_kinds_of_frames_give_the_same_pictures_and_a_still_is_one_of_them() {
    let place = place();
    assert_good(&play(
        &place,
        "frames.f32",
        &["-o", "raw/%02d.png", "-o", "raw/%02d.exr", "--stats", "stats.json"],
    ));
    assert_good(&play(&place, "cloth.%02d.bcc", &["-o", "numbered/%02d.png", "--frames", "0..4"]));
    let pictures: Vec<Vec<u8>> = (0..4).map(|i| place.read(&format!("raw/{i:02}.png"))).collect();
    for (i, picture) in pictures.iter().enumerate() {
        assert!(*picture == place.read(&format!("numbered/{i:02}.png")), "frame {i}");
        assert!(pictures[..i].iter().all(|other| other != picture), "frame {i} shows another place");
    }
    let stats: Value = serde_json::from_slice(&place.read("stats.json")).unwrap();
    let of = |i: usize| &stats["pictures"][i];
    assert_eq!((of(3)["picture"].as_u64(), of(3)["frame"].as_f64()), (Some(3), Some(3.0)));
    let points = stats["gpu_bytes"]["control points"].as_u64().unwrap();
    let skies = stats["gpu_bytes"]["skies"].as_u64().unwrap();
    let uploaded = of(2)["uploaded_bytes"].as_u64().unwrap();
    // No more than what moves: 16 bytes a point and 8 for its sky. Memory is given out in larger steps.
    let control_points = stats["control_points"].as_u64().unwrap();
    assert!((24 * control_points..=points + skies).contains(&uploaded), "{uploaded} {points} {skies}");

    let swatch = swatch();
    let still =
        [&["render", &swatch, "--motion", "frames.f32", "-q", "--frame", "2", "-o", "2.png"][..], &SMALL];
    assert_good(&place.run(&still.concat()));
    assert!(place.read("2.png") == pictures[2], "a still is a picture of the film");
    // Half as fast, a picture between two frames; and the smooth curve is another.
    let slow = ["--set", "animation.speed=0.5", "-o", "slow/%d.png", "--frames", "2..=3"];
    assert_good(&play(&place, "frames.f32", &slow));
    assert!(place.read("slow/2.png") == pictures[1] && place.read("slow/3.png") != pictures[1]);
}

#[test]
fn a_run_goes_on_where_it_stopped_and_spares_other_pictures() {
    let place = place();
    let out = ["-o", "f/%d.png"];
    assert_good(&play(&place, "frames.f32", &[&out[..], &["--frames", "1..3"]].concat()));
    let (first, second) = (place.read("f/1.png"), place.read("f/2.png"));
    // What stands there stays, and what is missing comes.
    place.write("f/1.png", b"kept");
    std::fs::remove_file(place.path("f/2.png")).unwrap();
    assert_good(&play(&place, "frames.f32", &[&out[..], &["--stats", "s.json"]].concat()));
    assert!(place.read("f/1.png") == b"kept" && place.read("f/2.png") == second);
    let stats: Value = serde_json::from_slice(&place.read("s.json")).unwrap();
    assert_eq!((stats["skipped"].as_u64(), stats["pictures"].as_array().unwrap().len()), (Some(1), 3));
    // Of another seed: refused, unless asked for.
    let swatch = swatch();
    let other =
        [&["play", &swatch, "--motion", "frames.f32", "-q", "--seed", "9"][..], &SMALL, &out].concat();
    place.refuses(&other, 2, &["f/play.png.txt", "expected pictures of the same scene", "--fresh"]);
    assert_good(&place.run(&[&other[..], &["--fresh"]].concat()));
    assert!(place.read("f/1.png") != first && place.read("f/1.png") != b"kept");
}

#[test]
fn what_is_wrong_with_a_motion_names_the_frame() {
    let place = place();
    let swatch = swatch();
    let refuses = |more: &[&str], needles: &[&str]| {
        place.refuses(&[&["play", &swatch, "-q", "-o", "%d.png"][..], &SMALL, more].concat(), 2, needles);
    };
    refuses(&[], &["expected fabric.motion or --motion"]);
    refuses(&["--motion", "away.f32"], &["away.f32", "cannot read"]);
    refuses(&["--motion", "cloth.%03d.bcc"], &["cloth.%03d.bcc", "expected at least one"]);
    refuses(&["--motion", "frames.f32", "--frames", "2..5"], &["--frames 2..5", "0..4"]);
    refuses(&["--motion", "frames.f32", "--set", "animation.speed=0"], &["animation.speed = 0"]);
    let raw = place.read("frames.f32");
    place.write("cut.f32", &raw[..raw.len() - 7]);
    refuses(&["--motion", "cut.f32"], &["cut.f32: frame 3: expected"]);
    let mut broken = raw.clone();
    broken[raw.len() / 2..raw.len() / 2 + 4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    place.write("broken.f32", &broken);
    refuses(&["--motion", "broken.f32"], &["broken.f32: frame 2: point 0: expected a finite"]);
    let mut shorter = moved(0.0);
    shorter.curves[0].points.pop();
    write_bcc(&place.path("cloth.01.bcc"), &shorter).unwrap();
    refuses(&["--motion", "cloth.%02d.bcc"], &["cloth.01.bcc: frame 1: curve 0: expected"]);
    std::fs::remove_file(place.path("cloth.01.bcc")).unwrap();
    refuses(&["--motion", "cloth.%02d.bcc"], &["cloth.01.bcc: frame 1: expected"]);
    let render = [&["render", &swatch, "-q", "-o", "x.png"][..], &SMALL].concat();
    place.refuses(
        &[&render[..], &["--frame", "1"]].concat(),
        2,
        &["animation.frame: expected a fabric with a motion"],
    );
    let behind = [&render[..], &["--motion", "frames.f32", "--frame", "3.5"]].concat();
    place.refuses(&behind, 2, &["frames.f32: frame 3: expected a frame of 0 to 3, found 3.5"]);
    assert_good(&place.run(&[&behind[..], &["--set", "animation.repeat=true"]].concat()));
}

#[test]
fn a_film_is_made_by_the_ffmpeg_on_the_path() {
    let place = place();
    // It says what it was called with, and fails where the name asks for it.
    let script = "#!/bin/sh\nfor last; do :; done\ncase \"$*\" in\n-version) ;;\n*-framerate\\ 12*) echo broken >&2; exit 3;;\n\
                  *) pwd > \"$last\"; echo \"$*\" >> \"$last\";;\nesac\n";
    place.write("bin.sh", script);
    std::fs::create_dir(place.path("bin")).unwrap();
    std::fs::rename(place.path("bin.sh"), place.path("bin/ffmpeg")).unwrap();
    std::fs::set_permissions(place.path("bin/ffmpeg"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let swatch = swatch();
    let play = [&["play", &swatch, "--motion", "frames.f32", "-q", "-o", "f/%02d.png"][..], &SMALL].concat();
    let play = [&play[..], &["--frames", "1..3", "--encode", "film.mp4"]].concat();
    let system = std::env::var("PATH").unwrap();
    let path = format!("{}:{system}", place.path("bin").display());
    let with = |arguments: &[&str], path: &str| place.run_with(arguments, &[("PATH", path)]);
    assert_good(&with(&play, &path));
    let said = String::from_utf8(place.read("film.mp4")).unwrap();
    assert!(said.lines().next().unwrap().ends_with("/f"), "{said}");
    assert!(said.contains("-framerate 24 -start_number 1 -i %02d.png -frames:v 2"), "{said}");
    let failed = with(&[&play[..], &["--fresh", "--set", "animation.frames_per_second=12"]].concat(), &path);
    let error = String::from_utf8_lossy(&failed.stderr).into_owned();
    assert!(failed.status.code() == Some(2) && error.contains("ffmpeg: broken"), "{error}");
    let empty = place.path("f").display().to_string();
    let none = with(&play, &empty);
    assert!(String::from_utf8_lossy(&none.stderr).contains("expected an ffmpeg on the PATH"));
    assert!(place.contents().keys().all(|name| !name.starts_with(".worsted")), "{:?}", place.contents());
}

#[test]
fn generated_fabric_moves_by_morph_targets_and_by_a_skin() {
    let place = Workplace::new();
    let small = ["--courses", "2", "--wales", "3"];
    let knit = |pattern: &str, size: &[&str], animate: &str, name: &str| {
        place.run(&[&["knit", pattern, "--animate", animate, "-o", name][..], size].concat())
    };
    assert_good(&knit("stockinette", &small, "wave", "swatch.gltf"));
    assert_good(&knit("tube", &["--courses", "2", "--wales", "10"], "bend", "sleeve.gltf"));
    for (name, frames) in [("swatch", "0..3"), ("sleeve", "22..25")] {
        let (model, out) = (format!("{name}.gltf"), format!("{name}/%02d.png"));
        let play = [
            &["play", &model, "-q", "-o", &out, "--frames", frames, "--set", "camera.yaw_deg=60"][..],
            &SMALL[..6],
        ];
        assert_good(&place.run(&play.concat()));
        let first: u64 = frames.split_once("..").unwrap().0.parse().unwrap();
        let picture = |i: u64| place.read(&format!("{name}/{:02}.png", first + i));
        assert!(picture(0) != picture(1) && picture(1) != picture(2), "{name}");
    }
    let info = place.run(&["info", "sleeve.gltf"]);
    assert!(String::from_utf8_lossy(&info.stdout).contains("format: glTF"));
    place.refuses(&["knit", "stockinette", "--animate", "wave", "-o", "a.bcc"], 2, &["a.bcc", ".gltf"]);
    place.refuses(&["knit", "stockinette", "-o", "a.obj"], 2, &["a.obj", ".bcc or .gltf"]);
}

#[test]
fn layers_go_into_exr_pictures_and_change_no_light() {
    let place = place();
    assert_good(&play(&place, "frames.f32", &["-o", "plain/%02d.exr", "--frames", "0..3"]));
    let layered =
        ["-o", "layered/%02d.exr", "-o", "layered/%02d.png", "--frames", "0..3", "--layers", "motion,id"];
    assert_good(&play(&place, "frames.f32", &[&layered[..], &["--stats", "stats.json"]].concat()));
    let stats: Value = serde_json::from_slice(&place.read("stats.json")).unwrap();
    let points = stats["control_points"].as_u64().unwrap();
    // 16 bytes a point for each of three frames, and 8 for its sky.
    let uploaded = stats["pictures"][1]["uploaded_bytes"].as_u64().unwrap();
    assert!(uploaded >= (3 * 16 + 8) * points, "{uploaded} for {points}");
    for i in 0..3 {
        let [plain, layered] = ["plain", "layered"].map(|folder| format!("{folder}/{i:02}.exr"));
        assert!(place.read(&layered).len() > place.read(&plain).len());
        assert_good(&place.run(&["compare", &layered, &plain, "--fail-above", "0"]));
        let [plain, layered] = [plain, layered].map(|name| read_exr(&place.path(&name)).unwrap());
        assert!(plain == layered, "picture {i}");
    }
    // A still is one of them, layers and all, whoever asked for them.
    let swatch = swatch();
    let motion = place.path("frames.f32").display().to_string();
    let still = |more: &[&str]| {
        let named = ["render", &swatch, "--motion", &motion, "--frame", "1", "-q"];
        place.run(&[&named[..], &SMALL, more].concat())
    };
    assert_good(&still(&["-o", "still.exr", "--layers", "id,motion"]));
    assert!(place.read("still.exr") == place.read("layered/01.exr"));
    assert_good(&still(&["-o", "keys.exr", "--set", "layers.motion=true", "--set", "layers.id=true"]));
    assert!(place.read("keys.exr") == place.read("layered/01.exr"));
    let refused = still(&["-o", "still.png", "--layers", "motion"]);
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(
        said.contains("--layers: expected an .exr picture") && said.trim_end().lines().count() == 1,
        "{said}"
    );
    assert!(!place.path("still.png").exists());
    let refused = play(&place, "frames.f32", &["-o", "png/%02d.png", "--layers", "id"]);
    assert_eq!(refused.status.code(), Some(2));
    let unknown = still(&["-o", "still.exr", "--layers", "depth"]);
    assert_eq!(unknown.status.code(), Some(2), "{}", String::from_utf8_lossy(&unknown.stderr));
    // Pictures without layers are others than those with.
    let others = play(&place, "frames.f32", &["-o", "plain/%02d.exr", "--frames", "0..3", "--layers", "id"]);
    assert_eq!(others.status.code(), Some(2), "{}", String::from_utf8_lossy(&others.stderr));
}
