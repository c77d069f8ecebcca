//! What a fiber is in each period of its radius: migration, loop, or in part a hair; twin of
//! `glsl/yarn/period.glsl`.

use super::fiber::PieceTurns;
use super::flyaway::Flyaways;
use super::migration::migration_radius;
use super::params::{Spread, YarnParams};
use super::table::Fiber;
use crate::math::hash::{hash_words, normal_from_words, uniform_from_word};
use std::f64::consts::{PI, TAU};

/// Fiber types of Wu & Yuksel 2019, Sec. 3.1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Moves between R_min and R_max.
    Migration = 0,
    /// Goes out to a radius of its own and back.
    Loop = 1,
    /// Has an open end outside the ply.
    Hair = 2,
}

/// A hair takes at least a visible part of its period, and leaves some of it to the fiber it broke from.
const HAIR_SHARE_MIN: f64 = 0.02;
const HAIR_SHARE_MAX: f64 = 0.9;
/// Most by which a hair's line is lengthened inward: a tip that barely leaves the ply has no slope.
const HAIR_INWARD_MAX: f64 = 4.0;

/// What the periods of one curve have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurvePeriods {
    /// The curve's index.
    pub curve: u32,
    /// Whole migrations of a closed curve; 0 on an open one.
    pub count: u32,
    /// The scene's seed.
    pub seed: u32,
}

/// One period of one fiber. Loops and hairs are drawn for each period: from a minimum of R to the next, or
/// an equal part of that where a slow migration would hold more than one
/// ([`Flyaways::periods_per_migration`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    /// Index along the curve.
    pub index: i32,
    /// What the fiber is in it.
    pub kind: Kind,
    /// Largest R of a loop, R at the tip of a hair.
    pub reach: f64,
    /// Share of the period that the hair takes, in (0, 1).
    pub share: f64,
    /// Of the hair beyond its root's angle, in radians over its length.
    pub twist: f64,
    /// Whether the hair's root lies where the period starts.
    pub root_first: bool,
}

/// The strand as it lies at one point: R, the angle beyond the fiber's own, and their derivatives by t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiberShape {
    /// R.
    pub radius: f64,
    /// dR / dt.
    pub radius_rate: f64,
    /// Radians beyond the fiber's own twist.
    pub angle: f64,
    /// Its derivative by t.
    pub angle_rate: f64,
    /// Share of the fiber's full width: hairs taper to a point.
    pub width: f64,
}

/// Periods before the point at t of a piece, counted from a minimum of R.
pub fn period_turns(turns: &PieceTurns, fiber: &Fiber, t: f64, flyaways: &Flyaways) -> f64 {
    let migrations = turns.migration.start + t * turns.migration.delta + fiber.migration_phase / TAU - 0.5;
    migrations * f64::from(flyaways.periods_per_migration)
}

/// Periods per unit of t; negative where they count down along the yarn.
pub fn period_rate(turns: &PieceTurns, flyaways: &Flyaways) -> f64 {
    turns.migration.delta * f64::from(flyaways.periods_per_migration)
}

/// Random identity of a period: the same for both sides of a closed curve's closing point.
pub fn period_identity(periods: &CurvePeriods, index: i32, flyaways: &Flyaways) -> i32 {
    let count = periods.count.saturating_mul(flyaways.periods_per_migration);
    i32::try_from(count).ok().and_then(|count| index.checked_rem_euclid(count)).unwrap_or(index)
}

/// A normal number, drawn again where it is not positive.
pub fn draw_positive(words: [u32; 3], spread: Spread) -> f64 {
    let draw = |attempt: u32| {
        let w = hash_words([words[0], words[1], words[2], attempt]);
        spread.mean + spread.deviation * normal_from_words(w[0], w[1])
    };
    (1..=8).map(draw).find(|value| *value > 0.0).unwrap_or(0.0)
}

/// Draws the hair of a period of a fiber with R_i = `fiber_radius` from three random words. The
/// statistics state a hair from where it leaves the ply; its line goes on inward at the same slopes to
/// its root at the fiber's R_min, so that it is longer and turns farther by the same ratio.
pub fn draw_hair(period: &mut Period, words: [u32; 3], fiber_radius: f64, flyaways: &Flyaways) {
    let a = hash_words([words[0], words[1], words[2], 0]);
    let b = hash_words([words[0], words[1], words[2], 9]);
    let start = flyaways.hair_start.mean + flyaways.hair_start.deviation * normal_from_words(a[0], a[1]);
    let gain = draw_positive([a[1], a[2], a[3]], flyaways.hair_gain);
    period.reach = start + gain;
    let root = fiber_radius * flyaways.migration_min;
    let whole_line = ((period.reach - root) / gain.max(1e-6)).clamp(1.0, HAIR_INWARD_MAX);
    let share = whole_line * draw_positive([b[1], b[2], b[3]], flyaways.hair_share);
    period.share = share.clamp(HAIR_SHARE_MIN, HAIR_SHARE_MAX);
    // From root to tip along the fiber's own twist, or against it.
    let turned = if period.root_first { TAU } else { -TAU } * period.share;
    let whole = if flyaways.hair_turns_per_period > 0.0 {
        turned * flyaways.hair_turns_per_period
    } else {
        let angle = flyaways.hair_angle;
        whole_line * (angle.mean + angle.deviation * normal_from_words(b[0], a[2]))
    };
    period.twist = whole - turned * flyaways.fiber_turns_per_period;
}

