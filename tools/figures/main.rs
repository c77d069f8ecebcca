//! Draws the pictures of docs/figures.md, one command each: `figures fig4|fig10|presets|demo`.

mod demo;
mod fig10;
mod fig4;
mod looks;
mod presets;
mod sheet;
mod stage;

use std::process::ExitCode;
use std::sync::Arc;
use worsted::error::Error;
use worsted::vulkan::{Device, DeviceOptions};

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("figures: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(arguments: &[String]) -> Result<(), Error> {
    let figure: fn(&Arc<Device>) -> Result<(), Error> = match arguments {
        [name] if name == "fig4" => fig4::draw,
        [name] if name == "fig10" => fig10::draw,
        [name] if name == "presets" => presets::draw,
        [name] if name == "demo" => demo::draw,
        _ => {
            let found = arguments.join(" ");
            return Err(Error::Arguments(format!("expected fig4, fig10, presets or demo, found `{found}`")));
        }
    };
    let device = Device::new(&DeviceOptions::default())?;
    figure(&device)?;
    Device::shutdown(device)?;
    Ok(())
}
