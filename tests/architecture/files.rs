//! How long a file may be, and one spelling.

use crate::{entries, repository, texts_below};
use std::path::Path;

const LONGEST_FILE_LINES: usize = 400;
/// Files that may be longer, each with its reason.
const MAY_BE_LONGER: &[(&str, &str)] = &[];
/// Not read from top to bottom, so no line limit.
const DATA_EXTENSIONS: &[&str] = &["csv", "json", "obj", "usda"];
const CODE_FOLDERS: &[&str] = &["src", "glsl", "tests", "tools"];
const OTHER_TEXT_FOLDERS: &[&str] = &[".ci", "docs", "models"];
/// Written in two halves so that this file does not break its own rule.
const MISSPELLING: &str = concat!("fib", "re");

/// `path: n lines` if that is too long, given the file's path from the repository's root.
fn too_long(path: &str, text: &str) -> Option<String> {
    let extension = Path::new(path).extension().unwrap_or_default();
    let exempt = DATA_EXTENSIONS.iter().any(|data| extension == *data)
        || MAY_BE_LONGER.iter().any(|(allowed, _)| *allowed == path);
    let lines = text.lines().count();
    (!exempt && lines > LONGEST_FILE_LINES)
        .then(|| format!("{path}: {lines} lines, of {LONGEST_FILE_LINES} allowed"))
}

/// `path:line` of every line with the misspelling, and the path itself if it has it.
fn misspellings(path: &str, text: &str) -> Vec<String> {
    let in_path = std::iter::once((path, path.to_owned()));
    let in_text = text.lines().enumerate().map(|(index, line)| (line, format!("{path}:{}", index + 1)));
    in_path
        .chain(in_text)
        .filter(|(text, _)| text.to_lowercase().contains(MISSPELLING))
        .map(|(_, at)| at)
        .collect()
}

#[test]
fn files_are_short() {
    let found: Vec<String> = CODE_FOLDERS
        .iter()
        .flat_map(|folder| texts_below(folder))
        .filter_map(|(path, text)| too_long(&path, &text))
        .collect();
    assert!(found.is_empty(), "too long:\n{}", found.join("\n"));
    assert!(too_long("src/io/bcc.rs", &"x\n".repeat(LONGEST_FILE_LINES)).is_none());
    assert!(too_long("src/io/bcc.rs", &"x\n".repeat(LONGEST_FILE_LINES + 1)).is_some());
    assert!(too_long("tests/golden/scores.json", &"x\n".repeat(LONGEST_FILE_LINES + 1)).is_none());
}

#[test]
fn fiber_has_one_spelling() {
    let top: Vec<(String, String)> = entries(repository())
        .into_iter()
        .filter(|path| path.is_file())
        .filter_map(|path| {
            let text = std::fs::read_to_string(&path).ok()?;
            Some((path.file_name()?.to_string_lossy().into_owned(), text))
        })
        .collect();
    let below = CODE_FOLDERS.iter().chain(OTHER_TEXT_FOLDERS).flat_map(|folder| texts_below(folder));
    let found: Vec<String> =
        top.into_iter().chain(below).flat_map(|(path, text)| misspellings(&path, &text)).collect();
    assert!(found.is_empty(), "write \"fiber\":\n{}", found.join("\n"));

    let wrong = format!("A fiber.\nTwo {}s.", MISSPELLING.to_uppercase());
    assert_eq!(misspellings("docs/a.md", &wrong), ["docs/a.md:2"]);
    assert_eq!(misspellings(&format!("docs/{MISSPELLING}.md"), "A fiber.").len(), 1);
}