/// Draws what the fiber is in the period `index` of a curve. Wu & Yuksel 2019, Sec. 3.1; statistics of
/// Zhao et al. 2016.
pub fn draw_period(
    periods: &CurvePeriods,
    fiber: &Fiber,
    fiber_index: u32,
    index: i32,
    flyaways: &Flyaways,
) -> Period {
    let identity = period_identity(periods, index, flyaways) as u32;
    let a = hash_words([periods.curve, identity, fiber_index, periods.seed]);
    let chance = uniform_from_word(a[0]);
    let kind = if chance < flyaways.hair_probability {
        Kind::Hair
    } else if chance < flyaways.hair_probability + flyaways.loop_probability {
        Kind::Loop
    } else {
        Kind::Migration
    };
    let mut period = Period { index, kind, reach: 0.0, share: 0.0, twist: 0.0, root_first: a[1] & 1 == 0 };
    match kind {
        Kind::Migration => {}
        Kind::Loop => {
            let spread = flyaways.loop_radius;
            period.reach = spread.mean + spread.deviation * normal_from_words(a[2], a[3]);
        }
        Kind::Hair => draw_hair(&mut period, [a[1], a[2], a[3]], fiber.radius, flyaways),
    }
    period
}

/// A fiber that only migrates. `phase` is that of R, in radians, without the fiber's own m_i.
pub fn migration_shape(fiber: &Fiber, phase: f64, phase_rate: f64, yarn: &YarnParams) -> FiberShape {
    let (radius, slope) =
        migration_radius(fiber.radius, fiber.migration_phase + phase, yarn.migration_min, yarn.migration_max);
    FiberShape { radius, radius_rate: slope * phase_rate, angle: 0.0, angle_rate: 0.0, width: 1.0 }
}

/// Phase of R at place `x` of a period, in radians.
pub fn period_phase(period: &Period, x: f64, flyaways: &Flyaways) -> f64 {
    let parts = flyaways.periods_per_migration as i32;
    TAU * (f64::from(period.index.rem_euclid(parts)) + x) / f64::from(parts) + PI
}

/// R and its derivative by t of the migration that goes on in a period.
pub fn period_migration(
    fiber: &Fiber,
    period: &Period,
    x: f64,
    x_rate: f64,
    (yarn, flyaways): (&YarnParams, &Flyaways),
) -> (f64, f64) {
    let phase = period_phase(period, x, flyaways);
    let (radius, slope) = migration_radius(fiber.radius, phase, yarn.migration_min, yarn.migration_max);
    (radius, slope * TAU * x_rate / f64::from(flyaways.periods_per_migration))
}

/// A loop: migration and a wave on top that brings it out to its own reach; with one period to a migration
/// that is Wu & Yuksel's larger R_max. `x` in [0, 1] is the place in the period.
pub fn loop_shape(
    fiber: &Fiber,
    period: &Period,
    x: f64,
    x_rate: f64,
    (yarn, flyaways): (&YarnParams, &Flyaways),
) -> FiberShape {
    let (radius, rate) = period_migration(fiber, period, x, x_rate, (yarn, flyaways));
    let swing = 0.5 * (period.reach - fiber.radius * yarn.migration_max).max(0.0);
    FiberShape {
        radius: radius + swing * (1.0 - (TAU * x).cos()),
        radius_rate: rate + swing * (TAU * x).sin() * TAU * x_rate,
        angle: 0.0,
        angle_rate: 0.0,
        width: 1.0,
    }
}

/// A hair from its root to its tip: linear in R and angle. `y` in [0, 1] is the place along it.
pub fn hair_shape(
    fiber: &Fiber,
    period: &Period,
    y: f64,
    y_rate: f64,
    (yarn, flyaways): (&YarnParams, &Flyaways),
) -> FiberShape {
    let root = if period.root_first { 0.0 } else { 1.0 };
    let low = period_migration(fiber, period, root, 0.0, (yarn, flyaways)).0;
    let high = period.reach.max(fiber.radius * yarn.migration_max);
    let taper = flyaways.hair_taper;
    FiberShape {
        radius: low + (high - low) * y,
        radius_rate: (high - low) * y_rate,
        angle: period.twist * y,
        angle_rate: period.twist * y_rate,
        width: if taper > 0.0 { ((1.0 - y) / taper).clamp(0.0, 1.0) } else { 1.0 },
    }
}

/// Where the hair of a period ends, as a place in it.
pub fn hair_cut(period: &Period) -> f64 {
    if period.root_first { period.share } else { 1.0 - period.share }
}

/// Whether the place `x` of a hair's period lies on the hair rather than on the rest of the fiber.
pub fn on_hair(period: &Period, x: f64) -> bool {
    if period.root_first { x <= period.share } else { x >= 1.0 - period.share }
}

/// The fiber at place `x` of its period; `x_rate` = dx / dt.
pub fn period_shape(
    fiber: &Fiber,
    period: &Period,
    x: f64,
    x_rate: f64,
    yarn: (&YarnParams, &Flyaways),
) -> FiberShape {
    match period.kind {
        Kind::Loop => loop_shape(fiber, period, x, x_rate, yarn),
        Kind::Hair if on_hair(period, x) => {
            let (direction, y) = if period.root_first { (1.0, x) } else { (-1.0, 1.0 - x) };
            let along = (y / period.share).clamp(0.0, 1.0);
            hair_shape(fiber, period, along, direction * x_rate / period.share, yarn)
        }
        _ => {
            let (radius, radius_rate) = period_migration(fiber, period, x, x_rate, yarn);
            FiberShape { radius, radius_rate, angle: 0.0, angle_rate: 0.0, width: 1.0 }
        }
    }
}
