//! `worsted reference`: stopped, gone on with, and refused.

use crate::process::{Workplace, assert_good, error_fault, swatch};
use serde_json::Value;
use std::process::Output;

/// A part of the swatch in a thin, coarse yarn: quick.
const CLOSE: [&str; 12] = [
    "--size",
    "40x24",
    "--camera",
    "distance=12",
    "--set",
    "yarn.fibers_per_ply=2",
    "--set",
    "fabric.mm_per_unit=1",
    "--chord-error",
    "10",
    "--spp",
    "10",
];

fn reference(place: &Workplace, more: &[&str]) -> Output {
    let swatch = swatch();
    place.run(&[&["reference", &swatch, "-q"][..], &CLOSE, more].concat())
}

#[test]
fn stopping_and_going_on_gives_the_same_files_and_leaves_nothing_behind() {
    let (whole, place) = (Workplace::new(), Workplace::new());
    assert_good(&reference(&whole, &["-o", "a.exr", "-o", "a.png", "--stats", "a.json"]));
    assert_good(&reference(&place, &["-o", "a.exr", "-o", "a.png", "--stop-after-passes", "1"]));
    assert!(place.contents().contains_key("a.exr.part"), "{:?}", place.contents());
    let first = place.read("a.exr");
    assert!(first != whole.read("a.exr"), "4 samples are not 10");
    assert_good(&reference(&place, &["-o", "a.exr", "-o", "a.png"]));
    for name in ["a.exr", "a.png"] {
        assert!(place.read(name) == whole.read(name), "{name} must not show that it was stopped");
    }
    assert_eq!(place.contents().len(), 2, "{:?}", place.contents());
    let stats: Value = serde_json::from_slice(&whole.read("a.json")).unwrap();
    for key in ["fibers", "fiber_segments", "fiber_bytes", "bvh_bytes", "rays", "samples"] {
        assert!(stats[key].as_u64().is_some_and(|n| n > 0), "{key}: {stats}");
    }
    for key in ["build_seconds", "trace_seconds", "variance_mean"] {
        assert!(stats[key].as_f64().is_some_and(|n| n > 0.0), "{key}: {stats}");
    }
    assert_eq!((stats["samples"].as_u64(), stats["not_finite_samples"].as_u64()), (Some(10), Some(0)));
}

#[test]
fn what_was_kept_of_another_picture_is_refused_until_told_otherwise() {
    let place = Workplace::new();
    assert_good(&reference(&place, &["-o", "a.exr", "--stop-after-passes", "1"]));
    let other = ["-o", "a.exr", "--seed", "5"];
    let refused = reference(&place, &other);
    assert_eq!(error_fault(&refused, 2, &["a.exr.part", "--fresh"]), None);
    assert_good(&reference(&place, &[&other[..], &["--fresh"]].concat()));
    assert_eq!(place.contents().len(), 1, "{:?}", place.contents());
}

#[test]
fn arguments_that_make_no_sense_are_refused_before_any_work() {
    let place = Workplace::new();
    let wrong: [(&[&str], &str); 5] = [
        (&["-o", "a.jpg"], "a.jpg"),
        (&["-o", "away/a.exr"], "away"),
        (&["-o", "a.exr", "--own-fiber-diameters", "2000"], "--own-fiber-diameters"),
        (&["-o", "a.exr", "--own-fiber-diameters", "nan"], "--own-fiber-diameters"),
        (&["-o", "a.exr", "--camera", "roll=3"], "--camera"),
    ];
    for (arguments, named) in wrong {
        assert_eq!(error_fault(&reference(&place, arguments), 2, &[named]), None, "{arguments:?}");
    }
    assert!(place.contents().is_empty(), "{:?}", place.contents());
}
