//! One fiber along one curve: cut where it breaks or changes, then as finely as its bends ask for.

use super::fibers::RealisedFiber;
use crate::math::frame::direction_or;
use crate::yarn::fetch::FiberField;
use crate::yarn::fiber::FiberPoint;
use crate::yarn::period::{
    CurvePeriods, Kind, Period, draw_period, hair_cut, period_rate, period_shape, period_turns,
};
use crate::yarn::strand::Piece;
use glam::DVec3;
use std::f64::consts::TAU;

/// What one sweep needs.
pub(super) struct Sweep<'a> {
    /// The fabric.
    pub field: &'a FiberField,
    /// All pieces of one curve.
    pub pieces: &'a [Piece],
    /// Index of the fiber in the cross-section.
    pub fiber: usize,
    /// Most that a chord may depart from the axis.
    pub tolerance_mm: f64,
    /// Points after which the sweep gives up.
    pub max_points: u64,
}

/// Steps of a stretch before any is judged by its middle, per turn of everything that turns: an eighth of a turn
/// bends one way only.
const STEPS_PER_TURN: f64 = 8.0;
/// Least steps of a stretch: a cubic may bend two ways.
const LEAST_STEPS: u32 = 2;
/// Halvings of a step after which it is taken as it is.
const DEEPEST: u32 = 16;
/// Points nearer than this share of the tolerance are one.
const SAME_POINT: f64 = 1e-6;
/// Ends of a closed curve's fiber meet within this share of the ply's ellipse (tests of `yarn::fetch`).
const CLOSING_GAP: f64 = 2e-3;

/// A part of a piece over which the fiber is smooth: all in one period and on one side of its hair's tip.
struct Stretch {
    /// Where it begins and ends in the piece.
    t: [f64; 2],
    /// The same as places in the period.
    x: [f64; 2],
    /// The period; beyond its hair's tip, as the fiber that only migrates that it is there.
    period: Period,
    /// Whether it lies beyond the tip of its period's hair.
    beyond_tip: bool,
}

impl Stretch {
    /// Whether the tip of a hair lies between this one and the next, when both are parts of one period.
    fn is_broken_from(&self, next: &Self) -> bool {
        self.beyond_tip != next.beyond_tip
    }
}

#[derive(Clone, Copy)]
struct Point {
    position: DVec3,
    tangent: DVec3,
    radius_mm: f64,
}

/// Every run of the fiber, in order along the curve; `None` beyond the allowed number of points.
pub(super) fn sweep_curve(sweep: &Sweep<'_>) -> Option<Vec<RealisedFiber>> {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    let mut last: Option<Stretch> = None;
    let (mut first, mut made) = (None, 0);
    for piece in sweep.pieces {
        for stretch in stretches(sweep, piece)? {
            let broken = last.as_ref().is_none_or(|last| {
                last.period.index == stretch.period.index && last.is_broken_from(&stretch)
            });
            if broken {
                runs.push(Vec::new());
            }
            let before = runs.last().map_or(0, Vec::len);
            let run = runs.last_mut()?;
            append_stretch(sweep, piece, &stretch, run, sweep.max_points.saturating_sub(made))?;
            made += (run.len() - before) as u64;
            first.get_or_insert((stretch.period.index, stretch.beyond_tip));
            last = Some(stretch);
        }
    }
    let closed = match (first, last) {
        (Some(first), Some(last)) => joins_itself(sweep, &runs, first, &last),
        _ => false,
    };
    Some(realised(sweep, close(runs, closed)))
}

