//! What a scene does not need is not there: by the Vulkan objects that a renderer makes.
//!
//! `docs/leave-out.md` has the table of these scenes. Everything runs under the validation layer, which refuses a
//! shader that declares a descriptor the layout lacks.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use worsted::frame::sampling::Sampling;
use worsted::frame::stats::Stats;
use worsted::frame::{Renderer, Request};
use worsted::scene::Scene;
use worsted::scene::needs::Need;
use worsted::vulkan::{Device, DeviceChoice};

#[path = "support/device.rs"]
mod device;
use device::shared;
#[path = "../tools/minimal/bare.rs"]
mod bare;
use bare::MINIMAL;

/// Beside those.
const CAMERA: &str = "camera.distance_mm=20";

/// A scene with one thing more than [`MINIMAL`].
struct With {
    name: &'static str,
    sets: &'static [&'static str],
    samples: u32,
    statistics: bool,
    /// What the minimal scene calls it in `left_out`, if it has a name there.
    left_out: Option<&'static str>,
    /// Objects that are there besides.
    added: &'static [&'static str],
    /// Bindings that sets 0 and 1 have besides.
    bindings: [usize; 2],
}

const NOTHING: With = With {
    name: "minimal",
    sets: &[],
    samples: 1,
    statistics: false,
    left_out: None,
    added: &[],
    bindings: [0, 0],
};

