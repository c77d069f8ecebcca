//! Yarn presets: data under `models/presets/yarn`, embedded in the binary.

use super::params::YarnParams;
use serde::Deserialize;

macro_rules! embedded {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../models/presets/yarn/", $name, ".toml")))),*]
    };
}

/// Name and TOML text of every yarn preset: those designed for knitting, then the CT fits.
const YARNS: &[(&str, &str)] = embedded![
    "worsted_3ply",
    "mercerised_2ply_cotton",
    "mohair",
    "cotton1",
    "cotton2",
    "polyester1",
    "rayon1",
    "rayon2",
    "rayon3",
    "rayon4",
    "silk1",
    "silk2",
];

/// The preset a scene uses when it names none.
pub const DEFAULT_YARN: &str = "worsted_3ply";

/// A preset file: where its numbers come from, then the numbers.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PresetFile {
    source: String,
    fiber_diameter_source: String,
    measured: bool,
    yarn: YarnParams,
}

/// Where a preset's numbers come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Description {
    /// The preset's name.
    pub name: &'static str,
    /// Source of its geometry, in a sentence or two without line breaks.
    pub source: String,
    /// Source of its fiber's diameter, which no fit of a yarn's geometry states, likewise.
    pub fiber_diameter_source: String,
    /// Whether the geometry was fitted to a real yarn; designed by eye otherwise.
    pub measured: bool,
}

/// Names of all yarn presets.
pub fn yarn_names() -> impl Iterator<Item = &'static str> {
    YARNS.iter().map(|(name, _)| *name)
}

/// The yarn preset of that name, or `None`.
pub fn yarn(name: &str) -> Option<YarnParams> {
    file(name).map(|(_, file)| file.yarn)
}

/// Where the numbers of the preset of that name come from, or `None`.
pub fn describe(name: &str) -> Option<Description> {
    let (name, file) = file(name)?;
    let PresetFile { source, fiber_diameter_source, measured, .. } = file;
    Some(Description { name, source, fiber_diameter_source, measured })
}

fn file(name: &str) -> Option<(&'static str, PresetFile)> {
    let (name, text) = YARNS.iter().find(|(known, _)| *known == name)?;
    Some((name, toml::from_str(text).expect("embedded presets are parsed by a test")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_embedded_preset_is_valid_and_says_where_it_comes_from() {
        for name in yarn_names() {
            assert_eq!(yarn(name).unwrap().validate(), Ok(()), "{name}");
            let about = describe(name).unwrap();
            for source in [&about.source, &about.fiber_diameter_source] {
                assert!(
                    source.len() > 60 && !source.contains('\n') && !source.contains("  "),
                    "{name}: {source}"
                );
            }
            let (marked, fitted) =
                (about.source.starts_with("Designed, not measured"), about.source.contains("fit to"));
            assert_eq!((marked, fitted), (!about.measured, about.measured), "{name}");
        }
        assert_eq!(yarn_names().count(), 12);
        assert!(yarn(DEFAULT_YARN).is_some());
        assert!(yarn("no_such_yarn").is_none() && describe("no_such_yarn").is_none());
    }

    #[test]
    fn every_preset_file_is_embedded() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/models/presets/yarn");
        let mut files: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
            .collect();
        let mut names: Vec<_> = yarn_names().collect();
        files.sort_unstable();
        names.sort_unstable();
        assert_eq!(files, names);
    }

    #[test]
    fn fitted_yarns_reach_as_far_beyond_their_radius_as_real_ones() {
        let measured = |name: &&str| describe(name).unwrap().measured;
        let fits: Vec<_> = yarn_names().filter(measured).collect();
        assert_eq!(fits.len(), 9);
        for name in fits {
            let yarn = yarn(name).unwrap();
            let ratio = yarn.outer_radius_mm() / yarn.yarn_radius_mm;
            // 1.03 to 1.31 to two digits.
            assert!((1.025..1.315).contains(&ratio), "{name}: {ratio}");
        }
    }

    #[test]
    fn designed_yarns_stay_within_what_a_period_can_hold() {
        for name in yarn_names().filter(|name| !describe(name).unwrap().measured) {
            let yarn = yarn(name).unwrap();
            assert!(yarn.fibers_per_ply <= 120, "{name}");
            let period_mm = yarn.fiber_pitch_mm.unwrap() / yarn.migration_rate;
            let flyaways = yarn.loop_density_per_mm + yarn.hair_density_per_mm;
            let share = flyaways * period_mm / f64::from(yarn.fibers_per_ply);
            assert!(share < 1.0, "{name}: {share} of periods");
            let long_mm = yarn.hair_length_mm.mean + 2.0 * yarn.hair_length_mm.deviation;
            assert!(long_mm < period_mm, "{name}: {long_mm} of {period_mm} mm");
            assert!(yarn.loop_radius_mm.mean > yarn.round_ply_radius_mm() * yarn.migration_max, "{name}");
        }
    }
}
