//! Tables and pipelines of an earlier run: the second start reads them and draws the same picture, and what is broken
//! is made anew without a word.

use std::path::{Path, PathBuf};
use worsted::frame::sampling::Sampling;
use worsted::frame::stats::Stats;
use worsted::frame::{Renderer, Request};
use worsted::io::cache::Cache;
use worsted::io::kept::Kept;
use worsted::scene::Scene;
use worsted::vulkan::DeviceChoice;

#[path = "support/device.rs"]
mod device;
use device::shared;

/// What the scene below bakes.
const TABLES: [&str; 7] = [
    "core_texture",
    "distance_occlusion",
    "occlusion_texture",
    "scattering_table",
    "self_shadow",
    "shadow_radius",
    "sky",
];

/// A yarn that is drawn with every kind of table.
struct Drawing {
    folder: tempfile::TempDir,
}

impl Drawing {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("the temporary folder is ours to use");
        let yarn = "v -6 0 0\nv -2 1 0\nv 2 -1 0\nv 6 0 0\nl 1 2 3 4\nv -5 1 1\nv 5 1 1\nl 5 6\n";
        std::fs::write(folder.path().join("yarn.obj"), yarn).expect("written");
        let scene = "[fabric]\nmodel = 'yarn.obj'\nmm_per_unit = 1.0\n[occlusion]\nmode = 'texture'\n";
        std::fs::write(folder.path().join("yarn.toml"), scene).expect("written");
        Self { folder }
    }

    fn cache(&self) -> PathBuf {
        self.folder.path().join("cache")
    }

    fn draw(&self, sets: &[&str], kept: &Kept) -> (Vec<[f32; 4]>, Stats) {
        let sets: Vec<String> =
            ["camera.distance_mm=20"].iter().chain(sets).map(|s| (*s).to_owned()).collect();
        let scene = Scene::load(&self.folder.path().join("yarn.toml"), &sets).expect("a scene that loads");
        let sampling = Sampling::new(1).expect("one sample is allowed");
        let request = Request { size: [48, 32], sampling, statistics: false, profile: false };
        let device = shared(DeviceChoice::Auto);
        let mut renderer = Renderer::keeping(device, scene, request, kept).expect("a renderer");
        let picture = renderer.render(&|_| ()).expect("a picture");
        assert!(picture.linear.iter().any(|p| p[0] > 0.0), "something is lit");
        (picture.linear, renderer.stats().clone())
    }

    fn kept(&self) -> Kept {
        Kept::within(Cache::new(Some(&self.cache())).expect("a folder that is given"))
    }

    /// Every file of the cache.
    fn files(&self) -> Vec<PathBuf> {
        let list = |folder: &Path| -> Vec<PathBuf> {
            let entries = std::fs::read_dir(folder).into_iter().flatten();
            entries.map(|entry| entry.expect("readable").path()).collect()
        };
        let mut files: Vec<PathBuf> = list(&self.cache()).iter().flat_map(|part| list(part)).collect();
        files.sort();
        files
    }
}

fn names(stats: &Stats) -> Vec<&str> {
    stats.precompute_from_cache.iter().map(String::as_str).collect()
}

#[test]
fn the_second_start_reads_what_the_first_one_kept() {
    let drawing = Drawing::new();
    let (without, stats) = drawing.draw(&[], &Kept::NOTHING);
    assert!(names(&stats).is_empty() && stats.pipelines_from_cache_bytes.is_none());
    assert!(drawing.files().is_empty(), "nothing is kept unasked");
    let baked: Vec<&str> = stats.precompute_ms.keys().map(String::as_str).collect();
    assert_eq!(baked, TABLES);

    let (first, stats) = drawing.draw(&[], &drawing.kept());
    assert!(names(&stats).is_empty() && stats.pipelines_from_cache_bytes.is_none());
    assert!(stats.pipelines_built > 0 && stats.pipelines_ms > 0.0);
    // Each with the time that it took.
    assert_eq!(drawing.files().len(), 2 * TABLES.len() + 1);
    let (second, stats) = drawing.draw(&[], &drawing.kept());
    assert_eq!(names(&stats), TABLES);
    assert!(stats.pipelines_from_cache_bytes.is_some_and(|bytes| bytes >= 32), "{stats:?}");
    assert_eq!(first, without);
    assert_eq!(second, without);
    assert_eq!(drawing.files().len(), 2 * TABLES.len() + 1);
    // What a scene leaves out would take as long as it last did.
    let sets = ["shadow.self=false", "shading.model='simple'", "light=[{}]"];
    let (_, stats) = drawing.draw(&sets, &drawing.kept());
    let known: Vec<&str> = stats.left_out_bake_ms.keys().map(String::as_str).collect();
    assert_eq!(known, ["scattering_tables", "self_shadow"]);
    assert!(stats.left_out_bake_ms.values().all(|ms| *ms > 0.0));
    assert!(drawing.draw(&sets, &Kept::NOTHING).1.left_out_bake_ms.is_empty());
}

