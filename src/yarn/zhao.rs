//! Fibers of a straight yarn with *separate* fly-aways, as the generator of Zhao et al. 2016 makes them: hairs
//! are fibers of their own and loops are regular fibers scaled out, where [`super::period`] changes a fiber's
//! type from period to period (Wu & Yuksel 2019, Sec. 3.1). f64 only: the judge of that form, never drawn.
//!
//! Fly-aways are made in the *round* ply of radius b = sqrt(e_N e_B), in the frame that turns with the ply
//! but not with its fibers; R = r / b then takes them through the ellipse and the ply's turn.

use super::fiber::{PieceTurns, Turns, fiber_point, twist_at, yarn_point};
use super::params::{Spread, YarnParams};
use super::period::{FiberShape, Kind, migration_shape};
use super::table::{Fiber, fiber_table};
use crate::math::rng::Rng;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Share of the fits' standard deviations that the generator draws hairs with.
pub const HAIR_DEVIATION_SHARE: f64 = 0.75;
/// Share of the fits' standard deviation that the generator draws loops with.
pub const LOOP_DEVIATION_SHARE: f64 = 0.5;
/// A loop's peak lies beyond this many times the fiber's own distance there.
pub const LOOP_GAIN_MIN: f64 = 1.05;

/// A bound on drawing anew, for spreads whose tail hardly reaches what is wanted.
const MOST_DRAWS: u32 = 1000;
/// Most steps to the length of a yarn.
const MOST_STEPS: f64 = 1e6;

/// What a stream of random numbers is for; apart from the streams of [`fiber_table`].
const LOOP_STREAM: u64 = 1;
const HAIR_STREAM: u64 = 2;

/// A fiber, or the part of one that is of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct FiberCurve {
    /// The ply it belongs to, from 0.
    pub ply: u32,
    /// Regular fiber, loop or hair.
    pub kind: Kind,
    /// At least two points in mm, in order: along the yarn, for a hair from its root to its tip.
    pub points: Vec<DVec3>,
    /// Radius of the fiber in mm.
    pub radius_mm: f64,
}

/// The fibers of a straight yarn from the origin along +Z, with ply 0 toward +X at its start.
///
/// Regular fibers are those of [`fiber_table`] with the same seed, interrupted where they become a loop and
/// ordered as there; the parts share their end points. Each ply has round(density x length) loops and hairs.
/// A loop takes one maximum of one fiber's R; a ply of slow migration may have fewer of those than loops are
/// wanted, and untwisted fibers have none. The yarn is cut at both ends, its hairs too.
///
/// `step_mm` is the spacing of points along the yarn (for hairs in any of their coordinates), at least a
/// millionth of the length; ends of curves and the peaks of loops are points besides. A length or step that
/// is not positive and finite gives no fibers.
pub fn zhao_fibers(yarn: &YarnParams, length_mm: f64, step_mm: f64, seed: u64) -> Vec<FiberCurve> {
    let positive = |value: f64| value > 0.0 && value.is_finite();
    if !positive(length_mm) || !positive(step_mm) {
        return Vec::new();
    }
    let straight = StraightYarn::new(yarn, length_mm, step_mm.max(length_mm / MOST_STEPS));
    let fibers = fiber_table(yarn, seed);
    let mut loops = vec![Vec::new(); fibers.len()];
    for ply in 0..yarn.ply_count {
        straight.draw_loops(&fibers, ply, seed, &mut loops);
    }
    let mut curves = Vec::new();
    for (fiber, loops) in fibers.iter().zip(&mut loops) {
        straight.append_fiber(fiber, loops, &mut curves);
    }
    let hairs = straight.count(yarn.hair_density_per_mm);
    for ply in 0..yarn.ply_count {
        let hair = |i| straight.hair(ply, &mut Rng::new(seed, &[u64::from(ply), i, HAIR_STREAM]));
        curves.extend((0..hairs).filter_map(hair));
    }
    curves
}

/// A normal number with `share` of the spread's deviation.
fn draw(rng: &mut Rng, spread: Spread, share: f64) -> f64 {
    let radius = (-2.0 * (1.0 - rng.uniform()).ln()).sqrt();
    spread.mean + share * spread.deviation * radius * (TAU * rng.uniform()).cos()
}

/// The same, drawn anew until it is above `least`.
fn draw_above(rng: &mut Rng, spread: Spread, share: f64, least: f64) -> Option<f64> {
    (0..MOST_DRAWS).map(|_| draw(rng, spread, share)).find(|value| *value > least)
}

