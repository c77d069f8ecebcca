//! What a scene does not need is not there: by the Vulkan objects that a renderer makes.
//!
//! `docs/leave-out.md` has the table of these scenes. Everything runs under the validation layer, which refuses a
//! shader that declares a descriptor the layout lacks.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::scene::Scene;
use worsted::scene::needs::Need;
use worsted::vulkan::{Device, DeviceChoice};

#[path = "support/device.rs"]
mod device;
use device::shared;

/// One yarn without loops and hairs, one light, the simple model: nothing else.
const MINIMAL: &[&str] = &[
    "shading.model='simple'",
    "shading.ambient=false",
    "shadow.map=false",
    "shadow.self=false",
    "occlusion.mode='none'",
    "occlusion.yarns=false",
    "debug.fibers='every'",
    "yarn.hair_density_per_mm=0",
    "yarn.loop_density_per_mm=0",
    "camera.distance_mm=20",
];

/// A scene with one thing more than [`MINIMAL`].
struct With {
    name: &'static str,
    sets: &'static [&'static str],
    samples: u32,
    statistics: bool,
    /// Objects that are there besides.
    added: &'static [&'static str],
    /// Bindings that sets 0 and 1 have besides.
    bindings: [usize; 2],
}

const NOTHING: With =
    With { name: "minimal", sets: &[], samples: 1, statistics: false, added: &[], bindings: [0, 0] };

const SCENES: &[With] = &[
    With { name: "statistics", statistics: true, added: &["buffer statistics"], bindings: [1, 0], ..NOTHING },
    With { name: "4 samples", samples: 4, added: &["image radiance samples"], ..NOTHING },
    With { name: "ambient light", sets: &["shading.ambient=true"], ..NOTHING },
    With {
        name: "occlusion by distance",
        sets: &["shading.ambient=true", "occlusion.mode='distance'"],
        ..NOTHING
    },
    With {
        name: "occlusion by texture",
        sets: &["shading.ambient=true", "occlusion.mode='texture'"],
        added: &["image occlusion texture", "sampler table"],
        bindings: [0, 1],
        ..NOTHING
    },
    With {
        name: "the sky that other yarns leave open",
        sets: &["shading.ambient=true", "occlusion.mode='distance'", "occlusion.yarns=true"],
        added: &["buffer skies"],
        bindings: [0, 1],
        ..NOTHING
    },
    With {
        name: "the physical model",
        sets: &["shading.model='physical'"],
        added: &["buffer scattering table"],
        bindings: [0, 1],
        ..NOTHING
    },
    With {
        name: "shadows inside the yarn",
        sets: &["shadow.self=true"],
        added: &["image self-shadow table", "sampler table"],
        bindings: [0, 1],
        ..NOTHING
    },
    With {
        name: "shadows between yarns",
        sets: &["shadow.map=true"],
        added: &[
            "buffer shadow views",
            "image shadow depth",
            "image shadow map",
            "pipeline shadow map",
            "sampler shadow map",
        ],
        bindings: [2, 0],
        ..NOTHING
    },
    With {
        name: "core fibers",
        sets: &["debug.fibers='both'", "quality.level_of_detail=false"],
        added: &[
            "image core normals",
            "image core shape",
            "image core spread",
            "pipeline core fibers",
            "sampler core",
        ],
        bindings: [0, 3],
        ..NOTHING
    },
    With { name: "loops and hairs", sets: &["yarn.hair_density_per_mm=1"], ..NOTHING },
];

/// How many objects of each kind and name are alive.
fn objects(device: &Device) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for line in device.live_resources() {
        let named = line.rsplit_once(" (").map_or(line.as_str(), |(named, _)| named).replace('`', "");
        *counts.entry(named).or_insert(0) += 1;
    }
    counts
}

/// What a renderer of the scene makes, and how many bindings sets 0 and 1 have.
fn made(device: &Arc<Device>, model: &Path, with: &With) -> (BTreeMap<String, usize>, [usize; 2]) {
    let sets: Vec<String> = MINIMAL.iter().chain(with.sets).map(|set| (*set).to_owned()).collect();
    let scene = Scene::load(model, &sets).expect("a scene that loads");
    let sampling = Sampling::new(with.samples).expect("a number that is allowed");
    let request = Request { size: [48, 32], sampling, statistics: with.statistics, profile: false };
    let mut renderer = Renderer::new(device, scene, request).expect("a renderer");
    device.check_validation().expect("no shader declares what its layout lacks");
    let picture = renderer.render(&|_| ()).expect("a picture");
    let covered = picture.linear.iter().filter(|p| p[3] > 0.0).count();
    let lit = picture.linear.iter().filter(|p| p[0] > 0.0).count();
    assert!(covered > 50 && lit > 50, "{}: {covered} pixels covered, {lit} lit", with.name);
    let layouts = renderer.fibers_pass().layouts(0).expect("a fabric");
    (objects(device), layouts.map(|layout| layout.bindings().len()))
}

fn model() -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().expect("the temporary folder is ours to use");
    let path = folder.path().join("yarn.toml");
    let yarn = "v -6 0 0\nv -2 1 0\nv 2 -1 0\nv 6 0 0\nl 1 2 3 4\n";
    std::fs::write(folder.path().join("yarn.obj"), yarn).expect("written");
    std::fs::write(&path, "[fabric]\nmodel = 'yarn.obj'\nmm_per_unit = 1.0\n").expect("written");
    (folder, path)
}

fn difference(more: &BTreeMap<String, usize>, less: &BTreeMap<String, usize>) -> Vec<String> {
    let beyond = |(name, count): (&String, &usize)| {
        let extra = count.saturating_sub(less.get(name).copied().unwrap_or(0));
        std::iter::repeat_n(name.clone(), extra)
    };
    more.iter().flat_map(beyond).collect()
}

/// One test, for it counts what is alive on the device.
#[test]
fn a_scene_makes_the_objects_it_needs_and_no_others() {
    let device = shared(DeviceChoice::Auto);
    let (_folder, model) = model();
    let (minimal, bindings) = made(device, &model, &NOTHING);
    println!("minimal: {minimal:#?}");
    for need in Need::ALL.into_iter().filter(|need| *need != Need::Lights) {
        for name in need.resources() {
            assert!(!minimal.keys().any(|made| made.ends_with(name)), "{name} is made for the minimal scene");
        }
    }
    for with in SCENES {
        let (found, found_bindings) = made(device, &model, with);
        assert_eq!(difference(&found, &minimal), with.added, "{}", with.name);
        assert_eq!(difference(&minimal, &found), Vec::<String>::new(), "{}", with.name);
        let expected = [0, 1].map(|set| bindings[set] + with.bindings[set]);
        assert_eq!(found_bindings, expected, "{}: bindings", with.name);
    }
    // Light from everywhere alone.
    let dark = With { name: "no light", sets: &["light=[]", "shading.ambient=true"], ..NOTHING };
    let (found, found_bindings) = made(device, &model, &dark);
    assert_eq!(difference(&minimal, &found), ["buffer lights"]);
    assert_eq!((difference(&found, &minimal), found_bindings[0]), (Vec::new(), bindings[0] - 1));
    device.check_validation().expect("no validation errors");
    let left = device.live_resources();
    assert_eq!(left, Vec::<String>::new(), "a renderer that is gone leaves nothing");
}
