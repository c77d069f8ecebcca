//! The targets for cargo-fuzz, which wants a nightly compiler: what they share is compiled here, with the tests, and of
//! each target there is no more than a line.

use crate::target;
use crate::target::readers::READERS;
use std::path::Path;

/// What the target of a reader says.
fn text_of(name: &str) -> String {
    format!(
        "#![no_main]\n#[path = \"../target.rs\"]\nmod target;\n\
         libfuzzer_sys::fuzz_target!(|bytes: &[u8]| target::read(\"{name}\", bytes));\n"
    )
}

/// What is wrong with the targets of these readers in a folder like `tools/fuzz`.
fn faults(folder: &Path, names: &[&str]) -> Vec<String> {
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
    let manifest: toml::Table = manifest.parse().unwrap_or_default();
    let bins = manifest.get("bin").and_then(toml::Value::as_array).cloned().unwrap_or_default();
    let mut faults = Vec::new();
    for name in names {
        let path = format!("fuzz_targets/{name}.rs");
        let is =
            |bin: &&toml::Value| bin["name"].as_str() == Some(name) && bin["path"].as_str() == Some(&path);
        if bins.iter().filter(is).count() != 1 {
            faults.push(format!("{name}: not a target of Cargo.toml"));
        }
        if std::fs::read_to_string(folder.join(&path)).ok() != Some(text_of(name)) {
            faults.push(format!("{path}: not the target of `{name}`"));
        }
    }
    if bins.len() != names.len() {
        faults.push(format!("{} targets for {} readers", bins.len(), names.len()));
    }
    faults
}

#[test]
fn every_reader_is_a_target() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tools/fuzz");
    let names = READERS.map(|(name, _)| name);
    assert_eq!(faults(&folder, &names), Vec::<String>::new());
    assert_eq!(faults(&folder, &names[1..]), ["12 targets for 11 readers"]);
    let unknown = faults(&folder, &["bcc", "png2"]);
    assert!(unknown[0].starts_with("png2: not a target") && unknown.len() == 3, "{unknown:?}");
}

#[test]
fn a_target_reads_and_refuses_a_reader_that_is_not_there() {
    target::read("bcc", b"not a BCC file");
    assert!(std::panic::catch_unwind(|| target::read("no such reader", b"")).is_err());
}
