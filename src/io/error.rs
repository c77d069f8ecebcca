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
        write!(f, "{}: ", self.file.display())?;
        match self.place {
            Place::File => {}
            Place::Byte(offset) => write!(f, "byte {offset}: ")?,
            Place::Line(line) => write!(f, "line {line}: ")?,
            Place::Curve(curve) => write!(f, "curve {curve}: ")?,
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for FileError {}
