//! `worsted probe`.

use super::args::{Backend, Common, Probe};
use super::{open_device, say};
use crate::error::Error;
use crate::probe::{Kernel, Tally, find, probe};
use crate::vulkan::Device;

/// Answers the queries on standard input.
///
/// # Errors
/// No usable device, and lines that could not be answered.
pub fn run(args: &Probe, common: &Common) -> Result<(), Error> {
    let function =
        find(&args.function).ok_or_else(|| Error::Arguments(format!("no function `{}`", args.function)))?;
    let (queries, answers) = (std::io::stdin().lock(), say::Answers::new());
    let tally = match args.backend {
        Backend::F64 => probe(function, None, queries, answers),
        Backend::Device => {
            let device = open_device(common)?;
            let kernel = Kernel::new(&device, function)?;
            let tally = probe(function, Some(kernel), queries, answers);
            Device::shutdown(device)?;
            tally
        }
    };
    // Who reads no more answers wants no more.
    if say::is_over() {
        return Ok(());
    }
    let Tally { lines, errors } = tally?;
    if errors > 0 {
        return Err(Error::Failed(format!("{errors} of {lines} lines could not be answered")));
    }
    Ok(())
}
