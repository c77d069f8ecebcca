//! Level of detail where it sets in: fibers exactly as wide as the threshold, and one step of f32 to either side.

use super::verdict::{Collector, Row};
use crate::error::Error;
use crate::probe::fields::Values;
use crate::probe::{Kernel, find, parse};
use crate::vulkan::Device;
use serde_json::{Value, json};
use std::sync::Arc;

/// Thresholds in pixels.
const THRESHOLDS: [f32; 6] = [1e-6, 0.05, 0.75, 1.0, 1.5, 40.0];
/// Widths of a ply, in thresholds.
const PLIES: [f32; 5] = [1.0, 1.000_001, 1.1, 3.0, 1e4];
/// Most that the factor may change over one step of f32 next to a threshold, and be off.
const LIMIT: f64 = 1e-4;

/// Every row.
///
/// # Errors
/// Those of the device.
pub fn rows(device: &Arc<Device>) -> Result<Vec<Row>, Error> {
    let function = find("lod_factor").ok_or_else(|| Error::Failed("no function `lod_factor`".to_owned()))?;
    let mut kernel = Kernel::new(device, function)?;
    let mut asked = Vec::new();
    for lod in THRESHOLDS {
        for ply in PLIES.map(|ply| ply * lod) {
            for fiber in [lod.next_down(), lod, lod.next_up()] {
                asked.push(([lod, fiber, ply], (fiber >= lod).then_some(1.0)));
            }
            // A ply as narrow as the threshold is its core alone, whatever its fibers are.
            for narrow in [lod.next_down(), lod] {
                asked.push(([lod, 0.5 * lod, narrow], Some(0.0)));
            }
        }
    }
    let query = |[lod, fiber, ply]: [f32; 3]| -> Value {
        json!({"width_lod": lod, "width_fiber": fiber, "width_ply": ply})
    };
    let numbers: Result<Vec<Vec<f64>>, String> =
        asked.iter().map(|(widths, _)| parse(function, &query(*widths).to_string())).collect();
    let numbers = numbers.map_err(Error::Failed)?;
    let slices: Vec<&[f64]> = numbers.iter().map(Vec::as_slice).collect();
    let found = kernel.numbers(&slices)?;
    let mut c = Collector::default();
    for ((slice, found), (widths, stated)) in slices.iter().zip(&found).zip(&asked) {
        let at = || query(*widths).to_string();
        let exact = (function.exact)(Values::new(slice))[0];
        c.points(1);
        c.numbers(found, false, at);
        c.error((found[0] - exact).abs(), LIMIT, at);
        if let Some(stated) = stated {
            c.error((found[0] - stated).abs(), LIMIT, at);
        }
        c.demand(found[0] <= 1.0, || format!("{} is more than all fibers", found[0]));
    }
    Ok(vec![c.row(
        "level of detail",
        "lod_factor",
        "exactly at the threshold",
        "and one step of f32 to either side",
    )])
}
