//! `worsted export`: what it writes is what was realised, and others can read it.

use super::process::{Workplace, assert_good, swatch};
use serde_json::Value;
use worsted::io::bcc::read_bcc;
use worsted::io::curves::{Basis, CurveSet, UpAxis};
use worsted::reference::fibers::{RealiseSettings, RealisedFiber, realise};
use worsted::scene::Scene;

/// The shipped swatch in a yarn of few fibers, hairs and loops among them.
const SETS: [&str; 3] = ["fabric.mm_per_unit=1", "yarn.fibers_per_ply=5", "seed=3"];

fn export(place: &Workplace, scene: &str, sets: &[&str], name: &str) -> String {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["export", scene, "-o", name].into_iter().chain(sets).collect();
    let output = place.run(&arguments);
    assert_good(&output);
    String::from_utf8(output.stdout).unwrap()
}

fn realised(scene: &str, sets: &[&str]) -> Vec<RealisedFiber> {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    let scene = Scene::load(scene.as_ref(), &sets).unwrap();
    realise(&scene, &RealiseSettings::default()).unwrap()
}

/// What keeps `curves` from being `fibers` as f32, if anything.
fn fault(fibers: &[RealisedFiber], curves: &CurveSet) -> Option<String> {
    if (curves.basis, curves.up_axis) != (Basis::Polyline, Some(UpAxis::Y)) {
        return Some(format!("{:?} {:?}", curves.basis, curves.up_axis));
    }
    if fibers.len() != curves.curves.len() {
        return Some(format!("{} curves of {}", curves.curves.len(), fibers.len()));
    }
    let differs = fibers.iter().zip(&curves.curves).position(|(fiber, curve)| {
        let rounded = fiber.points.iter().map(|p| p.as_vec3().as_dvec3());
        fiber.closed != curve.closed || !rounded.eq(curve.points.iter().copied())
    });
    differs.map(|index| format!("curve {index} differs"))
}

#[test]
fn the_swatch_reads_back_with_positions_equal_to_f32_rounding() {
    let place = Workplace::new();
    let said = export(&place, &swatch(), &SETS, "f.bcc");
    let fibers = realised(&swatch(), &SETS);
    let mut read = read_bcc(&place.path("f.bcc")).unwrap();
    assert_eq!(fault(&fibers, &read.curves), None);
    assert!(read.notes.is_empty(), "{:?}", read.notes);
    assert!(said.contains(&format!("f.bcc: {} runs", fibers.len())), "{said}");
    assert_eq!(place.contents().len(), 2);
    let info = place.run(&["info", "f.bcc"]);
    assert_good(&info);
    let info = String::from_utf8(info.stdout).unwrap();
    assert!(
        info.contains("format: BCC, Polyline") && info.contains(&format!("curves: {}", fibers.len())),
        "{info}"
    );

    // The comparison minds the smallest change.
    let x = &mut read.curves.curves[7].points[3].x;
    *x = f64::from((*x as f32).next_up());
    assert_eq!(fault(&fibers, &read.curves), Some("curve 7 differs".into()));
    read.curves.curves.pop();
    assert!(fault(&fibers, &read.curves).is_some());
}

#[test]
fn the_file_beside_says_what_bcc_has_no_room_for() {
    let place = Workplace::new();
    export(&place, &swatch(), &SETS, "f.bcc");
    let side: Value = serde_json::from_slice(&place.read("f.bcc.json")).unwrap();
    let (fibers, curves) = (realised(&swatch(), &SETS), side["curves"].as_array().unwrap());
    assert_eq!((fibers.len(), &side["units"], &side["up_axis"]), (curves.len(), &"mm".into(), &"Y".into()));
    let mut tapered = 0;
    for (fiber, curve) in fibers.iter().zip(curves) {
        let found = ["fabric", "curve", "ply", "fiber"].map(|key| curve[key].as_u64().unwrap() as usize);
        assert_eq!(found, [fiber.fabric, fiber.curve, fiber.ply as usize, fiber.fiber as usize]);
        let radii: Vec<f32> = match &curve["radius_mm"] {
            Value::Array(radii) => radii.iter().map(|r| r.as_f64().unwrap() as f32).collect(),
            one => vec![one.as_f64().unwrap() as f32; fiber.points.len()],
        };
        assert_eq!(radii, fiber.radii_mm.iter().map(|&r| r as f32).collect::<Vec<_>>());
        tapered += usize::from(curve["radius_mm"].is_array());
    }
    assert!(tapered > 0 && tapered < curves.len(), "{tapered} of {} taper", curves.len());
}

