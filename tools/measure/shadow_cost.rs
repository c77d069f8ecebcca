//! CPU and wall time of one picture with shadows and occlusion and without, in one process.

use crate::cost::{Cost, Options, Way, compare};
use crate::report::Verdicts;
use crate::stage::Stage;
use worsted::error::Error;

/// Most CPU time with everything, as a multiple of that without: with a map of 1024 texels a side, full view, on a
/// software device.
const MOST_COST: f64 = 1.6;

const MAP: &str = "shadow.map=true";
const SELF: &str = "shadow.self=true";
const NO_OCCLUSION: &str = "occlusion.mode=none";

/// What is drawn, in this order. The first comes again at the end, so that what changes as a process warms up
/// shows as a difference between the two.
const WAYS: [Way<'_>; 7] = [
    ("none", &[NO_OCCLUSION]),
    ("shadow map alone", &[MAP, NO_OCCLUSION]),
    ("self-shadow alone", &[SELF, NO_OCCLUSION]),
    ("distance occlusion alone", &[]),
    ("occlusion texture alone", &["occlusion.mode=texture"]),
    ("all", &[MAP, SELF]),
    ("none again", &[NO_OCCLUSION]),
];

/// Draws the model every way, prints the times and whether the cost is small enough.
///
/// # Errors
/// Those of the scene and the device; too much cost.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    verdict(&compare(stage, options, "Cost of shadows and occlusion", &WAYS)?)
}

/// Judges by the faster of the two pictures without.
fn verdict(costs: &[Cost]) -> Result<(), Error> {
    let [first, .., all, last] = costs else {
        return Err(Error::Failed(format!("expected 7 pictures, found {}", costs.len())));
    };
    let cost = all.render.cpu / first.render.cpu.min(last.render.cpu);
    let mut verdicts = Verdicts::default();
    let holds = verdicts.at_most("cost in CPU time", cost, MOST_COST);
    println!("\nWith all of it {cost:.2} times the CPU time; at most {MOST_COST}: {holds}.");
    verdicts.finish()
}
