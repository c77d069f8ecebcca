//! Real yarn files, where they are at hand: `../shared/data` beside the repository.

use std::path::PathBuf;

use worsted::io::curves::{Basis, UpAxis};
use worsted::io::repair::RepairKind;
use worsted::io::yarn_file::{Loaded, load_yarn_file};
use worsted::yarn::contact::estimate_contact_radius;

/// The file, or `None` with the reason printed when this machine does not have it.
fn load(name: &str) -> Option<Loaded> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(name);
    if !path.exists() {
        println!("skipped: {} is not on this machine", path.display());
        return None;
    }
    Some(load_yarn_file(&path).expect("a sound file loads"))
}

/// What is known about a model: its counts as the file states them, and what has to be repaired.
struct Known {
    name: &'static str,
    basis: Basis,
    up_axis: Option<UpAxis>,
    curves: usize,
    closed: usize,
    points: usize,
    repeated_ends: usize,
    /// Mean segment (units), to 2%.
    mean_segment: f64,
}

fn check(known: &Known) -> Option<Loaded> {
    let loaded = load(known.name)?;
    let set = &loaded.curves;
    assert_eq!((set.basis, set.up_axis), (known.basis, known.up_axis), "{}", known.name);
    assert_eq!(set.curves.len(), known.curves, "{}", known.name);
    assert_eq!(set.curves.iter().filter(|c| c.closed).count(), known.closed, "{}", known.name);
    assert_eq!(set.point_count() + known.repeated_ends, known.points, "{}", known.name);
    assert!(loaded.repairs.iter().all(|r| r.kind == RepairKind::RepeatedEndDropped), "{:?}", loaded.repairs);
    assert_eq!(loaded.repairs.len(), known.repeated_ends, "{}", known.name);
    let kept = loaded.kept_points.as_ref().map(Vec::len);
    assert_eq!(kept, (known.repeated_ends > 0).then(|| set.point_count()), "{}", known.name);
    assert!(loaded.notes.is_empty(), "{}: {:?}", known.name, loaded.notes);
    let segments = || set.curves.iter().flat_map(|c| c.points.windows(2)).map(|p| p[0].distance(p[1]));
    let mean = segments().sum::<f64>() / segments().count() as f64;
    assert!((mean / known.mean_segment - 1.0).abs() < 0.02, "{}: mean segment {mean}", known.name);
    Some(loaded)
}

const Y: Option<UpAxis> = Some(UpAxis::Y);
const Z: Option<UpAxis> = Some(UpAxis::Z);

#[rustfmt::skip]
const MODELS: [(Known, f64); 4] = [
    (Known { name: "yuksel-bcc/glove.bcc", basis: Basis::CatmullRom, up_axis: Y, curves: 70, closed: 70,
        points: 58_545, repeated_ends: 8, mean_segment: 0.238 }, 0.078),
    (Known { name: "yuksel-bcc/openwork_trellis_pattern.bcc", basis: Basis::CatmullRom, up_axis: Z, curves: 1,
        closed: 0, points: 19_730, repeated_ends: 0, mean_segment: 0.139 }, 0.076),
    (Known { name: "yuksel-bcc/flame_ribbing_pattern.bcc", basis: Basis::CatmullRom, up_axis: Z, curves: 1,
        closed: 0, points: 49_745, repeated_ends: 0, mean_segment: 0.218 }, 0.087),
    (Known { name: "yuksel-bcc/alien_sweater.bcc", basis: Basis::CatmullRom, up_axis: Y, curves: 146, closed: 146,
        points: 139_528, repeated_ends: 22, mean_segment: 0.216 }, 0.067),
];

/// Counts and repairs; the contact radius to 6% of what it was when the estimate was calibrated. No radius
/// is stated for these models: the MADYPG test below is the one that checks against a known one.
#[test]
fn yuksel_models_load_and_their_yarn_radius_is_found() {
    for (known, radius) in &MODELS {
        let Some(loaded) = check(known) else { continue };
        let start = std::time::Instant::now();
        let found = estimate_contact_radius(&loaded.curves.curves, loaded.curves.basis).unwrap();
        println!("{}: contact radius {found:.4} in {:?}", known.name, start.elapsed());
        assert!((found / radius - 1.0).abs() < 0.06, "{}: {found}, expected {radius}", known.name);
    }
}

/// Its info bytes are garbage, its curves B-splines.
#[test]
fn knit_tube_loads() {
    check(&Known {
        name: "curve-formats/knit_tube_bspline.bcc",
        basis: Basis::BSpline,
        up_axis: Y,
        curves: 39,
        closed: 39,
        points: 18_228,
        repeated_ends: 0,
        mean_segment: 0.26,
    });
}

/// 9,600 two-vertex `l` elements: two open strands wound on a sphere, which cross but never rest.
#[test]
fn obj_lines_chain_into_two_strands() {
    let known = Known {
        name: "curve-formats/glove_lines.obj",
        basis: Basis::Polyline,
        up_axis: None,
        curves: 2,
        closed: 0,
        points: 9_602,
        repeated_ends: 0,
        mean_segment: 0.0159,
    };
    if let Some(loaded) = check(&known) {
        assert!(loaded.curves.curves.iter().all(|c| c.points.len() == 4_801));
        assert_eq!(estimate_contact_radius(&loaded.curves.curves, loaded.curves.basis), None);
    }
}

/// The one model whose yarn radius is stated: 0.1 cm. Its simulated yarn is squeezed by a few percent.
#[test]
fn madypg_rest_shape_loads_and_its_stated_radius_is_found() {
    let known = Known {
        name: "madypg-animation/stock_stretchY_15cm/rest.bcc",
        basis: Basis::CatmullRom,
        up_axis: Z,
        curves: 72,
        closed: 0,
        points: 16_200,
        repeated_ends: 0,
        mean_segment: 0.105,
    };
    if let Some(loaded) = check(&known) {
        let radius = estimate_contact_radius(&loaded.curves.curves, loaded.curves.basis).unwrap();
        assert!((0.09..0.102).contains(&radius), "{radius}");
    }
}
