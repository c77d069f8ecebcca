//! The `worsted` command: parse, run, report.

use clap::Parser;
use std::process::ExitCode;
use worsted::cli::args::Args;

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => {
            // Help and version come this way too, with exit code 0.
            let code = error.exit_code();
            return match error.print() {
                Ok(()) => ExitCode::from(u8::try_from(code).unwrap_or(worsted::error::EXIT_BAD_INPUT)),
                Err(_) => ExitCode::FAILURE,
            };
        }
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