/// A loop of one fiber.
#[derive(Clone, Copy, Debug)]
struct Loop {
    /// Where along the yarn its peak lies.
    peak_mm: f64,
    /// Distance of the peak from the ply's centre as a multiple of the fiber's own there.
    ratio: f64,
}

/// The yarn as one straight piece.
struct StraightYarn<'a> {
    yarn: &'a YarnParams,
    length_mm: f64,
    step_mm: f64,
    turns: PieceTurns,
    /// Signed periods of R per mm.
    migrations_per_mm: f64,
}

impl<'a> StraightYarn<'a> {
    fn new(yarn: &'a YarnParams, length_mm: f64, step_mm: f64) -> Self {
        let turns = |per_mm: f64| Turns { start: 0.0, delta: per_mm * length_mm };
        let migrations_per_mm = yarn.migration_rate * yarn.fiber_turns_per_mm();
        let turns = PieceTurns {
            ply: turns(yarn.ply_turns_per_mm()),
            fiber: turns(yarn.fiber_turns_per_mm()),
            migration: turns(migrations_per_mm),
        };
        Self { yarn, length_mm, step_mm, turns, migrations_per_mm }
    }

    fn count(&self, density_per_mm: f64) -> u64 {
        (density_per_mm * self.length_mm).round() as u64
    }

    /// From a minimum of R to the maximum, in mm.
    fn half_period_mm(&self) -> f64 {
        0.5 / self.migrations_per_mm.abs()
    }

    /// A point of a regular fiber, `factor` times as far from its ply's centre as it would lie.
    fn regular_point(&self, fiber: &Fiber, z: f64, factor: f64) -> DVec3 {
        let twist = twist_at(&self.turns, z / self.length_mm);
        let shape = migration_shape(fiber, twist.migration, twist.migration_rate, self.yarn);
        self.point(fiber, z, true, FiberShape { radius: factor * shape.radius, ..shape })
    }

    /// A point at `z`, in the fiber's own frame or in that of its ply.
    fn point(&self, fiber: &Fiber, z: f64, turns_with_fibers: bool, shape: FiberShape) -> DVec3 {
        let t = z / self.length_mm;
        let end = self.length_mm * DVec3::Z;
        let yarn_at = yarn_point(&[DVec3::ZERO, end / 3.0, end * (2.0 / 3.0), end], [DVec3::X; 2], t);
        let mut twist = twist_at(&self.turns, t);
        if !turns_with_fibers {
            (twist.fiber, twist.fiber_rate) = (0.0, 0.0);
        }
        fiber_point(&yarn_at, &twist, self.yarn, fiber, &shape).position
    }

    /// Places along the yarn where a fiber's R is largest.
    fn maxima(&self, fiber: &Fiber) -> impl Iterator<Item = f64> {
        let (rate, phase) = (self.migrations_per_mm, fiber.migration_phase / TAU);
        let end = phase + rate * self.length_mm;
        let (first, last) = (phase.min(end).ceil(), phase.max(end).floor());
        let count = if rate == 0.0 { 0 } else { (last - first + 1.0).max(0.0) as u64 };
        (0..count).map(move |k| (first + k as f64 - phase) / rate)
    }

    /// Picks maxima of the ply's fibers, none twice, and draws how far out each goes.
    fn draw_loops(&self, fibers: &[Fiber], ply: u32, seed: u64, loops: &mut [Vec<Loop>]) {
        let yarn = self.yarn;
        let of_ply = fibers.iter().enumerate().filter(|(_, fiber)| fiber.ply == ply);
        let mut free: Vec<(usize, f64)> =
            of_ply.flat_map(|(i, fiber)| self.maxima(fiber).map(move |peak_mm| (i, peak_mm))).collect();
        for index in 0..self.count(yarn.loop_density_per_mm).min(free.len() as u64) {
            let mut rng = Rng::new(seed, &[u64::from(ply), index, LOOP_STREAM]);
            let (fiber, peak_mm) = free.swap_remove((rng.uniform() * free.len() as f64) as usize);
            let own_mm = fibers[fiber].radius * yarn.migration_max * yarn.round_ply_radius_mm();
            let least_mm = LOOP_GAIN_MIN * own_mm;
            let peak = draw_above(&mut rng, yarn.loop_radius_mm, LOOP_DEVIATION_SHARE, least_mm);
            // A fiber at the very centre has no direction to go.
            let ratio = if own_mm > 0.0 { peak.unwrap_or(least_mm) / own_mm } else { 1.0 };
            loops[fiber].push(Loop { peak_mm, ratio });
        }
    }

