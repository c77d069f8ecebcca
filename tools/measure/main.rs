//! Measures what level of detail and tables cost and save, and says whether their limits hold: `measure
//! lod-error|lod-cost|dolly|turntable|tables|shadow-tables|shadow-cost|judge|budgets|motion|animation-cost|
//! animation-memory`. Exit codes are those of `worsted`;
//! 1 is a limit that does not hold.

mod animation_cost;
mod animation_memory;
mod budget_scenes;
mod budgets;
mod cost;
mod dolly;
mod judge;
mod lod_cost;
mod lod_error;
#[path = "../figures/looks.rs"]
mod looks;
mod motion;
mod motion_sky;
mod pictures;
mod report;
mod shadow_cost;
mod shadow_tables;
mod stage;
mod tables;
mod turntable;

use clap::{Parser, Subcommand};
use stage::Stage;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::process::ExitCode;
use worsted::error::Error;

/// Counts what is allocated, for `animation-memory`.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// What can be typed.
#[derive(Debug, Parser)]
#[command(name = "measure", about = "Error and cost of level of detail, culling and tables")]
struct Args {
    /// Device by name, by index, or `software` for a CPU device.
    #[arg(long, global = true, default_value = "auto", value_name = "NAME|INDEX|software")]
    device: String,
    /// What to measure.
    #[command(subcommand)]
    command: Command,
}

/// The measurements.
#[derive(Debug, Subcommand)]
enum Command {
    /// Error of the default settings against every fiber.
    LodError(lod_error::Options),
    /// CPU and wall time of a picture with level of detail and without.
    LodCost(cost::Options),
    /// Changes from frame to frame, and of the mean colour, as the camera goes from 5 cm to 5 m.
    Dolly(dolly::Options),
    /// Pictures with culling against pictures without, as pieces of yarn come and go.
    Turntable(turntable::Options),
    /// Error of the tables of fiber scattering by their size. Needs no device.
    Tables,
    /// CPU and wall time with shadows and occlusion and without.
    ShadowCost(cost::Options),
    /// Error of the self-shadow and occlusion tables against the integrals they stand for, by size.
    ShadowTables(shadow_tables::Options),
    /// Error of the default settings against the traced reference, and what each approximation has to do with it.
    Judge(judge::Options),
    /// Processor time of pictures of a frame against pictures at rest.
    AnimationCost(animation_cost::Options),
    /// Memory while many frames are played.
    AnimationMemory(animation_memory::Options),
    /// What motion adds to the turns of fibers about their yarns, and what skies that are not baked anew cost.
    Motion(motion::Options),
    /// Whether `worsted render --max-error` and `--max-ms` keep their promise in scenes they were not fitted to.
    Budgets(budgets::Options),
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("measure: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(args: &Args) -> Result<(), Error> {
    match &args.command {
        Command::LodError(options) => on_device(args, |stage| lod_error::run(stage, options)),
        Command::LodCost(options) => on_device(args, |stage| lod_cost::run(stage, options)),
        Command::Dolly(options) => on_device(args, |stage| dolly::run(stage, options)),
        Command::Turntable(options) => on_device(args, |stage| turntable::run(stage, options)),
        Command::Tables => tables::run(),
        Command::ShadowCost(options) => on_device(args, |stage| shadow_cost::run(stage, options)),
        Command::Judge(options) => on_device(args, |stage| judge::run(stage, options)),
        Command::AnimationCost(options) => on_device(args, |stage| animation_cost::run(stage, options)),
        Command::AnimationMemory(options) => on_device(args, |stage| animation_memory::run(stage, options)),
        Command::Motion(options) => on_device(args, |stage| motion::run(stage, options)),
        Command::Budgets(options) => on_device(args, |stage| budgets::run(stage, options)),
        Command::ShadowTables(options) => on_device(args, |stage| shadow_tables::run(stage, options)),
    }
}

fn on_device(args: &Args, measure: impl FnOnce(&Stage) -> Result<(), Error>) -> Result<(), Error> {
    let stage = Stage::new(&args.device)?;
    measure(&stage)?;
    stage.close()
}
