//! The one error type of every reader: the file, the place, what was expected and found.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole (missing, unreadable, empty, ...).
    File,
    /// A byte offset from the start of a binary file.
    Byte(u64),
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A curve, counted from 0.
    Curve(usize),
    /// A frame of a motion, counted from 0.
    Frame(u64),
    /// A numbered part of a document, by its kind: `accessor`, `mesh`.
    Item(&'static str, usize),
}

/// Bad input or a failed read or write, as one line: `FILE: PLACE: MESSAGE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    /// The file at fault.
    pub file: PathBuf,
    /// The place in it.
    pub place: Place,
    /// What was expected and what was found, without line breaks.
    pub message: String,
}

impl FileError {
    /// An error at `place` of `file`.
    pub fn new(file: &Path, place: Place, message: impl Into<String>) -> Self {
        Self { file: file.to_owned(), place, message: message.into() }
    }

    /// An operating-system error on `file`; `doing` says what was tried ("read", "write").
    pub fn io(file: &Path, doing: &str, error: &std::io::Error) -> Self {
        Self::new(file, Place::File, format!("cannot {doing}: {error}"))
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", shown(&self.file))?;
        match self.place {
            Place::File => {}
            Place::Byte(offset) => write!(f, "byte {offset}: ")?,
            Place::Line(line) => write!(f, "line {line}: ")?,
            Place::Curve(curve) => write!(f, "curve {curve}: ")?,
            Place::Frame(frame) => write!(f, "frame {frame}: ")?,
            Place::Item(kind, index) => write!(f, "{kind} {index}: ")?,
        }
        f.write_str(&plain(&self.message))
    }
}

impl std::error::Error for FileError {}

/// A path in a line of text: names may hold line breaks and other control characters.
pub fn shown(path: &Path) -> String {
    plain(&path.to_string_lossy())
}

/// A text as one line without control characters, which parts of broken files that an error repeats may hold.
pub fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_a_line_break_is_still_one_line() {
        let error = FileError::new(Path::new("a\nb\u{8}.bcc"), Place::Line(3), "what");
        assert_eq!(error.to_string(), "a\u{fffd}b\u{fffd}.bcc: line 3: what");
    }
}
