//! Runs the built command in a folder of its own and judges how it ends.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use tempfile::TempDir;

/// The swatch that the repository ships.
pub fn swatch() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/stockinette.bcc");
    path.to_str().expect("a checkout in a folder of UTF-8 name").to_owned()
}

/// A folder that the command runs in and nobody else sees.
pub struct Workplace {
    folder: TempDir,
    /// The command's cache: never the user's.
    cache: TempDir,
}

impl Workplace {
    pub fn new() -> Self {
        let folder = || tempfile::tempdir().expect("the temporary folder is ours to use");
        Self { folder: folder(), cache: folder() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("the temporary folder is ours to use");
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| format!("{name}: {e}").into_bytes())
    }

    /// The command with `arguments`, run in this folder.
    pub fn run(&self, arguments: &[impl AsRef<OsStr>]) -> Output {
        self.run_with(arguments, &[])
    }

    /// [`Self::run`] with `input` on standard input.
    pub fn run_on(&self, arguments: &[&str], input: &str) -> Output {
        let mut child = self.start(arguments);
        let mut stdin = child.stdin.take().expect("piped");
        let input = input.to_owned();
        // A command that ends early closes the pipe; what it says tells why.
        let writing = std::thread::spawn(move || drop(stdin.write_all(input.as_bytes())));
        let output = child.wait_with_output().expect("a child of ours");
        writing.join().expect("writing does not fail the test");
        output
    }

    /// The command, started with pipes at all its ends.
    pub fn start(&self, arguments: &[&str]) -> Child {
        let mut command = self.command();
        command.args(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().expect("the command was built with this test")
    }

    /// [`Self::run`] with environment variables set.
    pub fn run_with(&self, arguments: &[impl AsRef<OsStr>], environment: &[(&str, &str)]) -> Output {
        let mut command = self.command();
        command.args(arguments).envs(environment.iter().copied());
        command.output().expect("the command was built with this test")
    }

    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_worsted"));
        command.current_dir(self.folder.path()).env("WORSTED_CACHE", self.cache.path());
        command
    }

    /// Every file and folder here with its size, so that nothing is left behind unseen.
    pub fn contents(&self) -> BTreeMap<String, u64> {
        let entries = std::fs::read_dir(self.folder.path()).expect("the temporary folder is ours to use");
        entries
            .map(|entry| entry.expect("the temporary folder is ours to use"))
            .map(|entry| {
                let size = entry.metadata().map_or(0, |facts| facts.len());
                (entry.file_name().to_string_lossy().into_owned(), size)
            })
            .collect()
    }

    /// Runs something that must fail with `code` and one line holding all of `needles`, and must leave
    /// this folder as it found it.
    #[track_caller]
    pub fn refuses(&self, arguments: &[&str], code: i32, needles: &[&str]) {
        self.refuses_with(arguments, &[], code, needles);
    }

    /// [`Self::refuses`] with environment variables set.
    #[track_caller]
    pub fn refuses_with(
        &self,
        arguments: &[&str],
        environment: &[(&str, &str)],
        code: i32,
        needles: &[&str],
    ) {
        let before = self.contents();
        let output = self.run_with(arguments, environment);
        assert_one_line_error(&output, code, needles);
        assert_eq!(before, self.contents(), "{arguments:?} must leave nothing behind");
    }
}

/// Fails unless the command ended with `code`, said nothing but one line on standard error, and that line
/// holds all of `needles`.
#[track_caller]
pub fn assert_one_line_error(output: &Output, code: i32, needles: &[&str]) {
    assert_eq!(error_fault(output, code, needles), None);
}

/// Fails unless the command ended with 0.
#[track_caller]
pub fn assert_good(output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
}

/// What [`assert_one_line_error`] minds, if anything.
pub fn error_fault(output: &Output, code: i32, needles: &[&str]) -> Option<String> {
    let said = String::from_utf8_lossy(&output.stderr);
    let fault = |what: String| Some(format!("{what}; standard error: {said:?}"));
    if output.status.code() != Some(code) {
        return fault(format!("expected exit code {code}, found {}", output.status));
    }
    if !output.stdout.is_empty() {
        let printed = String::from_utf8_lossy(&output.stdout);
        return fault(format!("expected an empty standard output, found {printed:?}"));
    }
    let Some(line) = said.strip_suffix('\n') else {
        return fault("expected a line".to_owned());
    };
    if line.is_empty() || line.contains(|c: char| c.is_control()) {
        return fault("expected exactly one plain line".to_owned());
    }
    if line.contains("panicked") || line.len() > 500 {
        return fault("expected something that a person can read".to_owned());
    }
    needles
        .iter()
        .find(|needle| !line.contains(**needle))
        .and_then(|needle| fault(format!("expected {needle:?}")))
}
