//! The built command, as a user runs it: what it writes, says and returns.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

mod bench;
mod compare;
mod errors;
mod export;
mod pipes;
mod play;
mod probe;
mod process;
mod reference;
mod stress;

use process::{Workplace, assert_good, error_fault, swatch};
use serde_json::Value;
use std::os::unix::process::ExitStatusExt;
use std::process::{ExitStatus, Output};

/// A part of the swatch in a thin yarn: quick, and some of it is outside the picture.
const CLOSE: [&str; 8] =
    ["--device", "software", "--size", "64x48", "--camera", "distance=25", "--set", "yarn.fibers_per_ply=12"];

/// Draws the swatch close up under validation, with `more` arguments.
fn render(place: &Workplace, more: &[&str]) -> Output {
    let swatch = swatch();
    let scene = ["render", &swatch, "-q", "--validate", "--set", "fabric.mm_per_unit=1"];
    place.run(&[&scene[..], &CLOSE, more].concat())
}

#[test]
fn the_same_command_writes_the_same_bytes_and_another_seed_others() {
    for samples in ["4", "16"] {
        let place = Workplace::new();
        let draw = |name: &str, seed: &str| {
            let (png, exr) = (format!("{name}.png"), format!("{name}.exr"));
            assert_good(&render(&place, &["--samples", samples, "--seed", seed, "-o", &png, "-o", &exr]));
            (place.read(&png), place.read(&exr))
        };
        let (first, again, other) = (draw("first", "1"), draw("again", "1"), draw("other", "2"));
        assert!(first.0.starts_with(b"\x89PNG") && first.1.starts_with(b"\x76\x2f\x31\x01"));
        assert!(first == again, "{samples} samples: the same command must give the same bytes");
        assert!(first.0 != other.0 && first.1 != other.1, "{samples} samples: the seed must matter");
        assert_eq!(place.contents().len(), 6, "{:?}", place.contents());
    }
}

/// Every key of the statistics, and whether its value must be above 0.
const KEYS: [(&str, bool); 24] = [
    ("device", false),
    ("driver", false),
    ("size", false),
    ("samples", true),
    ("control_points", true),
    ("yarn_segments", true),
    ("fiber_curves", true),
    ("fiber_segments", true),
    ("triangles", true),
    ("patches_drawn", true),
    ("patches_culled", true),
    ("patches_coarse", false),
    ("patches_along_light", false),
    ("patches_softer_than_searched", false),
    ("frame_ms", false),
    ("passes", false),
    ("timing_method", false),
    ("precompute_ms", false),
    ("gpu_bytes", false),
    ("left_out", false),
    ("left_out_bytes", false),
    ("left_out_of_frame", false),
    ("nan_pixels", false),
    ("clamped_pixels", false),
];

/// Why statistics are not what they should be, if they are not.
fn stats_fault(stats: &Value) -> Option<String> {
    for (key, counted) in KEYS {
        let Some(value) = stats.get(key) else { return Some(format!("{key} is missing")) };
        if counted && value.as_u64().is_none_or(|n| n == 0) {
            return Some(format!("{key} = {value}"));
        }
    }
    let count = |key: &str| stats[key].as_u64();
    let frame = |key: &str| stats["frame_ms"][key].as_f64().unwrap_or(-1.0);
    let filled = |key: &str| stats[key].as_object().is_some_and(|o| !o.is_empty());
    let text = |key: &str| stats[key].as_str().is_some_and(|s| !s.is_empty());
    let checks = [
        (count("nan_pixels") == Some(0), "nan_pixels"),
        (
            0.0 < frame("min") && frame("min") <= frame("median") && frame("median") <= frame("max"),
            "frame_ms",
        ),
        (text("device") && text("driver"), "device"),
        (filled("gpu_bytes") && filled("precompute_ms") && stats["left_out"].is_object(), "tables"),
        (
            count("patches_drawn").zip(count("patches_culled")).map(|(a, b)| a + b) == count("yarn_segments"),
            "patches drawn and culled are all there are",
        ),
        (count("triangles") == count("fiber_segments").map(|n| 2 * n), "two triangles a piece of fiber"),
    ];
    checks.iter().find(|(good, _)| !good).map(|(_, what)| what.to_string())
}

