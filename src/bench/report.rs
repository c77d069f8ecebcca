//! What came out: every picture with its error, times and memory, as JSON and as CSV.

use super::settings::Setting;
use super::truth::Floor;
use crate::error::Error;
use crate::io::error::{FileError, Place};
use crate::io::whole::write_whole;
use crate::math::spread::Spread;
use crate::metrics::error_vs_time::{Outcome, front};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The report's file, which a later run of the same command goes on from.
pub const JSON_FILE: &str = "bench.json";
/// The same as a table.
pub const CSV_FILE: &str = "bench.csv";

/// What all pictures have in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// When the run began, UTC.
    pub date: String,
    /// This program's version.
    pub version: String,
    /// Device name.
    pub device: String,
    /// Driver and version.
    pub driver: String,
    /// Processors that this program may use.
    pub processors: usize,
    /// What the times are.
    pub timing_method: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel of the references.
    pub reference_samples: u64,
    /// What was drawn.
    pub model: String,
}

/// What a scene holds, plainly counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Control points of the yarns.
    pub control_points: u64,
    /// Fibers of every piece of yarn: pieces times fibers.
    pub fiber_curves: u64,
    /// Straight pieces of fiber that were drawn; 0 where they were not counted.
    pub fiber_segments: u64,
}

/// One place that the scene is looked at from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewFacts {
    /// What it is called.
    pub name: String,
    /// Width in pixels of a fiber at what the camera looks at.
    pub fiber_px: f64,
    /// What noise alone makes of a perfect picture, by its samples.
    pub floors: Vec<Floor>,
    /// How far the reference's straight pieces depart from fibers, in radii of these.
    pub chord_error: f64,
    /// The reference as displayed, a PNG in the report's folder.
    pub thumbnail: String,
}

/// One picture: a view, drawn in one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Everything that decides it, in hexadecimal: a cell of the same key is not measured again.
    pub key: String,
    /// The view's name.
    pub view: String,
    /// The way it was drawn.
    pub setting: Setting,
    /// Mean FLIP over covered pixels against the reference.
    pub flip: f64,
    /// Mean squared error of radiance over covered pixels.
    pub mse: f64,
    /// Mean FLIP of a perfect picture of as many samples, by noise alone; absent where none was traced.
    pub floor_flip: Option<f64>,
    /// Processor time of all threads, ms.
    pub cpu_ms: Option<Spread>,
    /// Wall time from submission to fence, ms.
    pub wall_ms: Spread,
    /// Between the device's own timestamps, ms.
    pub device_ms: Option<Spread>,
    /// Device memory in bytes.
    pub gpu_bytes: u64,
    /// What was drawn.
    pub counts: Counts,
    /// What [`super::work::work`] makes of the scene's counts.
    pub work: f64,
    /// A small picture in the report's folder.
    pub thumbnail: String,
}

impl Cell {
    /// The time to judge by: the device's own where it has a clock, the processor's where that is the device, else the
    /// wall's.
    pub fn time(&self, head: &Head) -> Spread {
        match (self.device_ms, self.cpu_ms) {
            (Some(device), _) => device,
            (None, Some(cpu)) if head.timing_method == TIMED_BY_PROCESSOR => cpu,
            _ => self.wall_ms,
        }
    }
}

/// Times of a device with a clock.
pub const TIMED_BY_DEVICE: &str = "device timestamps around each submission";
/// Times of a CPU device.
pub const TIMED_BY_PROCESSOR: &str = "processor time of all threads of the process";
/// Times of any other.
pub const TIMED_BY_WALL: &str = "wall time from each submission to its fence";

/// All of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// What all pictures have in common.
    pub head: Head,
    /// The views, in order.
    pub views: Vec<ViewFacts>,
    /// The pictures, in order.
    pub cells: Vec<Cell>,
    /// What a reader must know of how sure the figures are, one line each.
    pub warnings: Vec<String>,
}

impl Report {
    /// Reads what [`Report::write`] wrote, if it is there.
    ///
    /// # Errors
    /// A file that cannot be read, or is no report.
    pub fn read(folder: &Path) -> Result<Option<Self>, Error> {
        let path = folder.join(JSON_FILE);
        let bytes = match std::fs::read(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            read => read.map_err(|e| FileError::io(&path, "read", &e))?,
        };
        let found = serde_json::from_slice(&bytes).map_err(|e| {
            let line = Place::Line(e.line() as u64);
            let message =
                format!("expected a report of `worsted bench`: {e}; remove it or choose another -o");
            FileError::new(&path, line, message.replace('\n', " "))
        })?;
        Ok(Some(found))
    }