#[test]
fn each_table_is_of_what_decides_it_and_of_nothing_else() {
    let drawing = Drawing::new();
    drawing.draw(&[], &drawing.kept());
    for (set, anew) in [
        ("quality.scattering_entries=64", &["scattering_table"][..]),
        ("quality.self_shadow_texels=16", &["self_shadow"]),
        ("quality.occlusion_texels=16", &["occlusion_texture"]),
        ("quality.core_texture_rows=32", &["core_texture"]),
        ("seed=1", &["core_texture"]),
        (
            "shading.extinction_scale=0.5",
            &["distance_occlusion", "occlusion_texture", "shadow_radius", "sky"],
        ),
        ("fiber.beta_r_deg=9", &["scattering_table"]),
        ("fabric.mm_per_unit=1.01", &["sky"]),
        ("light=[]", &[]),
    ] {
        let (with, stats) = drawing.draw(&[set], &drawing.kept());
        let made: Vec<&str> = stats
            .precompute_ms
            .keys()
            .map(String::as_str)
            .filter(|name| !stats.precompute_from_cache.contains(*name))
            .collect();
        assert_eq!(made, anew, "{set}");
        assert_eq!(with, drawing.draw(&[set], &Kept::NOTHING).0, "{set}");
    }
}

#[test]
fn plies_followed_one_by_one_are_kept_like_others() {
    let drawing = Drawing::new();
    let flat = ["yarn.ellipse_long_mm=0.5", "yarn.ellipse_short_mm=0.02"];
    let (first, stats) = drawing.draw(&flat, &drawing.kept());
    assert!(stats.precompute_ms.contains_key("chord_shadow") && names(&stats).is_empty(), "{stats:?}");
    let (second, stats) = drawing.draw(&flat, &drawing.kept());
    assert!(names(&stats).contains(&"chord_shadow"), "{stats:?}");
    assert_eq!(first, second);
}

#[test]
fn a_broken_cache_is_made_anew_without_a_word() {
    let drawing = Drawing::new();
    let (whole, _) = drawing.draw(&[], &drawing.kept());
    let files = drawing.files();
    let good: Vec<Vec<u8>> = files.iter().map(|file| std::fs::read(file).expect("readable")).collect();
    type Break = fn(&mut Vec<u8>);
    let breaks: [(&str, Break); 5] = [
        ("emptied", Vec::clear),
        ("cut short", |bytes| bytes.truncate(bytes.len() / 2)),
        ("a bit turned at the front", |bytes| bytes[0] ^= 1),
        ("a bit turned at the end", |bytes| *bytes.last_mut().expect("not empty") ^= 0x80),
        ("longer", |bytes| bytes.push(0)),
    ];
    for (what, break_it) in breaks {
        for (file, bytes) in files.iter().zip(&good) {
            let mut bytes = bytes.clone();
            break_it(&mut bytes);
            std::fs::write(file, bytes).expect("ours to break");
        }
        let (picture, stats) = drawing.draw(&[], &drawing.kept());
        assert!(names(&stats).is_empty() && stats.pipelines_from_cache_bytes.is_none(), "{what}: {stats:?}");
        assert_eq!(picture, whole, "{what}");
        assert_eq!(drawing.files(), files, "{what}");
        let tables = |file: &&PathBuf| file.parent().is_some_and(|part| part.ends_with("bakes"));
        for (file, bytes) in files.iter().zip(&good).filter(|(file, _)| tables(file)) {
            assert!(std::fs::read(file).expect("readable") == *bytes, "{what}: made as it was");
        }
    }
    // Files that are whole, each under another's name.
    for (file, bytes) in files.iter().zip(good.iter().cycle().skip(1)) {
        std::fs::write(file, bytes).expect("ours to break");
    }
    let (picture, stats) = drawing.draw(&[], &drawing.kept());
    assert!(names(&stats).is_empty(), "{stats:?}");
    assert_eq!(picture, whole);
}
