//! The `worsted` command: parse, run, report.

use clap::Parser;
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
            eprintln!("worsted: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// Prints help and version as they are, and a mistake as one line.
fn report(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return if error.print().is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.is_empty());
    let line = lines.collect::<Vec<_>>().join(" ");
    eprintln!("worsted: {}", line.strip_prefix("error: ").unwrap_or(&line));
    ExitCode::from(worsted::error::EXIT_BAD_INPUT)
}
