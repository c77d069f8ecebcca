//! Fiber presets: data under `models/presets/fiber`, embedded in the binary.

use super::params::FiberParams;
use serde::Deserialize;

macro_rules! embedded {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../models/presets/fiber/", $name, ".toml")))),*]
    };
}

/// Name and TOML text of every fiber preset.
const FIBERS: &[(&str, &str)] = embedded!["wool", "fleece", "gabardine", "silk", "cotton", "polyester"];

/// The preset a scene uses when it names none.
pub const DEFAULT_FIBER: &str = "wool";

/// How sure a preset's numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Confidence {
    /// Fitted to measurements of the fiber.
    Measured,
    /// Found beside measured fits, its origin not stated.
    Probable,
    /// Chosen by eye.
    Chosen,
}

/// A preset file: where its numbers come from, then the numbers.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PresetFile {
    source: String,
    confidence: Confidence,
    fiber: FiberParams,
}

/// Where a preset's numbers come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Description {
    /// The preset's name.
    pub name: &'static str,
    /// Source of its numbers, in a sentence or two without line breaks.
    pub source: String,
    /// How sure they are.
    pub confidence: Confidence,
}

/// Names of all fiber presets.
pub fn fiber_names() -> impl Iterator<Item = &'static str> {
    FIBERS.iter().map(|(name, _)| *name)
}

/// The fiber preset of that name, or `None`.
pub fn fiber(name: &str) -> Option<FiberParams> {
    file(name).map(|(_, file)| file.fiber)
}

/// Where the numbers of the preset of that name come from, or `None`.
pub fn describe(name: &str) -> Option<Description> {
    let (name, file) = file(name)?;
    Some(Description { name, source: file.source, confidence: file.confidence })
}

fn file(name: &str) -> Option<(&'static str, PresetFile)> {
    let (name, text) = FIBERS.iter().find(|(known, _)| *known == name)?;
    Some((name, toml::from_str(text).expect("embedded presets are parsed by a test")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_whole_and_says_where_it_is_from() {
        for name in fiber_names() {
            let fiber = fiber(name).expect("listed presets exist");
            let told = describe(name).expect("listed presets exist");
            assert!(told.source.len() > 40 && !told.source.contains('\n'), "{name}: {}", told.source);
            assert!(fiber.diffuse().iter().all(|d| (0.0..=1.0).contains(d)), "{name}");
        }
        assert!(fiber("none").is_none() && describe("none").is_none());
    }

    #[test]
    fn every_preset_file_is_embedded() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/models/presets/fiber");
        let entries = std::fs::read_dir(folder).expect("the folder is there");
        let stem =
            |path: std::path::PathBuf| path.file_stem().expect("a name").to_string_lossy().into_owned();
        let mut files: Vec<_> = entries.map(|entry| stem(entry.expect("an entry").path())).collect();
        let mut names: Vec<_> = fiber_names().collect();
        files.sort_unstable();
        names.sort_unstable();
        assert_eq!(files, names);
    }

    #[test]
    fn the_measured_ones_are_the_published_fits() {
        let measured =
            |name: &str| describe(name).is_some_and(|told| told.confidence == Confidence::Measured);
        let names: Vec<_> = fiber_names().filter(|name| measured(name)).collect();
        assert_eq!(names, ["fleece", "gabardine", "silk"]);
        assert_eq!(fiber("silk").expect("a preset").c_r, [0.745, 0.008, 0.070]);
    }
}
