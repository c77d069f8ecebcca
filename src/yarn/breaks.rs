//! Where hairs break a fiber, and how its drawn vertices keep to the break; twin of
//! `glsl/yarn/breaks.glsl`.

use super::fiber::PieceTurns;
use super::flyaway::Flyaways;
use super::period::{CurvePeriods, Kind, Period, draw_period, hair_cut, period_rate, period_turns};
use super::table::Fiber;

/// One vertex of a drawn fiber. It is joined to the next one along the yarn where that one's `entry` is
/// at most one above its `exit`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrandVertex {
    /// Moved onto a hair's tip where that lies between this vertex and its neighbour.
    pub t: f64,
    /// The period it belongs to.
    pub period: Period,
    /// Place in the period.
    pub x: f64,
    /// The number by which it is reached.
    pub entry: i32,
    /// The number by which it is left.
    pub exit: i32,
}

/// 0 up to the tip of the period's hair, 1 beyond.
pub fn cut_side(period: &Period, x: f64) -> i32 {
    i32::from(x > hair_cut(period))
}

/// A vertex on one side of its period: four numbers a period, the last of one next to the first of the
/// following; the two sides of a break are three apart. Where periods count down along the yarn
/// (`rate` < 0) the numbers are mirrored.
fn mark(t: f64, period: Period, x: f64, side: i32, rate: f64) -> StrandVertex {
    let is_hair = period.kind == Kind::Hair;
    let first = period.index.wrapping_mul(4);
    let low = first + if is_hair && side == 1 { 3 } else { 0 };
    let high = first + if is_hair && side == 0 { 0 } else { 3 };
    let (entry, exit) = if rate < 0.0 { (-high, -low) } else { (low, high) };
    StrandVertex { t, period, x, entry, exit }
}

/// Whether a hair's tip lies between a vertex that is left by `exit` and the next, reached by `entry`.
pub fn is_broken(exit: i32, entry: i32) -> bool {
    entry - exit > 1
}

/// If the fiber, walking from `u` to `neighbour` (in period turns), meets the tip of a hair of the period
/// coming from outside the hair, gives the tip's place.
pub fn meets_tip(period: &Period, u: f64, neighbour: f64) -> Option<f64> {
    let tip = f64::from(period.index) + hair_cut(period);
    // The hair lies below its tip where its root comes first. A vertex on the tip is on the hair.
    let meets = if period.root_first { u > tip && neighbour < tip } else { u < tip && neighbour > tip };
    (period.kind == Kind::Hair && meets).then_some(tip)
}

/// Where the neighbours of the vertex at t of `pieces` equal steps lie.
pub fn neighbours(t: f64, pieces: u32) -> [f64; 2] {
    [-1.0, 1.0].map(|side| t + side / f64::from(pieces))
}