/// The parts of a piece, in order along the yarn; `None` where there are more than points allowed.
fn stretches(sweep: &Sweep<'_>, piece: &Piece) -> Option<Vec<Stretch>> {
    let field = sweep.field;
    let (fiber, flyaways) = (&field.fibers[sweep.fiber], &field.flyaways);
    let count = field.strands.period_counts.get(piece.curve).copied().unwrap_or(0);
    let periods = CurvePeriods { curve: piece.curve as u32, count, seed: field.seed };
    let turns_at = |t: f64| period_turns(&piece.turns, fiber, t, flyaways);
    let (start, end) = (turns_at(0.0), turns_at(1.0));
    let (low, high) = (start.min(end), start.max(end));
    // What is no number is refused too.
    if !(0.0..=sweep.max_points as f64).contains(&(high - low)) {
        return None;
    }
    let mut parts = Vec::new();
    for index in low.floor() as i32..=high.floor() as i32 {
        let period = draw_period(&periods, fiber, sweep.fiber as u32, index, flyaways);
        let base = f64::from(index);
        let inside = [(low - base).clamp(0.0, 1.0), (high - base).clamp(0.0, 1.0)];
        for (x, beyond_tip) in sides(&period, inside) {
            // A yarn whose fibers do not turn stays at one place of its period.
            if x[1] > x[0] || low == high {
                let kind = if beyond_tip { Kind::Migration } else { period.kind };
                let t =
                    x.map(|x| if low == high { x - inside[0] } else { (x + base - start) / (end - start) });
                parts.push(Stretch { t, x, period: Period { kind, ..period }, beyond_tip });
            }
        }
    }
    if end < start {
        parts.reverse();
        for part in &mut parts {
            part.t.reverse();
            part.x.reverse();
        }
    }
    if let (Some(part), true) = (parts.first_mut(), low == high) {
        part.t = [0.0, 1.0];
        parts.truncate(1);
    }
    Some(parts)
}

/// The part of a period from x = `low` to `high`, cut at the tip of its hair; true is beyond the tip.
fn sides(period: &Period, [low, high]: [f64; 2]) -> Vec<([f64; 2], bool)> {
    if period.kind != Kind::Hair {
        return vec![([low, high], false)];
    }
    let cut = hair_cut(period);
    let (below, above) = ([low, high.min(cut)], [low.max(cut), high]);
    [(below, !period.root_first), (above, period.root_first)]
        .into_iter()
        .filter(|(x, _)| x[0] <= x[1])
        .collect()
}

/// Appends the points of a stretch, the first one only where the run has none to go on from.
fn append_stretch(
    sweep: &Sweep<'_>,
    piece: &Piece,
    stretch: &Stretch,
    run: &mut Vec<Point>,
    most: u64,
) -> Option<()> {
    let turns = &piece.turns;
    let share = (stretch.t[1] - stretch.t[0]).abs();
    let hair = if stretch.period.kind == Kind::Hair { stretch.period.twist / TAU } else { 0.0 };
    let turned = share * (turns.ply.delta.abs() + turns.fiber.delta.abs() + turns.migration.delta.abs());
    let in_period = (stretch.x[1] - stretch.x[0]).abs();
    let steps = (STEPS_PER_TURN * (turned + hair.abs() + in_period)).ceil().max(f64::from(LEAST_STEPS));
    if steps > most as f64 {
        return None;
    }
    let at = |share: f64| point_at(sweep, piece, stretch, share);
    let mut from = at(0.0);
    match run.last_mut() {
        // Where a hair or a loop begins the fiber has a kink: its two directions meet halfway.
        Some(last) => last.tangent = direction_or(last.tangent + from.tangent, from.tangent),
        None => run.push(from),
    }
    let before = run.len() as u64;
    let steps = steps as u64;
    for step in 0..steps {
        let shares = [step, step + 1].map(|k| k as f64 / steps as f64);
        let to = at(shares[1]);
        refine(&at, (shares, [from, to]), sweep.tolerance_mm, DEEPEST, run);
        push_apart(run, to, sweep.tolerance_mm);
        from = to;
        if run.len() as u64 - before > most {
            return None;
        }
    }
    Some(())
}

/// Appends the points strictly inside a step that its bend asks for.
fn refine(
    at: &impl Fn(f64) -> Point,
    ([a, b], [from, to]): ([f64; 2], [Point; 2]),
    tolerance_mm: f64,
    depth: u32,
    run: &mut Vec<Point>,
) {
    let middle_share = 0.5 * (a + b);
    let middle = at(middle_share);
    let chord = direction_or(to.position - from.position, from.tangent);
    let off = (middle.position - from.position).reject_from_normalized(chord).length();
    let thicker = (middle.radius_mm - 0.5 * (from.radius_mm + to.radius_mm)).abs();
    if depth == 0 || off.max(thicker) <= tolerance_mm {
        return;
    }
    refine(at, ([a, middle_share], [from, middle]), tolerance_mm, depth - 1, run);
    push_apart(run, middle, tolerance_mm);
    refine(at, ([middle_share, b], [middle, to]), tolerance_mm, depth - 1, run);
}

