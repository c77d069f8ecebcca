//! Arguments of the functions of periods, loops and hairs, in the order of `glsl/test/flyaway_kernel.glsl`.

use crate::harness::{Args, Part, number, numbers};
use crate::inputs::{Random, RowBuilder, some_yarn};
use std::f64::consts::{PI, TAU};
use worsted::yarn::fiber::{PieceTurns, Turns};
use worsted::yarn::flyaway::Flyaways;
use worsted::yarn::params::{Spread, YarnParams};
use worsted::yarn::period::{CurvePeriods, FiberShape, Kind, Period};
use worsted::yarn::table::Fiber;

/// Below this a share, an angle or a radius has no relative error worth speaking of.
pub const FLOOR: f64 = 1e-3;
const KINDS: [Kind; 3] = [Kind::Migration, Kind::Loop, Kind::Hair];

/// A piece of yarn as far as periods go.
pub struct Strand {
    pub turns: PieceTurns,
    pub periods: CurvePeriods,
}

/// A yarn as far as periods go.
pub struct Hairy {
    pub yarn: YarnParams,
    pub flyaways: Flyaways,
    pub seed: u32,
}

impl RowBuilder {
    /// A piece `periods` migrations from its curve's start; `count` of them if it is closed.
    pub fn segment(self, curve: u32, periods: i32, count: u32, turns: f64, delta: f64) -> Self {
        self.bits(curve).bits(periods as u32).bits(count).real(turns).real(delta)
    }

    pub fn random_segment(self, random: &mut Random) -> Self {
        let count = if random.below(2) == 0 { 0 } else { 1 + random.below(300) };
        let periods = random.below(600) as i32 - 300;
        let (turns, delta) = (random.between(0.0, 1.0), random.between(-3.0, 3.0));
        self.segment(random.below(2000), periods, count, turns, delta)
    }

    pub fn random_fiber(self, random: &mut Random) -> Self {
        self.real(random.between(0.0, 1.0)).real(random.between(0.0, TAU))
    }

    /// Probabilities at which half of the periods are loops or hairs, and every parameter in its range.
    pub fn random_hairy(self, random: &mut Random) -> Self {
        let low = random.between(0.0, 1.0);
        let bounds = self.real(low).real(random.between(low, 1.5));
        let spread = |row: Self, random: &mut Random, most: f64| {
            let mean = random.between(0.05, most);
            row.real(mean).real(mean * random.between(0.0, 0.6))
        };
        let loops = spread(bounds.real(random.between(0.0, 0.4)), random, 2.0);
        let starts = spread(loops.real(random.between(0.0, 0.6)), random, 1.5);
        let gains = spread(starts, random, 3.0);
        let shares = spread(gains, random, 0.6);
        let angles = spread(shares, random, 2.0 * PI);
        let turns = if random.below(2) == 0 { 0.0 } else { random.between(0.1, 3.0) };
        let taper = if random.below(4) == 0 { 0.0 } else { random.between(0.05, 1.0) };
        let rest = angles.real(turns).real(random.between(0.1, 3.0)).real(taper);
        rest.bits(1 + random.below(8)).bits(random.bits())
    }

    pub fn random_period(self, random: &mut Random) -> Self {
        let kind = KINDS[random.below(3) as usize];
        let index = random.below(2000) as i32 - 1000;
        self.drawn_period(random, index as u32, kind)
    }

    /// As [`Self::random_period`] with this index, and a hair in most rows.
    pub fn period(self, random: &mut Random, index: u32) -> Self {
        let kind = if random.below(4) == 0 { KINDS[random.below(3) as usize] } else { Kind::Hair };
        self.drawn_period(random, index, kind)
    }

    fn drawn_period(self, random: &mut Random, index: u32, kind: Kind) -> Self {
        let drawn =
            self.bits(index).bits(kind as u32).real(random.between(0.0, 4.0)).real(random.between(0.02, 0.9));
        drawn.real(random.between(-6.0, 6.0)).bits(random.below(2))
    }
}

impl Args<'_> {
    pub fn strand(&mut self) -> Strand {
        let (curve, whole, count) = (self.bits(), f64::from(self.bits() as i32), self.bits());
        let migration = Turns { start: whole + self.real(), delta: self.real() };
        let turns = PieceTurns { migration, ..Default::default() };
        Strand { turns, periods: CurvePeriods { curve, count, seed: 0 } }
    }

    pub fn fiber(&mut self) -> Fiber {
        Fiber { radius: self.real(), migration_phase: self.real(), angle: 0.0, ply: 0 }
    }

    fn spread(&mut self) -> Spread {
        Spread { mean: self.real(), deviation: self.real() }
    }

    pub fn hairy(&mut self) -> Hairy {
        let some = some_yarn();
        let yarn = YarnParams { migration_min: self.real(), migration_max: self.real(), ..some };
        let flyaways = Flyaways {
            loop_probability: self.real(),
            loop_radius: self.spread(),
            hair_probability: self.real(),
            hair_start: self.spread(),
            hair_gain: self.spread(),
            hair_share: self.spread(),
            hair_angle: self.spread(),
            hair_turns_per_period: self.real(),
            fiber_turns_per_period: self.real(),
            hair_taper: self.real(),
            migration_min: yarn.migration_min,
            periods_per_migration: self.bits(),
            reach_mm: 0.0,
        };
        Hairy { yarn, flyaways, seed: self.bits() }
    }

    pub fn period(&mut self) -> Period {
        Period {
            index: self.bits() as i32,
            kind: KINDS[self.bits() as usize],
            reach: self.real(),
            share: self.real(),
            twist: self.real(),
            root_first: self.bits() != 0,
        }
    }

    pub fn words(&mut self) -> [u32; 3] {
        std::array::from_fn(|_| self.bits())
    }
}

/// Both halves of a word.
pub fn halves(word: u32) -> Part {
    numbers("word", vec![f64::from(word >> 16), f64::from(word & 0xffff)], 1.0)
}

pub fn truth(name: &'static str, value: bool) -> Part {
    number(name, f64::from(u8::from(value)), 1.0)
}

pub fn period_parts(period: &Period) -> Vec<Part> {
    vec![
        number("kind", f64::from(period.kind as u32), 1.0),
        number("reach", period.reach, 1e-2),
        number("share", period.share, 1e-2),
        number("twist", period.twist, 1e-1),
        truth("root first", period.root_first),
    ]
}

pub fn shape_parts(shape: &FiberShape, x_rate: f64) -> Vec<Part> {
    let rate_floor = FLOOR.max(1e-2 * x_rate.abs());
    vec![
        number("radius", shape.radius, FLOOR),
        number("radius rate", shape.radius_rate, rate_floor),
        number("angle", shape.angle, FLOOR),
        number("angle rate", shape.angle_rate, rate_floor),
        number("width", shape.width, FLOOR),
    ]
}
