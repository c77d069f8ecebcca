//! What was typed becomes a job, and the job runs: one file per command.

pub mod args;
mod bench;
pub mod bench_args;
mod budget;
mod compare;
mod doctor;
mod encode;
mod export;
mod info;
pub mod job;
mod knit;
mod output;
mod play;
pub mod play_args;
mod play_record;
mod probe;
mod progress;
mod reference;
mod render;
mod say;
mod stress;
#[cfg(feature = "viewer")]
mod view;
#[cfg(feature = "viewer")]
pub mod view_args;
#[cfg(feature = "viewer")]
mod view_references;

use crate::error::Error;
use crate::vulkan::{Device, DeviceOptions, Validation};
use args::{Args, Command, Common};
use std::io::IsTerminal;
use std::sync::Arc;

/// Runs the command that was typed.
///
/// # Errors
/// One line, and an exit code.
pub fn run(args: &Args) -> Result<(), Error> {
    run_command(args)?;
    say::finish()
}

fn run_command(args: &Args) -> Result<(), Error> {
    match &args.command {
        Command::Render(render) => render::run(job::RenderJob::new(render, &args.common)?),
        Command::Play(play) => play::run(play::PlayJob::new(play, &args.common)?),
        #[cfg(feature = "viewer")]
        Command::View(view) => view::run(view, &args.common),
        Command::Bench(bench) => bench::run(bench, &args.common),
        Command::Reference(reference) => {
            reference::run(&reference::ReferenceJob::new(reference, &args.common)?)
        }
        Command::Compare(compare) => compare::run(compare, &args.common),
        Command::Export(export) => export::run(export, &args.common),
        Command::Knit(knit) => knit::run(knit),
        Command::Info(info) => info::run(info),
        Command::Doctor => doctor::run(&args.common),
        Command::Probe(probe) => probe::run(probe, &args.common),
        Command::Stress(stress) => stress::run(stress, &args.common),
    }
}

/// Sends log lines to standard error, as many as `-q` and `-v` ask for.
pub fn start_logging(common: &Common) {
    use tracing::level_filters::LevelFilter;
    let level = match (common.quiet, common.verbose) {
        (true, _) => LevelFilter::ERROR,
        (false, 0) => LevelFilter::WARN,
        (false, 1) => LevelFilter::INFO,
        (false, _) => LevelFilter::DEBUG,
    };
    tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .without_time()
        .log_internal_errors(false)
        .init();
}

/// Opens the device that was asked for. Debug builds, and release builds with `--validate`, check every
/// call; a validation error ends the run.
fn open_device(common: &Common) -> Result<Arc<Device>, Error> {
    Ok(Device::new(&device_options(common))?)
}

fn device_options(common: &Common) -> DeviceOptions {
    let validation = if common.validate {
        Validation::On { required: true, sync: true }
    } else if cfg!(debug_assertions) {
        Validation::On { required: false, sync: true }
    } else {
        Validation::Off
    };
    let choice = common.device.parse().unwrap_or_default();
    DeviceOptions { choice, validation, ..Default::default() }
}
