//! `worsted info`.

use super::args::Info;
use crate::cli::say::say;
use crate::error::Error;
use crate::io::repair::summarize_repairs;
use crate::io::yarn_file::load_yarn_file;
use crate::math::curve::Curve;
use crate::yarn::contact::estimate_contact_radius;
use glam::DVec3;

/// Prints what a yarn file holds.
///
/// # Errors
/// A file that cannot be read.
pub fn run(args: &Info) -> Result<(), Error> {
    let loaded = load_yarn_file(&args.yarn)?;
    let set = &loaded.curves;
    let closed = set.curves.iter().filter(|c| c.closed).count();
    let points: Vec<usize> = set.curves.iter().map(|c| c.points.len()).collect();
    let lengths: Vec<f64> = set.curves.iter().map(control_length).collect();
    let segments: usize = set.curves.iter().map(|c| c.points.len() - usize::from(!c.closed)).sum();
    let (low, high) = bounds(&set.curves);
    say!("format: {}, {:?} curves", loaded.format, set.basis);
    match set.up_axis {
        Some(axis) => say!("up axis: {axis:?}"),
        None => say!("up axis: not stated, Y is assumed"),
    }
    say!("curves: {} ({closed} closed, {} open)", set.curves.len(), set.curves.len() - closed);
    say!("control points: {} ({} to {} a curve)", set.point_count(), least(&points), most(&points));
    say!("bounds: {low:.4} to {high:.4} units");
    let total: f64 = lengths.iter().sum();
    say!("length: {total:.3} units in all, mean segment {:.4}", total / segments.max(1) as f64);
    say!("curve lengths: {:.3} to {:.3} units", fold(&lengths, f64::min), fold(&lengths, f64::max));
    match estimate_contact_radius(&set.curves, set.basis) {
        Some(radius) => say!("estimated contact radius: {radius:.4} units"),
        None => say!("estimated contact radius: none, no strands touch"),
    }
    for line in summarize_repairs(&loaded.repairs) {
        say!("repaired: {line}");
    }
    for note in &loaded.notes {
        say!("note: {note}");
    }
    Ok(())
}

/// Length of the polygon through a curve's control points.
fn control_length(curve: &Curve) -> f64 {
    let p = &curve.points;
    let open: f64 = p.windows(2).map(|w| (w[1] - w[0]).length()).sum();
    match (p.first(), p.last()) {
        (Some(first), Some(last)) if curve.closed => open + (*first - *last).length(),
        _ => open,
    }
}

fn bounds(curves: &[Curve]) -> (DVec3, DVec3) {
    let start = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    curves.iter().flat_map(|c| &c.points).fold(start, |(low, high), &p| (low.min(p), high.max(p)))
}

fn least(counts: &[usize]) -> usize {
    counts.iter().copied().min().unwrap_or(0)
}

fn most(counts: &[usize]) -> usize {
    counts.iter().copied().max().unwrap_or(0)
}

fn fold(values: &[f64], f: fn(f64, f64) -> f64) -> f64 {
    values.iter().copied().reduce(f).unwrap_or(0.0)
}
