//! Every reader of files from outside, over bytes: whatever they are, an answer or one line of error, and no number
//! that is none. Shared by the fuzz targets and by the test that runs on stable.

use std::path::{Path, PathBuf};
use worsted::io::environment::read_environment;
use worsted::io::frames::FrameSource;
use worsted::io::gltf::Model;
use worsted::io::measured::MeasuredImage;
use worsted::io::picture::read_png;
use worsted::io::yarn_file::{load_yarn_file, parse_yarn_file};
use worsted::probe::{FUNCTIONS, probe};
use worsted::reference::checkpoint;
use worsted::scene::Scene;

/// Reads bytes; an error says how the reader broke its word.
pub type Read = fn(&[u8], &Scratch) -> Result<(), String>;

/// Every reader by its name.
pub const READERS: [(&str, Read); 12] = [
    ("bcc", bcc),
    ("obj", obj),
    ("gltf", gltf),
    ("frames", frames),
    ("exr", exr),
    ("png", png),
    ("environment_exr", |bytes, scratch| environment(bytes, scratch, "exr")),
    ("environment_hdr", |bytes, scratch| environment(bytes, scratch, "hdr")),
    ("environment_png", |bytes, scratch| environment(bytes, scratch, "png")),
    ("checkpoint", part),
    ("scene", scene),
    ("probe", queries),
];

/// Size and key of the unfinished picture that the corpus holds.
pub const PART_SIZE: [u32; 2] = [24, 16];
pub const PART_KEY: u64 = 7;

/// A folder for readers that want a path, with a small yarn file in it.
pub struct Scratch(pub PathBuf);

impl Scratch {
    fn file(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, String> {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).map_err(|e| format!("cannot write {name}: {e}"))?;
        Ok(path)
    }
}

/// An error must be one line of a sane length.
fn one_line(error: &dyn std::fmt::Display) -> Result<(), String> {
    let text = error.to_string();
    let plain = !text.contains(|c: char| c.is_control()) && (1..1500).contains(&text.len());
    if plain { Ok(()) } else { Err(format!("not one line: {text:?}")) }
}

fn yarn(name: &str, bytes: &[u8]) -> Result<(), String> {
    match parse_yarn_file(Path::new(name), bytes) {
        Err(error) => one_line(&error),
        Ok(loaded) => {
            let finite = loaded.curves.curves.iter().flat_map(|c| &c.points).all(|p| p.is_finite());
            let long = loaded.curves.curves.iter().all(|c| c.points.len() >= 2);
            if finite && long { Ok(()) } else { Err("a curve that cannot be drawn".to_owned()) }
        }
    }
}

fn bcc(bytes: &[u8], _: &Scratch) -> Result<(), String> {
    yarn("fuzzed.bcc", bytes)
}

fn obj(bytes: &[u8], _: &Scratch) -> Result<(), String> {
    yarn("fuzzed.obj", bytes)
}

/// As a model, and at some times of its motion.
fn gltf(bytes: &[u8], _: &Scratch) -> Result<(), String> {
    yarn("fuzzed.gltf", bytes)?;
    let model = match Model::new(Path::new("fuzzed.gltf"), bytes) {
        Err(error) => return one_line(&error),
        Ok(model) => model,
    };
    let count: usize = model.curves().map(|(points, _)| points).sum();
    for share in [0.0, 0.3, 1.0, 2.0] {
        match model.points(model.duration().map(|seconds| share * seconds)) {
            Err(error) => one_line(&error)?,
            Ok(points) if points.len() == count && points.iter().all(|p| p.is_finite()) => {}
            Ok(_) => return Err("points that cannot be drawn".to_owned()),
        }
    }
    Ok(())
}

/// As the frames of the small yarn file.
fn frames(bytes: &[u8], scratch: &Scratch) -> Result<(), String> {
    let path = scratch.file("fuzzed.f32", bytes)?;
    let model = load_yarn_file(&scratch.0.join("yarn.bcc")).map_err(|e| e.to_string())?;
    let mut source = match FrameSource::open(&path, &model.layout, 24.0) {
        Err(error) => return one_line(&error),
        Ok(source) => source,
    };
    for frame in 0..=source.count() {
        match source.read(frame) {
            Err(error) => one_line(&error)?,
            Ok(points)
                if points.len() == model.layout.point_count() && points.iter().all(|p| p.is_finite()) => {}
            Ok(_) => return Err("points that cannot be drawn".to_owned()),
        }
    }
    Ok(())
}

fn exr(bytes: &[u8], scratch: &Scratch) -> Result<(), String> {
    match MeasuredImage::read(&scratch.file("fuzzed.exr", bytes)?) {
        Err(error) => one_line(&error),
        Ok(image) => {
            image.mean.check_shape().map_err(|e| e.to_string())?;
            let sound = |v: &[f32; 3]| v.iter().all(|v| v.is_finite() && *v >= 0.0);
            let variance = image.variance.iter().flatten().all(sound);
            if variance { Ok(()) } else { Err("a variance that cannot be".to_owned()) }
        }
    }
}

fn png(bytes: &[u8], scratch: &Scratch) -> Result<(), String> {
    match read_png(&scratch.file("fuzzed.png", bytes)?) {
        Err(error) => one_line(&error),
        Ok(image) => image.check_shape().map_err(|e| e.to_string()),
    }
}

fn environment(bytes: &[u8], scratch: &Scratch, extension: &str) -> Result<(), String> {
    match read_environment(&scratch.file(&format!("sky.{extension}"), bytes)?) {
        Err(error) => one_line(&error),
        Ok(image) => {
            let sound = |p: &[f32; 4]| p[..3].iter().all(|v| (0.0..=1e9).contains(v));
            if image.pixels.iter().all(sound) { Ok(()) } else { Err("a radiance that cannot be".to_owned()) }
        }
    }
}

fn part(bytes: &[u8], scratch: &Scratch) -> Result<(), String> {
    match checkpoint::load(&scratch.file("fuzzed.exr.part", bytes)?, PART_KEY, PART_SIZE) {
        Err(error) => one_line(&error),
        Ok(None) => Err("the file was not seen".to_owned()),
        Ok(Some(found)) => {
            // What is gone on with must have a sane place to go on from.
            let (share, tiles) = (found.share(16), found.tally.tiles);
            if share.is_finite() && share >= 0.0 {
                Ok(())
            } else {
                Err(format!("share {share}, tile {tiles}"))
            }
        }
    }
}

fn scene(bytes: &[u8], scratch: &Scratch) -> Result<(), String> {
    let Err(error) = Scene::load(&scratch.file("fuzzed.toml", bytes)?, &[]) else { return Ok(()) };
    one_line(&error)
}

/// The first byte says which function is asked.
fn queries(bytes: &[u8], _: &Scratch) -> Result<(), String> {
    let (which, text) = bytes.split_first().unwrap_or((&0, &[]));
    let function = &FUNCTIONS[usize::from(*which) % FUNCTIONS.len()];
    let mut answers = Vec::new();
    let tally = probe(function, None, text, &mut answers).map_err(|e| e.to_string())?;
    let lines = answers.split(|b| *b == b'\n').filter(|line| !line.is_empty()).count() as u64;
    let parsed = |line: &[u8]| serde_json::from_slice::<serde_json::Value>(line).is_ok_and(|v| v.is_object());
    if lines != tally.lines {
        return Err(format!("{lines} answers to {} lines", tally.lines));
    }
    match answers.split(|b| *b == b'\n').filter(|line| !line.is_empty()).all(parsed) {
        true => Ok(()),
        false => Err("an answer is no JSON".to_owned()),
    }
}
