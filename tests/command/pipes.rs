//! Commands whose listeners leave: they end quietly, and a full disk is still an error.

use super::process::{Workplace, swatch};
use std::fs::OpenOptions;
use std::process::{Command, Stdio};

/// The command with `arguments` and nobody at the other end of what `stdout` and `stderr` are: how it ended, and what it
/// said on standard error.
fn unheard(place: &Workplace, arguments: &[&str], stderr_too: bool) -> (Option<i32>, String) {
    let deaf = || {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        Stdio::from(writer)
    };
    let mut command = Command::new(env!("CARGO_BIN_EXE_worsted"));
    command.current_dir(place.path(".")).args(arguments).stdin(Stdio::null()).stdout(deaf());
    command.stderr(if stderr_too { deaf() } else { Stdio::piped() });
    let output = command.spawn().unwrap().wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn commands_end_quietly_where_nobody_listens() {
    let (place, swatch) = (Workplace::new(), swatch());
    let device = ["--device", "software"];
    let render = ["render", &swatch, "--size", "32x24", "-o", "a.png", "--explain", "--stats", "-"];
    let commands: [&[&str]; 7] = [
        &["info", &swatch],
        &["--help"],
        &["probe", "--help"],
        &["export", &swatch, "-o", "a.bcc", "--set", "yarn.fibers_per_ply=2"],
        &["knit", "stockinette", "--courses", "2", "--wales", "3", "-o", "k.bcc"],
        &[&device[..], &render].concat(),
        &["compare", "a.png", "a.png"],
    ];
    for arguments in commands {
        let (code, said) = unheard(&place, arguments, false);
        assert_eq!(code, Some(0), "{arguments:?}: {said}");
        assert!(!said.contains("panicked") && !said.contains("Broken pipe"), "{arguments:?}: {said}");
        assert_eq!(
            unheard(&place, arguments, true).0,
            Some(0),
            "{arguments:?} with nobody at standard error"
        );
    }
    assert_eq!(unheard(&place, &["info", "none.bcc"], true).0, Some(2), "a mistake is still one");
}

#[test]
fn a_probe_ends_where_nobody_reads_its_answers() {
    let place = Workplace::new();
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    place.write("queries", "{\"theta\": 0.5, \"width\": 0.1}\nno query\n".repeat(20_000));
    let queries = std::fs::File::open(place.path("queries")).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_worsted"));
    command.args(["probe", "longitudinal_normaliser", "--backend", "f64"]);
    let output = command.stdin(queries).stdout(writer).stderr(Stdio::piped()).output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]));
}

#[test]
fn what_cannot_be_written_is_an_error() {
    let (place, swatch) = (Workplace::new(), swatch());
    let Ok(full) = OpenOptions::new().write(true).open("/dev/full") else { return };
    let mut command = Command::new(env!("CARGO_BIN_EXE_worsted"));
    command.current_dir(place.path(".")).args(["info", &swatch]);
    let output = command.stdout(full).stderr(Stdio::piped()).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.starts_with("worsted: cannot write to standard output: ") && said.lines().count() == 1,
        "{said}"
    );
}