    /// Writes the report as JSON and as CSV.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&self, folder: &Path) -> Result<(), Error> {
        let text = serde_json::to_string_pretty(self).map_err(|e| Error::Failed(format!("report: {e}")))?;
        write_whole(&folder.join(JSON_FILE), |out| writeln!(out, "{text}"))?;
        let table = self.csv()?;
        Ok(write_whole(&folder.join(CSV_FILE), |out| out.write_all(&table))?)
    }

    /// The pictures of a view, in the settings' order.
    pub fn cells_of<'a, 'v>(&'a self, view: &'v str) -> impl Iterator<Item = &'a Cell> + use<'a, 'v> {
        self.cells.iter().filter(move |cell| cell.view == view)
    }

    /// A picture by its view and the name of its settings.
    pub fn cell(&self, view: &str, setting: &str) -> Option<&Cell> {
        self.cells_of(view).find(|cell| cell.setting.name == setting)
    }

    /// The pictures of a view that none of its others beats in error and time, the fastest first.
    pub fn front(&self, view: &str) -> Vec<&Cell> {
        let cells: Vec<&Cell> = self.cells_of(view).collect();
        let outcome = |cell: &&Cell| Outcome { error: cell.flip, time: cell.time(&self.head).median };
        let outcomes: Vec<Outcome> = cells.iter().map(outcome).collect();
        front(&outcomes).into_iter().map(|index| cells[index]).collect()
    }

    /// Lines about times that lie too far apart to be relied on.
    pub fn spread_warnings(&self) -> Vec<String> {
        let wide = self.cells.iter().filter(|cell| cell.time(&self.head).is_wide());
        let line = |cell: &Cell| {
            let percent = 100.0 * cell.time(&self.head).relative();
            format!("{}, {}: times spread by {percent:.0}% of their median", cell.view, cell.setting.name)
        };
        wide.map(line).collect()
    }

    fn csv(&self) -> Result<Vec<u8>, Error> {
        let failed = |e: csv::Error| Error::Failed(format!("table: {e}"));
        let mut table = csv::Writer::from_writer(Vec::new());
        table.write_record(COLUMNS).map_err(failed)?;
        for cell in &self.cells {
            let time = cell.time(&self.head);
            let fiber_px = self.views.iter().find(|view| view.name == cell.view).map(|view| view.fiber_px);
            let maybe = |value: Option<f64>| value.map(|v| v.to_string()).unwrap_or_default();
            let median = |spread: Option<Spread>| maybe(spread.map(|s| s.median));
            let row = [
                cell.view.clone(),
                cell.setting.name.clone(),
                cell.setting.sets.join("; "),
                cell.setting.samples.to_string(),
                maybe(fiber_px),
                cell.flip.to_string(),
                maybe(cell.floor_flip),
                cell.mse.to_string(),
                time.median.to_string(),
                time.min.to_string(),
                time.max.to_string(),
                time.frames.to_string(),
                median(cell.cpu_ms),
                cell.wall_ms.median.to_string(),
                median(cell.device_ms),
                cell.gpu_bytes.to_string(),
                cell.counts.control_points.to_string(),
                cell.counts.fiber_curves.to_string(),
                cell.counts.fiber_segments.to_string(),
            ];
            table.write_record(&row).map_err(failed)?;
        }
        table.into_inner().map_err(|e| Error::Failed(format!("table: {e}")))
    }
}

/// Columns of the CSV; `time` is what the page plots.
const COLUMNS: [&str; 19] = [
    "view",
    "setting",
    "set",
    "samples",
    "fiber_px",
    "flip",
    "floor_flip",
    "mse",
    "time_ms_median",
    "time_ms_min",
    "time_ms_max",
    "frames",
    "cpu_ms",
    "wall_ms",
    "device_ms",
    "gpu_bytes",
    "control_points",
    "fiber_curves",
    "fiber_segments",
];

#[cfg(test)]
#[path = "report_tests.rs"]
mod tests;
#[cfg(test)]
pub use tests::sample;
