//! Every reader over spoiled files: no panic, no hang, no memory that a file's size does not justify, one line of
//! error. A few files of each kind in a usual run; with `WORSTED_FUZZ_SECONDS=600` as many as take that much processor
//! time for each reader (`WORSTED_FUZZ_READER` for one), from another seed with `WORSTED_FUZZ_SEED`. What broke a
//! reader once lies in `tests/fuzz/found/READER` and is read first.

#![expect(clippy::unwrap_used, reason = "the helpers of a test may fail it")]

mod allocator;
mod corpus;
mod mutate;
#[expect(clippy::panic, reason = "what a fuzzer must see of a reader that broke its word")]
#[path = "../../tools/fuzz/target.rs"]
mod target;
mod targets;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use target::readers::{READERS, Read, Scratch};
use worsted::bench::clock::cpu_seconds;

/// Spoiled files of each reader in a usual run.
const ROUNDS: u64 = 400;
/// Longest that one file may take to read, in seconds of processor time: a busy machine is no reader's fault.
const PATIENCE: f64 = 5.0;
/// Memory that a reader of text or curves may hold at once: so much and so many times the file.
const SMALL: [usize; 2] = [8 << 20, 64];
/// The same of scenes, which load the yarn that they name and look for strands that touch.
const SCENE: [usize; 2] = [64 << 20, 64];
/// The same of pictures, which are compressed, and as large as a picture may be.
const PICTURE: [usize; 2] = [3 << 29, 0];

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// Why a reader broke its word over these bytes, if it did.
fn fault(name: &str, read: Read, bytes: &[u8], scratch: &Scratch) -> Option<String> {
    let started = cpu_seconds();
    let (result, peak) =
        allocator::peak(|| catch_unwind(AssertUnwindSafe(|| read(bytes, scratch))).map_err(|_| "panicked"));
    let pictures = ["exr", "png", "environment_exr", "environment_hdr", "environment_png"];
    let [base, times] = match name {
        "scene" => SCENE,
        _ if pictures.contains(&name) => PICTURE,
        _ => SMALL,
    };
    let taken = cpu_seconds() - started;
    match result {
        Err(panicked) => Some(panicked.to_owned()),
        Ok(Err(broken)) => Some(broken),
        Ok(Ok(())) if taken > PATIENCE => Some(format!("took {taken:.1} s")),
        Ok(Ok(())) if peak > base + times * bytes.len() => {
            Some(format!("held {peak} bytes for a file of {}", bytes.len()))
        }
        Ok(Ok(())) => None,
    }
}

fn scratch() -> (tempfile::TempDir, Scratch) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("yarn.bcc"), &corpus::of("bcc")[0]).unwrap();
    let scratch = Scratch(folder.path().to_owned());
    (folder, scratch)
}

fn found(name: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/found").join(name);
    let mut all: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect();
    all.sort();
    all
}

fn fuzz(name: &str, read: Read) -> Result<u64, String> {
    let (_folder, scratch) = scratch();
    for path in found(name) {
        let bytes = std::fs::read(&path).unwrap();
        if let Some(fault) = fault(name, read, &bytes, &scratch) {
            return Err(format!("{}: {fault}", path.display()));
        }
    }
    let files = corpus::of(name);
    for file in &files {
        if let Some(fault) = fault(name, read, file, &scratch) {
            return Err(format!("a valid file: {fault}"));
        }
    }
    let seconds = number("WORSTED_FUZZ_SECONDS");
    let seed = number("WORSTED_FUZZ_SEED").unwrap_or(0x5eed);
    let started = cpu_seconds();
    let goes_on = |round: u64| match seconds {
        Some(seconds) => cpu_seconds() - started < seconds as f64,
        None => round < ROUNDS,
    };
    let mut round = 0;
    while goes_on(round) {
        let file = mutate::spoiled(&files, seed, round);
        if let Some(fault) = fault(name, read, &file, &scratch) {
            let kept = std::env::temp_dir().join(format!("{name}-{seed}-{round}"));
            std::fs::write(&kept, &file).unwrap();
            return Err(format!("seed {seed}, round {round}, kept as {}: {fault}", kept.display()));
        }
        round += 1;
    }
    if round == 0 { Err("no time to fuzz in, or none that this system says".into()) } else { Ok(round) }
}

#[test]
fn no_reader_breaks_over_spoiled_files() {
    let only = std::env::var("WORSTED_FUZZ_READER").ok();
    let mut broken = Vec::new();
    for (name, read) in
        READERS.into_iter().filter(|(name, _)| only.as_deref().is_none_or(|only| only == *name))
    {
        let started = cpu_seconds();
        match fuzz(name, read) {
            Ok(rounds) => {
                println!("{name}: {rounds} files in {:.1} s of processor time", cpu_seconds() - started)
            }
            Err(why) => broken.push(format!("{name}: {why}")),
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn readers_that_break_their_word_are_caught() {
    let (_folder, scratch) = scratch();
    let caught = |read: Read| fault("bcc", read, b"1234", &scratch);
    assert_eq!(caught(|_, _| Ok(())), None);
    assert_eq!(caught(|_, _| Err("two\nlines".into())).as_deref(), Some("two\nlines"));
    assert_eq!(caught(|bytes, _| Err(format!("{}", bytes[9]))).as_deref(), Some("panicked"));
    let greedy = caught(|bytes, _| match vec![1u8; 1 << 24].len() > bytes.len() {
        true => Ok(()),
        false => Err("small".into()),
    });
    assert!(greedy.is_some_and(|fault| fault.starts_with("held 16")), "an allocation of 16 MiB is not seen");
}