/// The statistics of a profiled run with `more` arguments.
fn profiled(more: &[&str]) -> Value {
    let place = Workplace::new();
    let output = render(&place, &[&["--stats", "-", "--profile", "-o", "a.png"], more].concat());
    assert_good(&output);
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn statistics_have_every_key_and_add_up() {
    let stats = profiled(&[]);
    assert_eq!(stats_fault(&stats), None, "{stats:#}");
    assert_eq!(stats["size"], serde_json::json!([64, 48]));
    assert_eq!((&stats["samples"], &stats["frame_ms"]["frames"]), (&4.into(), &1.into()));
    assert!(stats["timing_method"].as_str().unwrap().contains("submission"), "{stats:#}");
    for pass in ["fibers", "resolve", "tonemap"] {
        assert!(stats["passes"][pass].as_f64().unwrap() > 0.0, "{pass}: {stats:#}");
    }
    // 36 fibers a piece of yarn.
    assert_eq!(stats["fiber_curves"].as_u64(), stats["yarn_segments"].as_u64().map(|n| 36 * n));
}

#[test]
fn statistics_count_one_frame_however_many_are_drawn() {
    let (once, thrice) = (profiled(&[]), profiled(&["--repeat", "3"]));
    assert_eq!(thrice["frame_ms"]["frames"], 3);
    for key in ["patches_drawn", "patches_culled", "fiber_segments", "triangles"] {
        assert_eq!(once[key], thrice[key], "{key}");
    }
}

#[test]
fn the_checker_of_statistics_rejects_wrong_ones() {
    let good = profiled(&[]);
    for (key, _) in KEYS {
        let mut wrong = good.clone();
        wrong.as_object_mut().unwrap().remove(key);
        assert!(stats_fault(&wrong).is_some(), "{key} is missing and nobody minds");
    }
    for (key, value) in [("patches_culled", 1.into()), ("nan_pixels", 1.into()), ("gpu_bytes", Value::Null)] {
        let mut wrong = good.clone();
        wrong[key] = value;
        assert!(stats_fault(&wrong).is_some(), "{key} is wrong and nobody minds");
    }
}

#[test]
fn statistics_go_to_a_file_and_passes_are_empty_unless_profiled() {
    let place = Workplace::new();
    let output = render(&place, &["--stats", "stats.json", "-o", "a.png"]);
    assert_good(&output);
    assert!(output.stdout.is_empty());
    let stats: Value = serde_json::from_slice(&place.read("stats.json")).unwrap();
    assert_eq!(stats_fault(&stats), None, "{stats:#}");
    assert!(stats["passes"].as_object().unwrap().is_empty() && stats["timing_method"].is_null(), "{stats:#}");
    assert_eq!(place.contents().len(), 2, "{:?}", place.contents());
}

#[test]
fn explain_says_what_was_left_out_and_why() {
    let place = Workplace::new();
    let matte =
        ["--explain", "--set", "shading.specular=false", "--set", "quality.culling=false", "-o", "a.png"];
    let output = render(&place, &matte);
    assert_good(&output);
    let said = String::from_utf8(output.stdout).unwrap();
    for line in [
        "left out: specular, because fiber.specular is 0, or shading.specular false",
        "left out: culling",
        "left out: environment, because",
        "device: ",
        "built: ",
    ] {
        assert!(said.contains(line), "expected {line:?}: {said}");
    }
}

#[test]
fn knitted_fabric_is_read_back() {
    let place = Workplace::new();
    let knit =
        ["knit", "stockinette", "--courses", "2", "--wales", "3", "--yarn-radius", "0.5", "-o", "k.bcc"];
    assert_good(&place.run(&knit));
    assert!(place.read("k.bcc").starts_with(b"BCC"));
    let info = place.run(&["info", "k.bcc"]);
    assert_good(&info);
    let said = String::from_utf8(info.stdout).unwrap();
    for line in ["format: BCC, CatmullRom", "up axis: Y", "curves: 1 (0 closed, 1 open)", "length: "] {
        assert!(said.contains(line), "expected {line:?}: {said}");
    }
    let radius: f64 =
        said.split("contact radius: ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((radius - 0.5).abs() < 0.02, "knit with 0.5, read back as {radius}");
    let draw = ["render", "k.bcc", "-o", "k.png", "--size", "32x24", "--set", "yarn.fibers_per_ply=4"];
    let output = place.run(&draw);
    assert_good(&output);
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(notes.contains("k.bcc: no mm_per_unit"), "{notes}");
}

#[test]
fn a_knitted_tube_is_closed_and_read_back() {
    let place = Workplace::new();
    let knit = ["knit", "tube", "--courses", "4", "--wales", "10", "--yarn-radius", "0.5"];
    let spacings = ["--wale-spacing", "4.3", "--course-spacing", "3", "--points-per-loop", "16"];
    assert_good(&place.run(&[&knit[..], &spacings, &["-o", "t.bcc"]].concat()));
    let info = place.run(&["info", "t.bcc"]);
    assert_good(&info);
    let said = String::from_utf8(info.stdout).unwrap();
    for line in ["format: BCC, CatmullRom", "up axis: Y", "curves: 4 (4 closed, 0 open)", "points: 640"] {
        assert!(said.contains(line), "expected {line:?}: {said}");
    }
}

#[test]
fn info_says_what_was_repaired() {
    let place = Workplace::new();
    // A doubled point, and a strand of one point besides.
    place.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nv 2 1 0\nv 3 1 0\nl 1 2\nl 2 3\nl 3 4\nl 4 5\n");
    let output = place.run(&["info", "a.obj"]);
    assert_good(&output);
    let said = String::from_utf8(output.stdout).unwrap();
    for line in ["format: OBJ", "up axis: not stated", "control points: 4 ", "length: 3.414 ", "repaired: "] {
        assert!(said.contains(line), "expected {line:?}: {said}");
    }
    assert!(said.contains("radius: none, no strands touch"), "{said}");
}

#[test]
fn doctor_finds_the_device_good() {
    let output = Workplace::new().run(&["doctor", "--validate"]);
    assert_good(&output);
    let said = String::from_utf8(output.stdout).unwrap();
    let expected =
        ["Vulkan loader: 1.", "validation layer: present", "would be used", "self-check: the same picture"];
    for line in expected {
        assert!(said.contains(line), "expected {line:?}: {said}");
    }
    assert!(said.ends_with("good\n") && !said.contains("MISSING"), "{said}");
}

#[test]
fn every_command_has_help() {
    let place = Workplace::new();
    for command in [
        &[][..],
        &["render"],
        &["compare"],
        &["knit"],
        &["knit", "stockinette"],
        &["knit", "tube"],
        &["info"],
        &["doctor"],
        &["probe"],
    ] {
        let output = place.run(&[command, &["--help"]].concat());
        assert_good(&output);
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.contains("Usage: worsted") && said.contains("--device"), "{command:?}: {said}");
    }
    let version = place.run(&["--version"]);
    assert_good(&version);
    assert_eq!(version.stdout, format!("worsted {}\n", env!("CARGO_PKG_VERSION")).into_bytes());
    assert!(place.contents().is_empty());
}

#[test]
fn the_checker_of_error_lines_rejects_bad_ones() {
    let output = |code: i32, stdout: &str, stderr: &str| Output {
        status: ExitStatus::from_raw(code << 8),
        stdout: stdout.into(),
        stderr: stderr.into(),
    };
    let good = output(2, "", "worsted: a.bcc: byte 0: no\n");
    assert_eq!(error_fault(&good, 2, &["a.bcc", "byte 0"]), None);
    assert!(error_fault(&good, 3, &[]).unwrap().contains("exit code 3"));
    assert!(error_fault(&good, 2, &["a.bcc", "byte 1"]).unwrap().contains("byte 1"));
    for (stdout, stderr) in [
        ("", ""),
        ("", "\n"),
        ("", "a.bcc: no end"),
        ("", "a.bcc: one\na.bcc: two\n"),
        ("", "note\n\n"),
        ("", "\x1b[33ma.bcc\x1b[0m\n"),
        ("chatter", "a.bcc: one\n"),
        ("", "thread 'main' panicked at a.bcc\n"),
    ] {
        assert!(error_fault(&output(2, stdout, stderr), 2, &[]).is_some(), "{stdout:?} {stderr:?}");
    }
    // Killed by a signal: no exit code at all.
    let killed = Output { status: ExitStatus::from_raw(11), ..good };
    assert!(error_fault(&killed, 2, &[]).is_some());
}
