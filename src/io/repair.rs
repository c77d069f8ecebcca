//! What real yarn files get wrong and a renderer must not stumble over.
//!
//! Per curve, in this order: zero-length segments are merged; the first point repeated as the last of a
//! closed curve is dropped; a closed curve whose ends are many segments apart is opened; a curve too
//! short to draw (open: fewer than two points; closed: fewer than three) is dropped with its record.
//! Nothing is invented and no point is moved, and good curves come through bit for bit.

use std::fmt;

use glam::DVec3;

use super::curves::{Basis, Curve, CurveSet};

/// One change to one curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repair {
    /// The curve, counted from 0 in the file.
    pub curve: usize,
    /// What was done to it.
    pub kind: RepairKind,
}

/// The kinds of change, with what makes them believable. Lengths in the file's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RepairKind {
    /// Points that repeat the one before (within [`DUPLICATE_SEGMENTS`]) were dropped.
    DuplicatesMerged {
        /// How many points went.
        points: usize,
    },
    /// A closed curve's last point repeated its first and was dropped.
    RepeatedEndDropped,
    /// A closed curve's ends were too far apart to be joined: it is open now.
    LoopOpened {
        /// Distance between the ends.
        gap: f64,
        /// Mean length of the curve's other segments.
        mean_segment: f64,
    },
    /// Too few distinct points were left to draw: the curve is gone.
    CurveDropped {
        /// How many points it had in the file.
        points: usize,
    },
}

/// A closing segment longer than this many mean segments is no segment of the yarn. Loops of up to 11
/// points can never exceed it; the longest closing segment of a sound loop measured was 1.2.
pub const OPEN_GAP_SEGMENTS: f64 = 10.0;

/// Points closer than this many median segments count as one: f32 noise, not yarn. (The median, because
/// one wild jump may carry the mean anywhere.)
pub const DUPLICATE_SEGMENTS: f64 = 1e-4;

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "curve {}: ", self.curve)?;
        match self.kind {
            RepairKind::DuplicatesMerged { points } => write!(f, "{points} zero-length segments merged"),
            RepairKind::RepeatedEndDropped => f.write_str("first point repeated as last dropped"),
            RepairKind::LoopOpened { gap, mean_segment } => {
                write!(f, "loop opened: gap {}", gap_text(gap, mean_segment))
            }
            RepairKind::CurveDropped { points } => write!(f, "dropped: too short ({points} points)"),
        }
    }
}

fn gap_text(gap: f64, mean_segment: f64) -> String {
    format!("{gap:.3} = {:.0} mean segments", gap / mean_segment)
}

/// The repairs by kind, one line each, for printing; empty where there were none.
pub fn summarize_repairs(repairs: &[Repair]) -> Vec<String> {
    let (mut merged, mut merged_in, mut ends, mut dropped) = (0, 0, 0, 0);
    let mut opened: Vec<(f64, f64)> = Vec::new();
    for repair in repairs {
        match repair.kind {
            RepairKind::DuplicatesMerged { points } => (merged, merged_in) = (merged + points, merged_in + 1),
            RepairKind::RepeatedEndDropped => ends += 1,
            RepairKind::LoopOpened { gap, mean_segment } => opened.push((gap, mean_segment)),
            RepairKind::CurveDropped { .. } => dropped += 1,
        }
    }
    let mut lines = Vec::new();
    if merged > 0 {
        lines.push(format!("{merged} zero-length segments merged in {}", counted(merged_in, "curve")));
    }
    if ends > 0 {
        lines.push(format!("{} with the first point repeated as last: last dropped", counted(ends, "loop")));
    }
    let widest = opened.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((gap, mean_segment)) = widest {
        let gaps = if opened.len() == 1 { "gap" } else { "gaps up to" };
        lines.push(format!(
            "{} opened: {gaps} {}",
            counted(opened.len(), "loop"),
            gap_text(gap, mean_segment)
        ));
    }
    if dropped > 0 {
        lines.push(format!("{} too short to draw dropped", counted(dropped, "curve")));
    }
    lines
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// Curves after repair.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    /// The curves that are left, possibly none.
    pub curves: CurveSet,
    /// What was done, in order of the curves.
    pub repairs: Vec<Repair>,
    /// See [`super::yarn_file::Loaded::kept_points`].
    pub kept_points: Option<Vec<usize>>,
}

