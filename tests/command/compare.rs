//! `worsted compare`: what it says, writes and refuses.

use super::process::{Workplace, assert_good, assert_one_line_error};
use serde_json::Value;
use worsted::io::measured::MeasuredImage;
use worsted::io::picture::{DisplayImage, LinearImage, read_png, write_exr, write_png};
use worsted::math::rng::Rng;
use worsted::math::tone::Display;

const SIDE: u32 = 40;
/// Standard deviation of a pixel's mean.
const NOISE: f32 = 0.02;

/// A disc of stripes on nothing, each value off by noise of a known variance.
fn disc(seed: u64, change: impl Fn([f32; 3]) -> [f32; 3]) -> MeasuredImage {
    let mut rng = Rng::new(seed, &[]);
    let mut variance = Vec::new();
    let mut pixel = |index: u32| {
        let (x, y) = ((index % SIDE) as f32, (index / SIDE) as f32);
        let inside = (x - 20.0).hypot(y - 20.0) < 15.0;
        variance.push(if inside { [NOISE * NOISE; 3] } else { [0.0; 3] });
        let stripe = 0.5 + 0.3 * (0.9 * x).sin();
        let [r, g, b] = change([stripe, 0.6 * stripe, 0.2]).map(|v| {
            let uniform = (rng.uniform() - 0.5) as f32;
            v + NOISE * 12_f32.sqrt() * uniform
        });
        if inside { [r, g, b, 1.0] } else { [0.0; 4] }
    };
    let pixels = (0..SIDE * SIDE).map(&mut pixel).collect();
    MeasuredImage { mean: LinearImage { width: SIDE, height: SIDE, pixels }, variance: Some(variance) }
}

/// A folder with `good.exr` and `again.exr`, which differ by noise, `swapped.exr`, whose channels are in the wrong
/// order, and the first as `good.png`.
fn pictures() -> Workplace {
    let place = Workplace::new();
    let good = disc(1, |v| v);
    good.write(&place.path("good.exr")).unwrap();
    disc(2, |v| v).write(&place.path("again.exr")).unwrap();
    disc(3, |[r, g, b]| [b, g, r]).write(&place.path("swapped.exr")).unwrap();
    write_exr(&place.path("plain.exr"), &good.mean).unwrap();
    let shown = DisplayImage::from_linear(&good.mean, &Display::default()).unwrap();
    write_png(&place.path("good.png"), &shown).unwrap();
    place
}

fn figures(place: &Workplace, arguments: &[&str]) -> Value {
    let output = place.run(&[&["compare"], arguments, &["--json", "-"]].concat());
    assert_good(&output);
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn noise_is_told_from_bias() {
    let place = pictures();
    let noise = figures(&place, &["again.exr", "good.exr"])["noise"].clone();
    let expected = 2.0 * f64::from(NOISE * NOISE);
    let covered = &noise["covered"];
    let number = |value: &Value| value.as_f64().unwrap();
    assert!((number(&covered["variance"]) / expected - 1.0).abs() < 1e-3, "{noise:#}");
    let (bias, error) = (number(&covered["bias_squared"]), number(&covered["bias_squared_error"]));
    assert!(bias.abs() < 4.0 * error && error < 0.2 * expected, "{noise:#}");
    assert_eq!(noise["blocks"]["differs"], false, "{noise:#}");

    let wrong = figures(&place, &["swapped.exr", "good.exr"]);
    let covered = &wrong["noise"]["covered"];
    assert!(number(&covered["bias_squared"]) > 20.0 * number(&covered["bias_squared_error"]), "{wrong:#}");
    assert_eq!(wrong["noise"]["blocks"]["differs"], true, "{wrong:#}");
    assert!(number(&wrong["covered"]["mse"]) > 10.0 * expected, "{wrong:#}");
}

#[test]
fn the_table_has_every_figure_and_lines_up() {
    let place = pictures();
    let output = place.run(&["compare", "swapped.exr", "good.exr"]);
    assert_good(&output);
    let said = String::from_utf8(output.stdout).unwrap();
    let rows =
        ["pixels", "FLIP, mean", "FLIP, largest", "MSE", "relative MSE", "PSNR, dB", "noise", "bias squared"];
    let ends: Vec<usize> = rows
        .iter()
        .map(|row| said.lines().find(|line| line.starts_with(row)).unwrap_or_default().len())
        .collect();
    assert!(ends.iter().all(|&end| end == ends[0] && end > 40), "{ends:?}:\n{said}");
    for line in ["swapped.exr against good.exr, 40 x 40", "the pictures differ: ", "tone curve neutral"] {
        assert!(said.contains(line), "expected {line:?}:\n{said}");
    }
    let output = place.run(&["compare", "again.exr", "good.exr"]);
    assert!(String::from_utf8(output.stdout).unwrap().contains("no difference but noise was found"));
    let quiet = place.run(&["compare", "again.exr", "good.exr", "-q"]);
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty());
}

#[test]
fn equal_pictures_have_no_error_in_any_format() {
    let place = pictures();
    for pair in [["good.exr", "plain.exr"], ["good.png", "good.png"]] {
        let report = figures(&place, &pair);
        for region in ["covered", "whole"] {
            for figure in ["flip_mean", "flip_max", "mse", "relative_mse"] {
                assert_eq!(report[region][figure], 0.0, "{pair:?}: {report:#}");
            }
            assert_eq!(report[region]["psnr_db"], Value::Null);
        }
    }
    // The bytes of a PNG are what a display shows of the EXR, up to their rounding.
    let report = figures(&place, &["good.png", "good.exr"]);
    assert!(report["covered"]["flip_mean"].as_f64().unwrap() < 1e-6, "{report:#}");
    assert!(report["covered"]["mse"].as_f64().unwrap() < 1e-5, "{report:#}");
    assert_eq!((&report["light"], &report["noise"]), (&"displayed".into(), &Value::Null));
    assert!(report["not_measured"]["radiance"].as_str().unwrap().contains("PNG"), "{report:#}");
}

