//! What commands say, on standard output and beside it. Whoever listens may leave: `worsted info FILE | head -1` ends
//! quietly, and what the command does beside talking is done.

use crate::error::Error;
use std::fmt::Arguments;
use std::io::{ErrorKind, StdoutLock, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Why standard output takes no more.
static TROUBLE: Mutex<Option<(ErrorKind, String)>> = Mutex::new(None);

fn trouble() -> MutexGuard<'static, Option<(ErrorKind, String)>> {
    TROUBLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes to standard output what [`say!`] was given. After the first failure nothing more is tried.
pub fn print(text: Arguments<'_>) {
    if trouble().is_none() {
        let mut out = Answers::new();
        // What went wrong is kept for the end.
        drop(out.write_fmt(text).and_then(|()| out.flush()));
    }
}

/// Writes to standard error what [`tell!`] was given: where that fails there is nobody left to tell.
pub fn print_beside(text: Arguments<'_>) {
    drop(std::io::stderr().lock().write_fmt(text));
}

/// A line on standard output.
macro_rules! say {
    ($($text:tt)*) => { $crate::cli::say::print(format_args!("{}\n", format_args!($($text)*))) };
}

/// A line on standard error.
macro_rules! tell {
    ($($text:tt)*) => { $crate::cli::say::print_beside(format_args!("{}\n", format_args!($($text)*))) };
}

pub(super) use {say, tell};

/// Standard output for a command that streams to it: writing fails where nobody listens any more, which
/// [`is_over`] then knows.
pub struct Answers(StdoutLock<'static>);

impl Answers {
    /// Locks standard output.
    pub fn new() -> Self {
        Self(std::io::stdout().lock())
    }

    fn noted<T>(result: std::io::Result<T>) -> std::io::Result<T> {
        if let Err(error) = &result
            && error.kind() != ErrorKind::Interrupted
        {
            trouble().get_or_insert((error.kind(), error.to_string()));
        }
        result
    }
}

impl Write for Answers {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        Self::noted(self.0.write(bytes))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Self::noted(self.0.flush())
    }
}

/// Whether whoever read standard output has left.
pub fn is_over() -> bool {
    trouble().as_ref().is_some_and(|(kind, _)| *kind == ErrorKind::BrokenPipe)
}

/// Whether all that was said was written, or nobody wanted it.
///
/// # Errors
/// Anything but a reader that has left: a full disk, say.
pub fn finish() -> Result<(), Error> {
    match &*trouble() {
        Some((kind, error)) if *kind != ErrorKind::BrokenPipe => {
            Err(Error::Arguments(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
