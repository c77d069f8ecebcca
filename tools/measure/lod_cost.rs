//! CPU and wall time of one picture with level of detail and without, in one process.

use crate::cost::{Cost, Options, Way, compare};
use crate::report::Verdicts;
use crate::stage::{EVERY_FIBER, Stage};
use worsted::error::Error;

/// Least CPU time without level of detail, as a multiple of that with it: set for the trellis pattern in full
/// view at 1280 x 960 on a software device.
const LEAST_GAIN: f64 = 8.0;

/// What is drawn, in this order. The first comes again at the end, so that what changes as a process warms up
/// shows as a difference between the two.
const WAYS: [Way<'_>; 4] = [
    ("level of detail", &["quality.level_of_detail=true"]),
    ("no level of detail", &["quality.level_of_detail=false"]),
    ("every fiber", &[EVERY_FIBER]),
    ("level of detail again", &["quality.level_of_detail=true"]),
];

/// Draws the model every way, prints the times and whether the gain is enough.
///
/// # Errors
/// Those of the scene and the device; too little gain.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    verdict(&compare(stage, options, "Cost of level of detail", &WAYS)?)
}

/// Judges by the slower of the two pictures with level of detail.
fn verdict(costs: &[Cost]) -> Result<(), Error> {
    let [first, without, _, last] = costs else {
        return Err(Error::Failed(format!("expected 4 pictures, found {}", costs.len())));
    };
    let gain = without.render.cpu / first.render.cpu.max(last.render.cpu);
    let mut verdicts = Verdicts::default();
    let holds = verdicts.at_least("gain in CPU time", gain, LEAST_GAIN);
    println!("\nWithout level of detail {gain:.2} times the CPU time; at least {LEAST_GAIN}: {holds}.");
    verdicts.finish()
}