/// The vertex at t between two at `neighbours`, which outside of 0 to 1 are none. Where a hair's tip lies between it and
/// one of them, on whose side the hair is, the vertex moves onto the tip: hairs have their true length however coarsely
/// drawn.
pub fn strand_vertex(
    turns: &PieceTurns,
    fiber: &Fiber,
    fiber_index: u32,
    t: f64,
    neighbours: [f64; 2],
    periods: &CurvePeriods,
    flyaways: &Flyaways,
) -> StrandVertex {
    let draw = |u: f64| draw_period(periods, fiber, fiber_index, u.floor() as i32, flyaways);
    let (u, rate) = (period_turns(turns, fiber, t, flyaways), period_rate(turns, flyaways));
    for t_neighbour in neighbours {
        if !(-1e-4..=1.0001).contains(&t_neighbour) {
            continue;
        }
        let neighbour = period_turns(turns, fiber, t_neighbour, flyaways);
        for period in [draw(u), draw(neighbour)] {
            if let Some(tip) = meets_tip(&period, u, neighbour) {
                let t_tip = t + (tip - u) / rate;
                return mark(t_tip, period, hair_cut(&period), i32::from(!period.root_first), rate);
            }
        }
    }
    let period = draw(u);
    let x = u - u.floor();
    mark(t, period, x, cut_side(&period, x), rate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::fiber::Turns;
    use crate::yarn::level::period_pieces;
    use crate::yarn::presets;

    const PERIODS: CurvePeriods = CurvePeriods { curve: 3, count: 0, seed: 9 };

    fn hairy() -> Flyaways {
        let mut yarn = presets::yarn("cotton1").unwrap();
        yarn.hair_density_per_mm *= 4.0;
        Flyaways::new(&yarn)
    }

    fn turns(start: f64, delta: f64) -> PieceTurns {
        PieceTurns { migration: Turns { start, delta }, ..Default::default() }
    }

    /// All vertices of a fiber over two neighbouring pieces.
    fn vertices(delta: f64, pieces: u32, fiber_index: u32) -> Vec<StrandVertex> {
        let fiber = Fiber { radius: 0.7, angle: 1.0, migration_phase: 2.0, ply: 0 };
        let flyaways = hairy();
        let rate = period_rate(&turns(0.0, delta), &flyaways);
        let pieces = period_pieces(pieces, rate, 1000);
        let piece = |start: f64| {
            let turns = turns(start, delta);
            (0..=pieces)
                .map(|i| {
                    let t = f64::from(i) / f64::from(pieces);
                    strand_vertex(&turns, &fiber, fiber_index, t, neighbours(t, pieces), &PERIODS, &flyaways)
                })
                .collect::<Vec<_>>()
        };
        let mut all = piece(5.2);
        all.extend(piece(5.2 + delta));
        all
    }

    #[test]
    fn drawn_hairs_end_exactly_at_their_tips_and_only_breaks_are_left_out() {
        let (mut tips, mut joined) = (0, 0);
        for delta in [0.7, -0.7, 2.1, -2.1] {
            for pieces in [9, 16, 31] {
                for fiber_index in 0..40 {
                    for pair in vertices(delta, pieces, fiber_index).windows(2) {
                        let (a, b) = (&pair[0], &pair[1]);
                        if !is_broken(a.exit, b.entry) {
                            joined += 1;
                            continue;
                        }
                        // A break must be at a hair's tip: one of the two vertices lies on it.
                        let on_tip =
                            |v: &StrandVertex| v.period.kind == Kind::Hair && v.x == hair_cut(&v.period);
                        tips += 1;
                        assert!(on_tip(a) || on_tip(b), "{a:?} {b:?}");
                    }
                }
            }
        }
        assert!(tips > 100 && joined > 10 * tips, "{tips} tips, {joined} joined");
    }

    #[test]
    fn every_hair_between_the_ends_is_broken_once() {
        let fiber = Fiber { radius: 0.7, angle: 1.0, migration_phase: 2.0, ply: 0 };
        let flyaways = hairy();
        for (delta, fiber_index) in [(3.0, 1), (-3.0, 2), (3.0, 5)] {
            let all = vertices(delta, 32, fiber_index);
            let drawn = all.windows(2).filter(|w| is_broken(w[0].exit, w[1].entry)).count();
            let u = |t: f64| period_turns(&turns(5.2, delta), &fiber, t, &flyaways);
            let (low, high) = (u(0.0).min(u(2.0)), u(0.0).max(u(2.0)));
            let expected = (low.floor() as i32..=high.floor() as i32)
                .map(|k| draw_period(&PERIODS, &fiber, fiber_index, k, &flyaways))
                .filter(|p| p.kind == Kind::Hair)
                .filter(|p| (low..high).contains(&(f64::from(p.index) + hair_cut(p))))
                .count();
            assert_eq!(drawn, expected, "delta {delta} fiber {fiber_index}");
        }
    }

    #[test]
    fn breaks_are_told_from_joins() {
        assert!(!is_broken(7, 8) && !is_broken(7, 4) && is_broken(4, 7) && is_broken(-7, -4));
    }
}
