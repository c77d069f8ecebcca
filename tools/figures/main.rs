//! Draws the pictures of docs/figures.md, one command each: `figures fig4|fig9|fig10|...`.

mod demo;
mod extremes;
mod fig10;
mod fig11;
mod fig12;
mod fig13;
mod fig14;
mod fig16;
mod fig4;
mod fig5;
mod fig6;
mod fig7;
mod fig8;
mod fig9;
mod looks;
mod presets;
mod section;
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

/// Draws a figure.
type Draw = fn(&Arc<Device>) -> Result<(), Error>;

/// Every figure by its name.
const FIGURES: [(&str, Draw); 15] = [
    ("fig4", fig4::draw),
    ("fig5", fig5::draw),
    ("fig6", fig6::draw),
    ("fig7", fig7::draw),
    ("fig8", fig8::draw),
    ("fig9", fig9::draw),
    ("fig10", fig10::draw),
    ("fig11", fig11::draw),
    ("fig12", fig12::draw),
    ("fig13", fig13::draw),
    ("fig14", fig14::draw),
    ("fig16", fig16::draw),
    ("presets", presets::draw),
    ("demo", demo::draw),
    ("extremes", extremes::draw),
];

fn run(arguments: &[String]) -> Result<(), Error> {
    let found = arguments.join(" ");
    let Some((_, figure)) = FIGURES.iter().find(|(name, _)| *name == found) else {
        let names = FIGURES.map(|(name, _)| name).join(", ");
        return Err(Error::Arguments(format!("expected one of {names}; found `{found}`")));
    };
    let device = Device::new(&DeviceOptions::default())?;
    figure(&device)?;
    Device::shutdown(device)?;
    Ok(())
}