#[test]
fn usd_holds_as_many_points_and_widths_as_its_counts_say() {
    let place = Workplace::new();
    // Closed yarns, in which few fibers end as hairs and the others never.
    let knit = ["knit", "tube", "--courses", "2", "--wales", "10", "--yarn-radius", "0.5", "-o", "t.bcc"];
    assert_good(&place.run(&knit));
    let few_hairs = [&SETS[..], &["yarn.hair_density_per_mm=0.02"]].concat();
    export(&place, "t.bcc", &few_hairs, "f.usda");
    let text = String::from_utf8(place.read("f.usda")).unwrap();
    let fibers = realised(place.path("t.bcc").to_str().unwrap(), &few_hairs);
    let values = |name: &str| {
        let after = text.split_once(&format!(" {name} = [")).expect("the attribute").1;
        after.split_once(']').expect("its end").0.trim().to_owned()
    };
    let lines = |name: &str| values(name).lines().count();
    let counts: Vec<usize> =
        values("curveVertexCounts").split(',').map(|n| n.trim().parse().unwrap()).collect();
    let expected: Vec<usize> = fibers.iter().map(|f| f.points.len() + usize::from(f.closed)).collect();
    assert_eq!(counts, expected);
    assert!(fibers.iter().any(|f| f.closed) && fibers.iter().any(|f| !f.closed), "both kinds are tried");
    let total: usize = counts.iter().sum();
    assert_eq!(values("points").matches('(').count(), total);
    assert_eq!(values("widths").split(',').count(), total);
    for name in ["points", "widths", "primvars:ply", "primvars:fiber", "primvars:curve"] {
        assert_eq!(lines(name), fibers.len(), "{name}");
    }
    assert!(!text.contains("inf") && !text.contains("NaN"));
}

#[test]
fn the_same_command_writes_the_same_bytes_and_another_seed_others() {
    let place = Workplace::new();
    for name in ["a.bcc", "b.bcc"] {
        export(&place, &swatch(), &SETS, name);
    }
    assert!(place.read("a.bcc") == place.read("b.bcc"));
    let other = place.run(&[
        "export",
        &swatch(),
        "-q",
        "-o",
        "c.bcc",
        "--seed",
        "4",
        "--set",
        SETS[0],
        "--set",
        SETS[1],
    ]);
    assert_good(&other);
    assert!(other.stdout.is_empty() && other.stderr.is_empty());
    assert!(place.read("a.bcc") != place.read("c.bcc"));
}

#[test]
fn what_cannot_be_exported_is_one_line() {
    let place = Workplace::new();
    let swatch = swatch();
    place.write("dot.bcc", "BCC");
    for (scene, options, needle) in [
        (swatch.as_str(), &["-o", "x.obj"][..], ".bcc or .usda"),
        (&swatch, &["-o", "away/x.bcc"], "away/x.bcc"),
        (&swatch, &["-o", "x.bcc", "--chord-error", "0"], "--chord-error 0"),
        (&swatch, &["-o", "x.bcc", "--chord-error", "nan"], "--chord-error NaN"),
        (&swatch, &["-o", "x.usda", "--set", "yarn.ply_cuont=3"], "ply_cuont"),
        ("missing.toml", &["-o", "x.bcc"], "missing.toml"),
        ("dot.bcc", &["-o", "x.usda"], "dot.bcc: byte 0"),
    ] {
        place.refuses(&[&["export", scene], options].concat(), 2, &[needle]);
    }
}
