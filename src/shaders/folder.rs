//! Shaders compiled from a folder like `glsl/` that somebody edits.

use super::interface::differences;
use super::order::used_too_early;
use super::{ShaderSet, all, glsl};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// Most that a file may hold: more is no shader.
const MOST_BYTES: u64 = 1 << 20;
/// Most lines of a message; nobody reads more.
const MOST_LINES: usize = 200;

/// A file's text, or why there is none.
type Text = Result<String, String>;

/// What came of one shader, and the files that it was made of.
struct Compiled {
    read: BTreeMap<String, Text>,
    words: Result<Vec<u32>, String>,
}

/// A folder of shaders. What does not change between two looks at it is compiled once.
pub struct Folder {
    root: PathBuf,
    compiled: BTreeMap<&'static str, Compiled>,
}

impl Folder {
    /// The folder at this path, whether it is there or not.
    pub fn new(root: PathBuf) -> Self {
        Self { root, compiled: BTreeMap::new() }
    }

    /// The shaders as the folder has them now: of those that this build embeds the ones that differ, in their place; or
    /// nothing, where `goes_on`, which is asked before each, says to stop.
    ///
    /// # Errors
    /// Every line that the compiler says of files that it refuses, or how a shader's interface differs from that of the
    /// embedded one; a folder that is not there.
    pub fn shaders(&mut self, goes_on: &dyn Fn() -> bool) -> Option<Result<ShaderSet, String>> {
        if !self.root.is_dir() {
            let found = if self.root.exists() { "something else" } else { "none" };
            return Some(Err(format!(
                "{}: expected a folder of shaders, found {found}",
                self.root.display()
            )));
        }
        let texts = Texts { root: &self.root, read: RefCell::default() };
        let (mut replaced, mut wrong) = (BTreeMap::new(), Vec::new());
        for (name, embedded) in all() {
            if !goes_on() {
                return None;
            }
            if !texts.is_there(name) {
                continue;
            }
            let unchanged = |of: &&Compiled| of.read.iter().all(|(path, text)| texts.get(path) == *text);
            if self.compiled.get(name).filter(unchanged).is_none() {
                self.compiled.insert(name, compiled(name, embedded, &texts));
            }
            match self.compiled.get(name).map(|compiled| &compiled.words) {
                Some(Ok(words)) if words != embedded => drop(replaced.insert(name.to_owned(), words.clone())),
                Some(Err(why)) => wrong.extend(why.lines().map(str::to_owned)),
                _ => (),
            }
        }
        Some(if wrong.is_empty() { Ok(ShaderSet::replacing(replaced)) } else { Err(message(wrong)) })
    }
}

/// What is wrong, each once: a file that many include is complained of for each of them.
fn message(wrong: Vec<String>) -> String {
    let mut lines: Vec<String> = Vec::new();
    for line in wrong {
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    if lines.len() > MOST_LINES {
        let more = lines.len() - MOST_LINES;
        lines.truncate(MOST_LINES);
        lines.push(format!("... and {more} lines more"));
    }
    lines.join("\n")
}

/// Compiles a shader and holds its interface to that of the embedded one.
fn compiled(name: &'static str, embedded: &[u32], texts: &Texts<'_>) -> Compiled {
    let read = RefCell::new(BTreeMap::new());
    let reading = |path: &str| {
        let text = texts.get(path);
        read.borrow_mut().insert(path.to_owned(), text.clone());
        text
    };
    let compile = || {
        let stage = glsl::stage_of(name).ok_or_else(|| format!("{name}: no stage has this name"))?;
        let words = glsl::compile(name, stage, &reading)?;
        if let Some(why) = used_too_early(&words).map_err(|why| format!("{name}: {why}"))? {
            return Err(format!("{name}: {why}"));
        }
        let differences = differences(embedded, &words).map_err(|why| format!("{name}: {why}"))?;
        match differences.is_empty() {
            true => Ok(words),
            false => Err(differences.iter().map(|line| format!("{name}: {line}\n")).collect()),
        }
    };
    // The compiler's crate panics where the compiler says what is not UTF-8.
    let words = catch_unwind(AssertUnwindSafe(compile));
    let words = words.unwrap_or_else(|_| Err(format!("{name}: the compiler failed on it")));
    Compiled { read: read.into_inner(), words }
}

/// The folder's files, each read once.
struct Texts<'a> {
    root: &'a Path,
    read: RefCell<BTreeMap<String, Text>>,
}

impl Texts<'_> {
    /// Whether anything is there, be it readable or not.
    fn is_there(&self, path: &str) -> bool {
        self.root.join(path).symlink_metadata().is_ok()
    }

    fn get(&self, path: &str) -> Text {
        let mut read = self.read.borrow_mut();
        read.entry(path.to_owned()).or_insert_with(|| text(&self.root.join(path))).clone()
    }
}

fn text(path: &Path) -> Text {
    let failed = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "expected a file, found none".to_owned(),
        _ => error.to_string(),
    };
    // Whoever opens a pipe waits for its other end.
    if !path.metadata().map_err(failed)?.is_file() {
        return Err("expected a file, found something else".to_owned());
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(failed)?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("expected at most {MOST_BYTES} bytes, found more"));
    }
    String::from_utf8(bytes).map_err(|error| {
        let line =
            1 + error.as_bytes()[..error.utf8_error().valid_up_to()].iter().filter(|b| **b == b'\n').count();
        format!("expected UTF-8, found other bytes in line {line}")
    })
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
