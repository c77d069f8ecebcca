//! Whether the device can be trusted at the ends of every domain: each parameter swept alone and in random pairs to
//! its ends and past them, the device against f64, and what only pictures show.
//!
//! Nothing here decides how anything is drawn. Domains are those of [`crate::probe`] and of scene files; what is
//! allowed is stated in [`measure`] and beside what each group tries.

pub mod cases;
mod detail;
mod exposure;
pub mod extremes;
mod frames;
mod geometry;
mod inputs;
pub mod measure;
mod order;
pub mod placed;
pub mod queries;
pub mod report;
mod sweep;
pub mod tables;
pub mod verdict;

use crate::error::Error;
use crate::probe::{Kernel, find};
use crate::shaders::ShaderSet;
use crate::vulkan::Device;
use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;
use sweep::Effort;
use verdict::Row;

/// What a run found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The device's name and driver.
    pub device: String,
    /// Whether it was the short run.
    pub quick: bool,
    /// Wall time.
    pub seconds: f64,
    /// All rows, group by group.
    pub rows: Vec<Row>,
}

impl Report {
    /// Whether every row holds.
    pub fn holds(&self) -> bool {
        !self.rows.is_empty() && self.rows.iter().all(Row::holds)
    }
}

/// Functions of each group that probing reaches, and how many times less each is tried than a plain one.
const SWEPT: &[(&str, &str, usize)] = &[
    ("scattering", "simple_specular", 1),
    ("scattering", "longitudinal_normaliser", 1),
    ("scattering", "azimuthal_tt", 1),
    ("scattering", "bcsdf", 2),
    ("scattering", "bcsdf_cos", 2),
    // Each distinct width is a table of integrals of integrals.
    ("scattering", "ambient_scattering", 40),
    ("geometry", "curve_point", 1),
    ("geometry", "fiber_point", 1),
    ("geometry", "migration_radius", 1),
    ("level of detail", "lod_factor", 1),
    ("tables", "fiber_density", 1),
];

/// How much a whole run tries, and the short one for every change.
const WHOLE: Effort = Effort { surroundings: 12, values: 150, pairs: 100_000 };
const QUICK: Effort = Effort { surroundings: 3, values: 12, pairs: 1_500 };
/// The short run of one function alone, with shaders of the caller's: a test puts wrong ones in.
///
/// # Errors
/// No such function; those of the device.
#[doc(hidden)]
pub fn sweep_with(device: &Arc<Device>, name: &str, shaders: &ShaderSet) -> Result<Vec<Row>, Error> {
    let function = find(name).ok_or_else(|| Error::Failed(format!("no function `{name}`")))?;
    Ok(sweep::sweep(Kernel::with_shaders(device, function, shaders)?, function, "", QUICK)?)
}

/// Tries everything. `progress` is told the share done.
///
/// # Errors
/// Those of the device.
pub fn stress(device: &Arc<Device>, quick: bool, progress: &dyn Fn(f64)) -> Result<Report, Error> {
    let started = Instant::now();
    let effort = if quick { QUICK } else { WHOLE };
    let mut rows = Vec::new();
    let parts = SWEPT.len() as f64 + 6.0;
    for (done, (group, name, less)) in SWEPT.iter().enumerate() {
        progress(done as f64 / parts);
        let function = find(name).ok_or_else(|| Error::Failed(format!("no function `{name}`")))?;
        rows.extend(sweep::sweep(Kernel::new(device, function)?, function, group, effort.less(*less))?);
    }
    type Group<'a> = (&'a str, &'a dyn Fn() -> Result<Vec<Row>, Error>);
    let groups: [Group<'_>; 6] = [
        ("whole yarns", &|| geometry::rows(device, quick)),
        ("level of detail", &|| detail::rows(device)),
        ("tables", &|| tables::rows(device, quick)),
        ("frames", &|| Ok(frames::rows(quick))),
        ("exposure", &|| exposure::rows(device, effort, quick)),
        ("pictures", &|| extremes::rows(device, quick)),
    ];
    for (done, (name, group)) in groups.into_iter().enumerate() {
        progress((SWEPT.len() + done) as f64 / parts);
        let begun = Instant::now();
        rows.extend(group()?);
        tracing::info!("{name}: {:.1} s", begun.elapsed().as_secs_f64());
    }
    // Rows of one group come from several places.
    let order = ["scattering", "geometry", "level of detail", "tables", "frames", "exposure", "pictures"];
    rows.sort_by_key(|row| order.iter().position(|group| *group == row.group));
    let device = format!("{} ({})", device.name(), device.driver());
    Ok(Report { device, quick, seconds: started.elapsed().as_secs_f64(), rows })
}