fn push_apart(run: &mut Vec<Point>, point: Point, tolerance_mm: f64) {
    let apart = |last: &Point| last.position.distance(point.position) > SAME_POINT * tolerance_mm;
    if run.last().is_none_or(apart) {
        run.push(point);
    }
}

/// The fiber at a share of the way along a stretch.
fn point_at(sweep: &Sweep<'_>, piece: &Piece, stretch: &Stretch, share: f64) -> Point {
    let field = sweep.field;
    let fiber = &field.fibers[sweep.fiber];
    // Exact at both ends, so that rounding cannot cross a tip.
    let between = |[a, b]: [f64; 2]| if share < 1.0 { a + (b - a) * share } else { b };
    let rate = period_rate(&piece.turns, &field.flyaways);
    let yarn = (&field.yarn, &field.flyaways);
    let shape = period_shape(fiber, &stretch.period, between(stretch.x), rate, yarn);
    let FiberPoint { position, tangent, width, .. } =
        field.fiber_point(piece, fiber, between(stretch.t), &shape);
    Point { position, tangent, radius_mm: width * field.yarn.fiber_radius_mm() }
}

/// Whether the fiber's end meets its start with no tip of a hair between them.
fn joins_itself(
    sweep: &Sweep<'_>,
    runs: &[Vec<Point>],
    (first_index, first_beyond): (i32, bool),
    last: &Stretch,
) -> bool {
    let ends = (runs.first().and_then(|run| run.first()), runs.last().and_then(|run| run.last()));
    let (Some(start), Some(end)) = ends else { return false };
    let curve = sweep.pieces.first().map_or(0, |piece| piece.curve);
    let count = sweep.field.strands.period_counts.get(curve).copied().unwrap_or(0);
    let parts = i64::from(count) * i64::from(sweep.field.flyaways.periods_per_migration);
    let same_period = (i64::from(last.period.index) - i64::from(first_index)).abs() == parts;
    let tip_between = same_period && last.beyond_tip != first_beyond;
    let near = start.position.distance(end.position) < CLOSING_GAP * sweep.field.yarn.ellipse_long_mm;
    near && start.tangent.dot(end.tangent) > 0.5 && !tip_between && runs[0].len() > 3
}

/// Joins the last run to the first where the fiber meets itself; true stands for a run that closes on itself.
fn close(mut runs: Vec<Vec<Point>>, joined: bool) -> Vec<(Vec<Point>, bool)> {
    if joined && let Some(mut last) = runs.pop() {
        let end = last.pop();
        let is_whole = runs.is_empty();
        let first = if is_whole { &mut last } else { &mut runs[0] };
        if let (Some(start), Some(end)) = (first.first_mut(), end) {
            start.tangent = direction_or(start.tangent + end.tangent, start.tangent);
        }
        if is_whole {
            return vec![(last, true)];
        }
        last.append(&mut runs[0]);
        runs[0] = last;
    }
    runs.into_iter().map(|run| (run, false)).collect()
}

fn realised(sweep: &Sweep<'_>, runs: Vec<(Vec<Point>, bool)>) -> Vec<RealisedFiber> {
    let curve = sweep.pieces.first().map_or(0, |piece| piece.curve);
    let ply = sweep.field.fibers[sweep.fiber].ply;
    runs.into_iter()
        .filter(|(run, _)| run.len() >= 2)
        .map(|(run, closed)| RealisedFiber {
            fabric: 0,
            curve,
            ply,
            fiber: sweep.fiber as u32,
            closed,
            points: run.iter().map(|p| p.position).collect(),
            tangents: run.iter().map(|p| p.tangent).collect(),
            radii_mm: run.iter().map(|p| p.radius_mm).collect(),
        })
        .collect()
}
