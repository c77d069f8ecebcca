//! glTF in and out: fixtures that the generators write, and published samples.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

use glam::DVec3;
use std::path::{Path, PathBuf};
use worsted::io::curves::CurveSet;
use worsted::io::gltf_write::write_gltf;
use worsted::io::yarn_file::load_yarn_file;
use worsted::knit::motion::{Dance, danced, written};
use worsted::knit::params::KnitParams;
use worsted::knit::stockinette::stockinette;
use worsted::knit::tube::tube;
use worsted::motion::mover::Movers;
use worsted::scene::Scene;

fn swatch() -> CurveSet {
    stockinette(&KnitParams { courses: 3, wales: 3, ..KnitParams::swatch() }).unwrap()
}

fn sleeve() -> CurveSet {
    tube(&KnitParams { courses: 4, wales: 10, ..KnitParams::tube() }).unwrap()
}

fn points(set: &CurveSet) -> Vec<DVec3> {
    set.curves.iter().flat_map(|curve| curve.points.clone()).collect()
}

fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max)
}

/// Every frame of a written fixture is where the closed form has it, to what f32 holds in metres.
fn holds(set: &CurveSet, dance: Dance) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fixture.gltf");
    write_gltf(&path, set, Some(&written(set, dance))).unwrap();
    let loaded = load_yarn_file(&path).unwrap();
    assert!(loaded.moves && loaded.repairs.is_empty() && loaded.notes.is_empty(), "{:?}", loaded.repairs);
    let shapes = |set: &CurveSet| -> Vec<(usize, bool)> {
        set.curves.iter().map(|curve| (curve.points.len(), curve.closed)).collect()
    };
    assert_eq!(shapes(&loaded.curves), shapes(set));
    let scene = Scene::load(&path, &[]).unwrap();
    assert_eq!(scene.fabrics[0].mm_per_unit, 1000.0);
    let rest = points(set);
    let mut movers = Movers::open(&scene).unwrap();
    // 48 keys in two seconds, and as many frames: 24 a second.
    assert_eq!(movers.frame_count(), Some(49));
    let given: Vec<DVec3> = points(&loaded.curves).iter().map(|p| *p * 1000.0).collect();
    assert!(apart(&given, &rest) < 1e-4);
    let mut farthest: f64 = 0.0;
    for frame in [0, 7, 24, 31, 48] {
        let found = movers.0[0].given_at(f64::from(frame)).unwrap();
        let expected = danced(&rest, dance, f64::from(frame) / 48.0);
        assert!(apart(&found, &expected) < 2e-4, "{dance:?} frame {frame}: {}", apart(&found, &expected));
        farthest = farthest.max(apart(&found, &rest));
    }
    assert!(farthest > 0.5, "{dance:?} moves");
    assert!(movers.0[0].given_at(49.0).is_err());
    // Twice as many frames a second, the same motion.
    let scene = Scene::load(&path, &["animation.frames_per_second=48".into()]).unwrap();
    let mut finer = Movers::open(&scene).unwrap();
    assert_eq!(finer.frame_count(), Some(97));
    assert!(apart(&finer.0[0].given_at(14.0).unwrap(), &movers.0[0].given_at(7.0).unwrap()) < 1e-9);
}

#[test]
fn a_swatch_moves_by_morph_targets_as_it_was_written() {
    holds(&swatch(), Dance::Stretch);
    holds(&swatch(), Dance::Wave);
}

#[test]
fn a_sleeve_moves_by_its_skin_as_it_was_written() {
    holds(&sleeve(), Dance::Bend);
}

#[test]
fn a_model_of_another_kind_moves_by_a_gltf_of_the_same_curves() {
    let folder = tempfile::tempdir().unwrap();
    let (model, motion) = (folder.path().join("a.bcc"), folder.path().join("a.gltf"));
    let set = swatch();
    worsted::io::bcc::write_bcc(&model, &set).unwrap();
    write_gltf(&motion, &set, Some(&written(&set, Dance::Wave))).unwrap();
    let sets = |path: &Path, scale: f64| {
        [format!("fabric.motion={}", path.display()), format!("fabric.mm_per_unit={scale}")]
    };
    // The motion is in the model's unit: metres both.
    let metres = CurveSet {
        curves: set
            .curves
            .iter()
            .cloned()
            .map(|mut curve| {
                curve.points.iter_mut().for_each(|p| *p /= 1000.0);
                curve
            })
            .collect(),
        ..set.clone()
    };
    worsted::io::bcc::write_bcc(&model, &metres).unwrap();
    let scene = Scene::load(&model, &sets(&motion, 1000.0)).unwrap();
    let found = Movers::open(&scene).unwrap().0[0].given_at(12.0).unwrap();
    assert!(apart(&found, &danced(&points(&set), Dance::Wave, 0.25)) < 2e-4);
    // Other curves, and none that move.
    let other = sleeve();
    write_gltf(&motion, &other, Some(&written(&other, Dance::Bend))).unwrap();
    let error = Scene::load(&model, &sets(&motion, 1000.0)).unwrap_err().to_string();
    assert!(error.contains("a.gltf: frame 0: expected 1 curves"), "{error}");
    write_gltf(&motion, &set, None).unwrap();
    let error = Scene::load(&model, &sets(&motion, 1000.0)).unwrap_err().to_string();
    assert!(error.contains("expected at least one animation"), "{error}");
    assert!(Scene::load(&motion, &[]).unwrap().fabrics[0].motion.is_none(), "a still is a model");
}

/// A sample of `../shared/data/curve-formats`, if it is there.
fn sample(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/curve-formats").join(name);
    if path.is_file() {
        return Some(path);
    }
    println!("skipped: {name} is not here");
    None
}

#[test]
fn published_samples_of_lines_load() {
    for (name, expected) in [
        ("Mesh_PrimitiveMode_01.gltf", &[(2, false); 4][..]),
        ("Mesh_PrimitiveMode_02.gltf", &[(4, true)]),
        ("Mesh_PrimitiveMode_03.gltf", &[(5, false)]),
    ] {
        let Some(path) = sample(name) else { continue };
        let loaded = load_yarn_file(&path).unwrap();
        let found: Vec<_> = loaded.curves.curves.iter().map(|c| (c.points.len(), c.closed)).collect();
        assert_eq!(found, expected, "{name}");
        assert!(!loaded.moves);
    }
}

#[test]
fn published_samples_of_morph_targets_play() {
    // A face of the cube has two triangles: its outline on either side of their edge, and that.
    for (name, curves) in [("SimpleMorph.gltf", 1), ("AnimatedMorphCube.gltf", 18)] {
        let Some(path) = sample(name) else { continue };
        let scene = Scene::load(&path, &[]).unwrap();
        assert!(scene.fabrics[0].notes.iter().any(|note| note.contains("edges of triangles")), "{name}");
        assert_eq!(scene.fabrics[0].strands.closed.len(), curves, "{name}");
        let mut movers = Movers::open(&scene).unwrap();
        let count = movers.frame_count().unwrap();
        let mut at = |frame: u64| movers.0[0].given_at(frame as f64).unwrap();
        let first = at(0);
        let moved = (0..count).map(|frame| apart(&first, &at(frame))).fold(0.0, f64::max);
        assert!(count > 90 && moved > 1.0, "{name}: {count} frames, {moved} mm");
    }
}
