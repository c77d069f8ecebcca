//! Whether a swatch really is knitted: the crossings seen from the technical face, strand by strand.
//!
//! A diagram of crossings with what lies over what fixes the topology, so a swatch whose diagram is that
//! of stockinette is stockinette.

use std::collections::BTreeMap;

use glam::DVec2;
use thiserror::Error;

use crate::io::curves::CurveSet;

use super::clearance::between;
use super::fine::{Chain, OnYarn, chains, near_pairs};
use super::layout::{Layout, LoopPlace};

/// Chords per cubic piece.
pub(crate) const CHORDS: usize = 8;

/// Two strands that cross when looked at along -Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The strand nearer to the viewer (greater z).
    pub over: OnYarn,
    /// The strand behind it.
    pub under: OnYarn,
}

/// A loop that does not hang in the loop below as a knit stitch does.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("course {course}, wale {wale}: expected {expected}, found {found}")]
pub struct InterlockFault {
    /// The course, counted from 0 at the bottom.
    pub course: u32,
    /// The wale, counted from 0 at the left.
    pub wale: u32,
    /// What a knit stitch has there.
    pub expected: &'static str,
    /// What was found.
    pub found: String,
}

/// Every crossing of the curves' projection onto the XY plane.
pub fn crossings_along_z(curves: &CurveSet) -> Vec<Crossing> {
    crossings(&chains(curves, CHORDS).iter().flat_map(chords).collect::<Vec<_>>())
}

/// The chords of one piece.
pub(crate) fn chords(chain: &Chain) -> impl Iterator<Item = [OnYarn; 2]> + '_ {
    chain.points.windows(2).map(|p| [p[0], p[1]])
}

/// Whether one chord goes on where the other ends.
fn joined(end: &OnYarn, start: &OnYarn) -> bool {
    let same_place = end.curve == start.curve && end.parameter == start.parameter;
    same_place || end.position == start.position
}

/// Every crossing of the chords' projection onto the XY plane.
pub(crate) fn crossings(chords: &[[OnYarn; 2]]) -> Vec<Crossing> {
    let flat = |p: &OnYarn| p.position.truncate();
    let middles: Vec<_> = chords.iter().map(|[a, b]| (0.5 * (flat(a) + flat(b))).extend(0.0)).collect();
    let longest = chords.iter().fold(1e-9, |m: f64, [a, b]| m.max(flat(a).distance(flat(b))));
    let mut found = Vec::new();
    near_pairs(&middles, longest, |i, j| {
        let (p, q) = (&chords[i], &chords[j]);
        if i == j || joined(&p[1], &q[0]) || joined(&q[1], &p[0]) {
            return;
        }
        let crossed = segments_cross([flat(&p[0]), flat(&p[1])], [flat(&q[0]), flat(&q[1])]);
        if let Some((s, t)) = crossed {
            let (a, b) = (between(&p[0], &p[1], s), between(&q[0], &q[1], t));
            let (over, under) = if a.position.z >= b.position.z { (a, b) } else { (b, a) };
            found.push(Crossing { over, under });
        }
    });
    found
}

/// Fractions at which two plane segments cross; half-open, so that a crossing at a joint counts once.
fn segments_cross(p: [DVec2; 2], q: [DVec2; 2]) -> Option<(f64, f64)> {
    let (u, v, w) = (p[1] - p[0], q[1] - q[0], q[0] - p[0]);
    let area = u.perp_dot(v);
    let (s, t) = (w.perp_dot(v) / area, w.perp_dot(u) / area);
    // A NaN of parallel segments fails both.
    ((0.0..1.0).contains(&s) && (0.0..1.0).contains(&t)).then_some((s, t))
}

/// One crossing of a loop with the loop below, from the upper one's view.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    upper_is_over: bool,
    /// Distance along the upper yarn from its head's centre, and along the lower yarn from its own.
    from_heads: [f64; 2],
}

/// Checks that every loop is a knit stitch in the loop below it and that nothing else crosses: on each
/// side the upper loop's sinker passes behind the lower loop's leg, then its leg comes through to the
/// front and passes over the lower loop's head.
pub fn check_interlock(curves: &CurveSet, layout: &Layout) -> Result<(), InterlockFault> {
    let place = |at: &OnYarn| layout.place(at.parameter);
    check_stitches(&crossings_along_z(curves), [layout.courses, layout.wales], place)
}

/// The same for crossings at hand, of so many courses and wales; `place` says which loop a place on the
/// yarn belongs to.
pub(crate) fn check_stitches(
    crossings: &[Crossing],
    [courses, wales]: [u32; 2],
    place: impl Fn(&OnYarn) -> Option<LoopPlace>,
) -> Result<(), InterlockFault> {
    let place = |at: &OnYarn| place(at).ok_or_else(|| crossing_outside(at));
    let mut sides: BTreeMap<(u32, u32, bool), Vec<Meeting>> = BTreeMap::new();
    for crossing in crossings {
        let (over, under) = (place(&crossing.over)?, place(&crossing.under)?);
        let (upper, lower) = if over.course > under.course { (over, under) } else { (under, over) };
        let gap = crossing.over.position.z - crossing.under.position.z;
        let proper = upper.course == lower.course + 1
            && upper.wale == lower.wale
            && upper.from_head * lower.from_head > 0.0
            && gap > 0.0;
        if !proper {
            let found = format!(
                "course {} wale {} against course {} wale {}, {gap:.4} apart",
                upper.course, upper.wale, lower.course, lower.wale
            );
            let expected = "crossings with the loop above and below only, one over the other";
            return Err(InterlockFault { course: upper.course, wale: upper.wale, expected, found });
        }
        let from_heads = [upper.from_head.abs(), lower.from_head.abs()];
        let upper_is_over = over.course > under.course;
        let side = (upper.course, upper.wale, upper.from_head > 0.0);
        sides.entry(side).or_default().push(Meeting { upper_is_over, from_heads });
    }
    for course in 1..courses {
        for (wale, right) in (0..wales).flat_map(|w| [(w, false), (w, true)]) {
            check_side(course, wale, sides.get(&(course, wale, right)).map_or(&[], |m| m))?;
        }
    }
    Ok(())
}

/// The two crossings of one side of a stitch.
fn check_side(course: u32, wale: u32, meetings: &[Meeting]) -> Result<(), InterlockFault> {
    let expected = "on each side a sinker behind the lower leg, then a leg over the lower head";
    let sinker = meetings.iter().find(|m| !m.upper_is_over);
    let leg = meetings.iter().find(|m| m.upper_is_over);
    let knit = match (meetings.len(), sinker, leg) {
        (2, Some(sinker), Some(leg)) => {
            sinker.from_heads[0] > leg.from_heads[0] && sinker.from_heads[1] > leg.from_heads[1]
        }
        _ => false,
    };
    if knit {
        return Ok(());
    }
    let found = format!("{} crossings, upper over: {:?}", meetings.len(), {
        meetings.iter().map(|m| m.upper_is_over).collect::<Vec<_>>()
    });
    Err(InterlockFault { course, wale, expected, found })
}

/// The fault where something that is part of no loop crosses a strand.
fn crossing_outside(at: &OnYarn) -> InterlockFault {
    InterlockFault {
        course: 0,
        wale: 0,
        expected: "no crossing at turns and ends",
        found: format!("a crossing at control point {:.2}", at.parameter),
    }
}
