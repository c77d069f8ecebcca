//! The `worsted` command: parse, run, report.

use clap::Parser;
use std::io::Write;
use std::process::ExitCode;
use worsted::cli::args::Args;

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return report(&error),
    };
    worsted::cli::start_logging(&args.common);
    match worsted::cli::run(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&error.to_string());
            ExitCode::from(error.exit_code())
        }
    }
}

/// Prints help and version as they are, and a mistake as one line.
fn report(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return match error.print() {
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => ExitCode::FAILURE,
            _ => ExitCode::SUCCESS,
        };
    }
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.is_empty());
    let line = lines.collect::<Vec<_>>().join(" ");
    complain(line.strip_prefix("error: ").unwrap_or(&line));
    ExitCode::from(worsted::error::EXIT_BAD_INPUT)
}

/// One line on standard error, or nothing where nobody listens there.
fn complain(message: &str) {
    drop(writeln!(std::io::stderr(), "worsted: {message}"));
}