    /// A regular fiber cut into its loops and what lies between them.
    fn append_fiber(&self, fiber: &Fiber, loops: &mut [Loop], curves: &mut Vec<FiberCurve>) {
        loops.sort_by(|a, b| a.peak_mm.total_cmp(&b.peak_mm));
        let mut push = |kind: Kind, places: &[f64], factor: &dyn Fn(f64) -> f64| {
            let places = self.places(places);
            if places.len() >= 2 {
                let points = places.iter().map(|&z| self.regular_point(fiber, z, factor(z))).collect();
                curves.push(self.curve(fiber.ply, kind, points));
            }
        };
        let half_mm = self.half_period_mm();
        let mut done_mm = 0.0;
        for &Loop { peak_mm, ratio } in loops.iter() {
            let begin = (peak_mm - half_mm).max(done_mm);
            let end = (peak_mm + half_mm).min(self.length_mm);
            push(Kind::Migration, &[done_mm, begin], &|_| 1.0);
            push(Kind::Loop, &[begin, peak_mm, end], &|z| {
                let rise = (1.0 - (z - peak_mm).abs() / half_mm).clamp(0.0, 1.0);
                1.0 + (ratio - 1.0) * (FRAC_PI_2 * rise).sin()
            });
            done_mm = end;
        }
        push(Kind::Migration, &[done_mm, self.length_mm], &|_| 1.0);
    }

    /// The given places, in order, and the steps of the yarn between them; none twice.
    fn places(&self, given: &[f64]) -> Vec<f64> {
        let close = 1e-6 * self.step_mm;
        let mut all = Vec::new();
        for pair in given.windows(2).filter(|pair| pair[1] - pair[0] > close) {
            all.push(pair[0]);
            let first = (pair[0] / self.step_mm).floor() as u64 + 1;
            let steps = (first..).map(|k| k as f64 * self.step_mm);
            all.extend(steps.skip_while(|z| z - pair[0] <= close).take_while(|z| pair[1] - z > close));
        }
        if !all.is_empty() {
            all.extend(given.last());
        }
        all
    }

    /// A straight line in (r, z, angle), from the ply's centre to its tip.
    fn hair(&self, ply: u32, rng: &mut Rng) -> Option<FiberCurve> {
        let [root, tip] = self.hair_line(rng)?;
        let span = (tip - root).abs() * DVec3::new(1.0, 1.0, root.x.max(tip.x));
        let steps = (span.max_element() / self.step_mm).ceil().clamp(1.0, MOST_STEPS) as u32;
        let at = |i: u32| {
            let [r_mm, z, angle] = root.lerp(tip, f64::from(i) / f64::from(steps)).to_array();
            let radius = r_mm / self.yarn.round_ply_radius_mm();
            let shape = FiberShape { radius, radius_rate: 0.0, angle, angle_rate: 0.0, width: 1.0 };
            let origin = Fiber { radius: 0.0, angle: 0.0, migration_phase: 0.0, ply };
            self.point(&origin, z, false, shape)
        };
        Some(self.curve(ply, Kind::Hair, (0..=steps).map(at).collect()))
    }

    /// Root and tip of a hair in (r, z, angle); `None` where its lengths are never positive.
    fn hair_line(&self, rng: &mut Rng) -> Option<[DVec3; 2]> {
        let yarn = self.yarn;
        let mut length = |spread| draw_above(rng, spread, HAIR_DEVIATION_SHARE, 0.0);
        let r0 = length(yarn.hair_radius_start_mm)?;
        let re = length(yarn.hair_radius_gain_mm)?;
        let ze = length(yarn.hair_length_mm)?;
        let ze = if rng.uniform() < 0.5 { -ze } else { ze };
        let pe = match yarn.hair_pitch_mm {
            Some(pitch_mm) => TAU * (ze / pitch_mm) * if yarn.fiber_clockwise { -1.0 } else { 1.0 },
            None => draw(rng, yarn.hair_angle_rad, HAIR_DEVIATION_SHARE),
        };
        let start = DVec3::new(r0, self.length_mm * rng.uniform(), TAU * rng.uniform());
        let gain = DVec3::new(re, ze, pe);
        // The yarn's ends, as places on the line; its start is between them.
        let ends = [0.0, self.length_mm].map(|z| (z - start.y) / ze);
        let root = (-r0 / re).max(ends[0].min(ends[1]));
        let tip = ends[0].max(ends[1]).min(1.0);
        Some([start + root * gain, start + tip * gain]).filter(|_| root.is_finite() && tip > root)
    }

    fn curve(&self, ply: u32, kind: Kind, points: Vec<DVec3>) -> FiberCurve {
        FiberCurve { ply, kind, points, radius_mm: self.yarn.fiber_radius_mm() }
    }
}

#[cfg(test)]
#[path = "zhao_tests.rs"]
mod tests;