/// Repairs every curve of a set whose coordinates are finite.
pub fn repair_curves(set: CurveSet) -> Repaired {
    let found = set.point_count();
    let mut repairs = Vec::new();
    let mut kept_points = Vec::with_capacity(found);
    let mut curves = Vec::with_capacity(set.curves.len());
    let mut first_point = 0;
    for (index, curve) in set.curves.into_iter().enumerate() {
        let points = curve.points.len();
        let mut work = Work::new(set.basis, curve);
        work.merge_duplicates();
        work.drop_repeated_end();
        work.open_wide_loop();
        if work.is_too_short() {
            work.keep.clear();
            work.repairs = vec![RepairKind::CurveDropped { points }];
        } else {
            curves.push(work.curve);
        }
        kept_points.extend(work.keep.iter().map(|i| first_point + i));
        repairs.extend(work.repairs.into_iter().map(|kind| Repair { curve: index, kind }));
        first_point += points;
    }
    Repaired {
        kept_points: (kept_points.len() < found).then_some(kept_points),
        curves: CurveSet { curves, ..set },
        repairs,
    }
}

/// One curve under repair.
struct Work {
    basis: Basis,
    curve: Curve,
    /// For each point left, its index in the curve as it was found.
    keep: Vec<usize>,
    repairs: Vec<RepairKind>,
    /// Points within this distance are one.
    tolerance: f64,
}

impl Work {
    fn new(basis: Basis, curve: Curve) -> Self {
        let mut legs: Vec<f64> =
            curve.points.windows(2).map(|p| p[0].distance(p[1])).filter(|&d| d > 0.0).collect();
        let middle = legs.len() / 2;
        let median =
            if legs.is_empty() { 0.0 } else { *legs.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let keep = (0..curve.points.len()).collect();
        Self { basis, curve, keep, repairs: Vec::new(), tolerance: DUPLICATE_SEGMENTS * median }
    }

    fn same(&self, a: DVec3, b: DVec3) -> bool {
        a.distance(b) <= self.tolerance
    }

    fn merge_duplicates(&mut self) {
        let drop = if self.basis == Basis::Bezier { self.collapsed_pieces() } else { self.repeated_points() };
        let points = drop.iter().filter(|&&d| d).count();
        if points == 0 {
            return;
        }
        let mut drop_point = drop.iter();
        self.curve.points.retain(|_| !drop_point.next().is_some_and(|&d| d));
        let mut drop_index = drop.iter();
        self.keep.retain(|_| !drop_index.next().is_some_and(|&d| d));
        self.repairs.push(RepairKind::DuplicatesMerged { points });
    }

    fn repeated_points(&self) -> Vec<bool> {
        let mut kept: Option<DVec3> = None;
        let mut repeats = |p: DVec3| {
            let repeats = kept.is_some_and(|k| self.same(k, p));
            if !repeats {
                kept = Some(p);
            }
            repeats
        };
        self.curve.points.iter().map(|&p| repeats(p)).collect()
    }

    /// A Bezier piece goes only when its handles lie on its ends too: otherwise it is a small loop.
    fn collapsed_pieces(&self) -> Vec<bool> {
        let p = &self.curve.points;
        let n = p.len();
        let mut drop = vec![false; n];
        // Closed curves have a last piece that comes back to point 0, unless point 0 is repeated.
        let pieces = if self.curve.closed { n / 3 } else { n.saturating_sub(1) / 3 };
        for start in (0..pieces).map(|i| 3 * i) {
            if (start..start + 3).all(|i| self.same(p[i], p[(i + 1) % n])) {
                drop[start..start + 3].fill(true);
            }
        }
        drop
    }

    fn drop_repeated_end(&mut self) {
        let mut dropped = false;
        while let [first, .., last] = self.curve.points[..]
            && self.curve.closed
            && self.same(first, last)
            && (self.basis != Basis::Bezier || self.curve.points.len() % 3 == 1)
        {
            self.truncate(self.curve.points.len() - 1);
            dropped = true;
        }
        if dropped {
            self.repairs.push(RepairKind::RepeatedEndDropped);
        }
    }

    fn open_wide_loop(&mut self) {
        let n = self.curve.points.len();
        if !self.curve.closed || n <= self.basis.point_stride() {
            return;
        }
        let knots: Vec<DVec3> =
            self.curve.points.iter().copied().step_by(self.basis.point_stride()).collect();
        let length: f64 = knots.windows(2).map(|p| p[0].distance(p[1])).sum();
        let mean_segment = length / (knots.len() - 1) as f64;
        let gap = knots[0].distance(knots[knots.len() - 1]);
        if gap > OPEN_GAP_SEGMENTS * mean_segment {
            self.curve.closed = false;
            // A Bezier's closing piece takes its two handles along.
            self.truncate(n - self.basis.point_stride() + 1);
            self.repairs.push(RepairKind::LoopOpened { gap, mean_segment });
        }
    }

    fn truncate(&mut self, points: usize) {
        self.curve.points.truncate(points);
        self.keep.truncate(points);
    }

    fn is_too_short(&self) -> bool {
        let least = match (self.basis, self.curve.closed) {
            (Basis::Bezier, false) => 4,
            (_, false) => 2,
            (_, true) => 3,
        };
        self.curve.points.len() < least
    }
}

#[cfg(test)]
#[path = "repair_tests.rs"]
mod tests;
