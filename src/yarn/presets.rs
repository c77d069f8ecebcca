//! Yarn presets: data under `models/presets/yarn`, embedded in the binary.

use super::params::YarnParams;
use serde::Deserialize;

/// Name and TOML text of every yarn preset.
const YARNS: &[(&str, &str)] =
    &[("worsted_3ply", include_str!("../../models/presets/yarn/worsted_3ply.toml"))];

/// The preset a scene uses when it names none.
pub const DEFAULT_YARN: &str = "worsted_3ply";

/// A preset file: where its numbers come from, then the numbers.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PresetFile {
    #[expect(dead_code, reason = "shown by later listings; required so that no preset lacks its source")]
    source: String,
    yarn: YarnParams,
}

/// Names of all yarn presets.
pub fn yarn_names() -> impl Iterator<Item = &'static str> {
    YARNS.iter().map(|(name, _)| *name)
}

/// The yarn preset of that name, or `None`.
pub fn yarn(name: &str) -> Option<YarnParams> {
    let (_, text) = YARNS.iter().find(|(known, _)| *known == name)?;
    let file: PresetFile = toml::from_str(text).expect("embedded presets are parsed by a test");
    Some(file.yarn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_embedded_preset_parses_and_is_valid() {
        for name in yarn_names() {
            let params = yarn(name).unwrap();
            assert_eq!(params.validate(), Ok(()), "{name}");
        }
        assert!(yarn(DEFAULT_YARN).is_some());
        assert!(yarn("no_such_yarn").is_none());
    }
}