const SCENES: &[With] = &[
    With {
        name: "statistics",
        statistics: true,
        left_out: Some("statistics"),
        added: &["buffer statistics"],
        bindings: [1, 0],
        ..NOTHING
    },
    With { name: "4 samples", samples: 4, added: &["image radiance samples"], ..NOTHING },
    With { name: "ambient light", sets: &["shading.ambient=true"], left_out: Some("ambient"), ..NOTHING },
    With {
        name: "occlusion by distance",
        sets: &["shading.ambient=true", "occlusion.mode='distance'"],
        left_out: Some("occlusion"),
        ..NOTHING
    },
    With {
        name: "occlusion by texture",
        sets: &["shading.ambient=true", "occlusion.mode='texture'"],
        left_out: Some("occlusion"),
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
        left_out: Some("scattering_tables"),
        added: &["buffer scattering table"],
        bindings: [0, 1],
        ..NOTHING
    },
    With {
        name: "shadows inside the yarn",
        sets: &["shadow.self=true"],
        left_out: Some("self_shadow"),
        added: &["image self-shadow table", "sampler table"],
        bindings: [0, 1],
        ..NOTHING
    },
    With {
        name: "shadows between yarns",
        sets: &["shadow.map=true"],
        left_out: Some("shadow_map"),
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
        left_out: Some("core_fibers"),
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
    With {
        name: "loops and hairs",
        sets: &["yarn.hair_density_per_mm=1"],
        left_out: Some("flyaways"),
        ..NOTHING
    },
    With {
        name: "a layer of ids",
        sets: &["layers.id=true"],
        left_out: Some("id_layer"),
        added: &["image id layer", "image layer depth", "pipeline layers"],
        ..NOTHING
    },
    With {
        name: "a layer of motion",
        sets: &["layers.motion=true"],
        left_out: Some("motion_layer"),
        added: &["image layer depth", "image motion layer", "pipeline layers"],
        ..NOTHING
    },
    With {
        name: "a layer of motion of yarn that moves",
        sets: &["layers.motion=true", "fabric.motion='frames.f32'"],
        left_out: Some("motion_layer"),
        added: &[
            "buffer control points after",
            "buffer control points before",
            "image layer depth",
            "image motion layer",
            "pipeline layers",
        ],
        bindings: [0, 2],
        ..NOTHING
    },
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

/// What a renderer makes.
struct Made {
    objects: BTreeMap<String, usize>,
    /// Of sets 0 and 1.
    bindings: [usize; 2],
    /// Of all memory.
    bytes: u64,
    stats: Stats,
}

fn made(device: &Arc<Device>, model: &Path, with: &With) -> Made {
    let sets: Vec<String> =
        MINIMAL.iter().chain(&[CAMERA]).chain(with.sets).map(|set| (*set).to_owned()).collect();
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
    Made {
        objects: objects(device),
        bindings: layouts.map(|layout| layout.bindings().len()),
        bytes: device.memory_bytes().values().sum(),
        stats: renderer.stats().clone(),
    }
}

fn model() -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().expect("the temporary folder is ours to use");
    let path = folder.path().join("yarn.toml");
    let yarn = "v -6 0 0\nv -2 1 0\nv 2 -1 0\nv 6 0 0\nl 1 2 3 4\n";
    std::fs::write(folder.path().join("yarn.obj"), yarn).expect("written");
    let frames: [f32; 12] = [-6.0, 0.0, 0.0, -2.0, 1.0, 0.0, 2.0, -1.0, 0.0, 6.0, 0.0, 0.0];
    std::fs::write(folder.path().join("frames.f32"), frames.map(f32::to_le_bytes).as_flattened())
        .expect("written");
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
    let minimal = made(device, &model, &NOTHING);
    for need in Need::ALL.into_iter().filter(|need| *need != Need::Lights) {
        for name in need.resources() {
            let found = minimal.objects.keys().any(|made| made.ends_with(name));
            assert!(!found, "{name} is made for the minimal scene");
        }
    }
    for with in SCENES {
        let found = made(device, &model, with);
        assert_eq!(difference(&found.objects, &minimal.objects), with.added, "{}", with.name);
        assert_eq!(difference(&minimal.objects, &found.objects), Vec::<String>::new(), "{}", with.name);
        let expected = [0, 1].map(|set| minimal.bindings[set] + with.bindings[set]);
        assert_eq!(found.bindings, expected, "{}: bindings", with.name);
        let Some(what) = with.left_out else { continue };
        assert!(minimal.stats.left_out.contains_key(what), "{what}: {:?}", minimal.stats.left_out);
        assert!(!found.stats.left_out.contains_key(what), "{what}: {:?}", found.stats.left_out);
        // What it is said to save is what it takes, but for what drivers round up.
        let (more, said) = (found.bytes - minimal.bytes, minimal.stats.left_out_bytes.get(what));
        println!("{}: {more} bytes more, {said:?} said to be saved", with.name);
        if let Some(&said) = said {
            assert!((said..=said + said / 8 + 8192).contains(&more), "{}: {more} and {said}", with.name);
        }
    }
    // Light from everywhere alone.
    let dark = With { name: "no light", sets: &["light=[]", "shading.ambient=true"], ..NOTHING };
    let found = made(device, &model, &dark);
    assert_eq!(difference(&minimal.objects, &found.objects), ["buffer lights"]);
    assert_eq!(difference(&found.objects, &minimal.objects), Vec::<String>::new());
    assert_eq!(found.bindings[0], minimal.bindings[0] - 1);
    out_of_view(device, &model);
    light_that_misses(device, &model);
    device.check_validation().expect("no validation errors");
    let left = device.live_resources();
    assert_eq!(left, Vec::<String>::new(), "a renderer that is gone leaves nothing");
}

/// A yarn that the camera does not see is not drawn, and the picture is the same as if it had been.
fn out_of_view(device: &Arc<Device>, model: &Path) {
    let draw = |target: &str, culling: bool| {
        let sets = [format!("camera.target_mm={target}"), format!("quality.culling={culling}")];
        let sets: Vec<String> =
            MINIMAL.iter().chain(&[CAMERA]).map(|set| (*set).to_owned()).chain(sets).collect();
        let scene = Scene::load(model, &sets).expect("a scene that loads");
        let sampling = Sampling::new(1).expect("one sample is allowed");
        let request = Request { size: [48, 32], sampling, statistics: true, profile: false };
        let mut renderer = Renderer::new(device, scene, request).expect("a renderer");
        let picture = renderer.render(&|_| ()).expect("a picture");
        (picture.linear, renderer.stats().clone())
    };
    for target in ["[0, 0, 0]", "[13.5, 0, 0]", "[900, 0, 0]", "[0, -60, 0]", "[0, 0, -900]"] {
        let ((with, culled), (without, all)) = (draw(target, true), draw(target, false));
        assert_eq!(with, without, "{target}");
        let left_out = !culled.left_out_of_frame.is_empty();
        let dark = with.iter().all(|pixel| pixel[3] == 0.0);
        assert_eq!(left_out, ["[900, 0, 0]", "[0, -60, 0]", "[0, 0, -900]"].contains(&target), "{target}");
        assert!(!left_out || dark && culled.patches_culled == Some(culled.yarn_segments), "{target}");
        assert!(all.left_out_of_frame.is_empty());
    }
}

/// A spot light that shines past the cloth takes no part, and neither does its view of the shadow map.
fn light_that_misses(device: &Arc<Device>, model: &Path) {
    let draw = |spot: &str| {
        let lights = format!("light=[{{}}{spot}, {{direction = [0, -1, 0.2]}}]");
        let sets = ["shadow.map=true".to_owned(), lights];
        let sets: Vec<String> =
            MINIMAL.iter().chain(&[CAMERA]).map(|set| (*set).to_owned()).chain(sets).collect();
        let scene = Scene::load(model, &sets).expect("a scene that loads");
        let sampling = Sampling::new(1).expect("one sample is allowed");
        let request = Request { size: [48, 32], sampling, statistics: false, profile: false };
        let mut renderer = Renderer::new(device, scene, request).expect("a renderer");
        let picture = renderer.render(&|_| ()).expect("a picture");
        let left_out: Vec<String> = renderer.stats().left_out_of_frame.keys().cloned().collect();
        (picture.linear, left_out)
    };
    let spot = |z: f64| format!(", {{kind = 'spot', position_mm = [0, 0, 60], direction = [0, 0, {z}]}}");
    let ((none, _), (away, left_out), (onto, all)) = (draw(""), draw(&spot(1.0)), draw(&spot(-1.0)));
    assert_eq!((left_out, all), (vec!["light 1".to_owned()], Vec::new()));
    assert_eq!(none, away);
    assert_ne!(none, onto);
}

#[test]
fn the_page_lists_every_scene() {
    let page = include_str!("../docs/leave-out.md");
    for with in SCENES.iter().chain([&NOTHING]) {
        let row = page.lines().find(|line| line.starts_with(&format!("| {} |", with.name)));
        let row = row.unwrap_or_else(|| panic!("docs/leave-out.md has no row for {}", with.name));
        for made in with.added {
            assert!(row.contains(&format!("`{made}`")), "{}: no {made}", with.name);
        }
    }
}