#[test]
fn the_tone_curve_and_the_exposure_matter_to_flip_alone() {
    let place = pictures();
    let of = |more: &[&str]| figures(&place, &[&["swapped.exr", "good.exr"], more].concat());
    let plain = of(&[]);
    assert_eq!(plain["shown"], serde_json::json!({ "exposure_stops": 0.0, "tone": "neutral" }));
    for more in [&["--tone", "filmic"][..], &["--tone", "clamp", "--exposure", "2"], &["--exposure", "-3"]] {
        let other = of(more);
        assert_ne!(other["covered"]["flip_mean"], plain["covered"]["flip_mean"], "{more:?}");
        assert_eq!(other["covered"]["mse"], plain["covered"]["mse"], "{more:?}");
    }
}

#[test]
fn what_a_picture_does_not_state_is_said() {
    let place = pictures();
    let said = |pair: [&str; 2]| {
        let output = place.run(&["compare", pair[0], pair[1]]);
        assert_good(&output);
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(said(["plain.exr", "plain.exr"]).contains("not measured: bias and noise, because neither"));
    assert!(said(["plain.exr", "good.exr"]).contains("note: plain.exr states no variance"));
    let png = said(["good.png", "good.exr"]);
    assert!(
        png.contains("squared errors are of the light shown") && !png.contains("linear radiance"),
        "{png}"
    );
}

#[test]
fn a_limit_that_is_passed_ends_with_1_after_all_is_written() {
    let place = pictures();
    let arguments = [
        "compare",
        "swapped.exr",
        "good.exr",
        "-q",
        "--fail-above",
        "0.1",
        "--heatmap",
        "h.png",
        "--json",
        "f.json",
    ];
    let output = place.run(&arguments);
    assert_one_line_error(&output, 1, &["swapped.exr against good.exr", "FLIP", "above 0.1"]);
    let heatmap = read_png(&place.path("h.png")).unwrap();
    assert_eq!((heatmap.width, heatmap.height), (SIDE, SIDE));
    let brightness = |x: u32, y: u32| {
        heatmap.pixels[(y * SIDE + x) as usize][..3].iter().map(|&v| u32::from(v)).sum::<u32>()
    };
    assert!(
        brightness(20, 20) > 150 && brightness(0, 0) < 30,
        "bright where the pictures differ, and only there"
    );
    let report: Value = serde_json::from_slice(&place.read("f.json")).unwrap();
    assert!(report["covered"]["flip_mean"].as_f64().unwrap() > 0.1, "{report:#}");
    assert_good(&place.run(&["compare", "again.exr", "good.exr", "-q", "--fail-above", "0.2"]));
}

#[test]
fn what_cannot_be_compared_is_one_line() {
    let place = pictures();
    let mut broken = disc(1, |v| v);
    broken.mean.pixels[45][1] = f32::NAN;
    write_exr(&place.path("nan.exr"), &broken.mean).unwrap();
    write_exr(&place.path("small.exr"), &LinearImage::filled(8, 8, [0.1; 4])).unwrap();
    write_exr(&place.path("empty.exr"), &LinearImage::filled(SIDE, SIDE, [0.0; 4])).unwrap();
    place.write("text.exr", "not a picture");
    for (test, reference, needles) in [
        ("nan.exr", "good.exr", ["nan.exr", "test picture: pixel (5, 1)"]),
        ("good.exr", "nan.exr", ["nan.exr", "reference picture: pixel (5, 1)"]),
        ("good.png", "nan.exr", ["nan.exr", "pixel (5, 1)"]),
        ("small.exr", "good.exr", ["small.exr", "expected 40 x 40 pixels as in the reference, found 8 x 8"]),
        ("empty.exr", "empty.exr", ["empty.exr", "found none"]),
        ("missing.exr", "good.exr", ["missing.exr", "cannot read"]),
        ("good.exr", "missing.png", ["missing.png", "cannot read"]),
        ("text.exr", "good.exr", ["text.exr", "cannot read"]),
        ("good.exr", "good.jpg", ["good.jpg", ".exr or .png"]),
    ] {
        let arguments = ["compare", test, reference, "--heatmap", "x.png", "--json", "x.json"];
        place.refuses(&arguments, 2, &needles);
    }
}

#[test]
fn senseless_options_are_refused_before_any_work() {
    let place = pictures();
    let pair = ["compare", "good.exr", "again.exr"];
    for (options, needle) in [
        (["--fail-above", "1.5"], "--fail-above 1.5"),
        (["--fail-above", "nan"], "--fail-above NaN"),
        (["--exposure", "inf"], "--exposure inf"),
        (["--exposure", "-31"], "--exposure -31"),
        (["--tone", "filmik"], "filmik"),
        (["--heatmap", "x.exr"], "--heatmap x.exr"),
        (["--heatmap", "away/x.png"], "away/x.png"),
        (["--json", "away/x.json"], "away/x.json"),
    ] {
        place.refuses(&[&pair[..], &options].concat(), 2, &[needle]);
    }
    place.refuses(&["compare", "good.png", "good.png", "--tone", "clamp"], 2, &["--tone", "EXR"]);
    place.refuses(&["compare", "good.exr"], 2, &["REFERENCE"]);
}
