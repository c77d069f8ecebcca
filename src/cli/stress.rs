//! `worsted stress`.

use super::args::{Common, Stress};
use super::open_device;
use super::output::write_text;
use super::progress::{set_share, share_bar};
use crate::cli::say;
use crate::error::Error;
use crate::io::whole::check_target;
use crate::stress::{report, stress};
use crate::vulkan::Device;
use std::path::Path;

/// Sweeps, writes the tables, judges.
///
/// # Errors
/// No usable device, files that cannot be written, rows that do not hold.
pub fn run(args: &Stress, common: &Common) -> Result<(), Error> {
    let files = [args.table.as_deref(), args.json.as_deref()];
    for path in files.into_iter().flatten().filter(|path| *path != Path::new("-")) {
        check_target(path)?;
    }
    let device = open_device(common)?;
    let bar = share_bar(common);
    let found = stress(&device, args.quick, &|share| set_share(&bar, share));
    bar.finish_and_clear();
    Device::shutdown(device)?;
    let found = found?;
    let table = report::markdown(&found);
    match &args.table {
        Some(path) => write_text(path, &table)?,
        None if args.json.as_deref() != Some(Path::new("-")) && !common.quiet => {
            say::print(format_args!("{table}"))
        }
        None => {}
    }
    if let Some(path) = &args.json {
        let text = report::json(&found).map_err(|e| Error::Failed(format!("figures: {e}")))?;
        write_text(path, &text)?;
    }
    if found.holds() {
        return Ok(());
    }
    let bad: Vec<String> = found
        .rows
        .iter()
        .filter(|row| !row.holds())
        .map(|row| format!("{} by {}", row.what, row.swept))
        .collect();
    Err(Error::Failed(format!("{} of {} rows do not hold: {}", bad.len(), found.rows.len(), bad.join(", "))))
}
