//! `glsl/lib/hash.glsl`, `glsl/yarn/period.glsl` and `glsl/yarn/breaks.glsl`.

use crate::flyaway_rows::{FLOOR, Hairy, Strand, halves, period_parts, shape_parts, truth};
use crate::harness::{Args, Case, Part, Row, number, vector};
use crate::inputs::{Random, random_rows, row};
use glam::DVec3;
use worsted::math::hash;
use worsted::yarn::breaks;
use worsted::yarn::params::Spread;
use worsted::yarn::period::{self, CurvePeriods, FiberShape, Kind, Period};

/// Words at the ends of the range and around its middle.
const SPECIAL_WORDS: [u32; 8] = [0, 1, 511, 512, 0x7fff_ffff, 0x8000_0000, 0xffff_fdff, u32::MAX];

type Twin = fn(&mut Args<'_>) -> Vec<Part>;

pub fn cases() -> Vec<Case> {
    let mut all = vec![hash_words(), uniform_from_word(), normal_from_words(), draw_positive(), draw_hair()];
    all.extend([period_turns(), period_rate(), period_base(), period_identity(), draw_period()]);
    all.extend([migration_shape(), period_phase(), period_migration()]);
    all.extend([shape_case("loop_shape"), shape_case("hair_shape"), shape_case("period_shape")]);
    all.extend([hair_cut(), on_hair(), cut_side(), is_broken(), meets_tip(), strand_vertex()]);
    all
}

fn case(function: &'static str, make: impl Fn(&mut Random) -> Row, twin: Twin) -> Case {
    Case { function, rows: random_rows(function, make), twin, invariant: None }
}

fn with_periods(strand: &Strand, hairy: &Hairy) -> CurvePeriods {
    CurvePeriods { seed: hairy.seed, ..strand.periods }
}

fn hash_words() -> Case {
    let any = |random: &mut Random| (0..4).fold(row(), |row, _| row.bits(random.bits())).end();
    let mut case = case("hash_words", any, |args| {
        let [x, y, z] = args.words();
        hash::hash_words([x, y, z, args.bits()]).map(halves).to_vec()
    });
    case.rows.extend(SPECIAL_WORDS.map(|word| row().bits(word).bits(0).bits(1).bits(word).end()));
    case
}

fn uniform_from_word() -> Case {
    let mut case = case(
        "uniform_from_word",
        |random| row().bits(random.bits()).end(),
        |args| vec![number("uniform", hash::uniform_from_word(args.bits()), f64::MIN_POSITIVE)],
    );
    case.rows.extend(SPECIAL_WORDS.map(|word| row().bits(word).end()));
    case
}

fn normal_from_words() -> Case {
    let mut case = case(
        "normal_from_words",
        |random| row().bits(random.bits()).bits(random.bits()).end(),
        |args| {
            let (a, b) = (args.bits(), args.bits());
            // A deviation is the scale of a normal number. An error e of the logarithm moves the radius
            // by e / radius, and Vulkan allows 2^-21 where it is near 0: one draw in 100,000.
            let radius = (-2.0 * hash::uniform_from_word(a).ln()).sqrt();
            vec![number("normal", hash::normal_from_words(a, b), 1.0_f64.max(4.8e-3 / radius))]
        },
    );
    case.rows.extend(SPECIAL_WORDS.iter().flat_map(|&a| SPECIAL_WORDS.map(|b| row().bits(a).bits(b).end())));
    case
}

fn draw_positive() -> Case {
    let words = |random: &mut Random| (0..3).fold(row(), |row, _| row.bits(random.bits()));
    let mut case = case(
        "draw_positive",
        |random| words(random).real(random.between(-0.2, 2.0)).real(random.between(0.0, 1.0)).end(),
        |args| {
            let words = args.words();
            let spread = Spread { mean: args.real(), deviation: args.real() };
            vec![number("value", period::draw_positive(words, spread), 1.0)]
        },
    );
    let mut random = Random::of("special draws");
    for (mean, deviation) in [(0.0, 0.0), (-1.0, 0.1), (1.0, 0.0), (0.0, 1.0)] {
        case.rows.push(words(&mut random).real(mean).real(deviation).end());
    }
    case
}

fn draw_hair() -> Case {
    case(
        "draw_hair",
        |random| {
            let words = (0..3).fold(row(), |row, _| row.bits(random.bits()));
            words.real(random.between(0.0, 1.0)).random_hairy(random).bits(random.below(2)).end()
        },
        |args| {
            let (words, radius, hairy) = (args.words(), args.real(), args.hairy());
            let root_first = args.bits() != 0;
            let mut drawn =
                Period { index: 0, kind: Kind::Hair, reach: 0.0, share: 0.0, twist: 0.0, root_first };
            period::draw_hair(&mut drawn, words, radius, &hairy.flyaways);
            period_parts(&drawn)
        },
    )
}

fn period_turns() -> Case {
    case(
        "period_turns",
        |random| {
            row().random_segment(random).random_fiber(random).real(random.t()).random_hairy(random).end()
        },
        |args| {
            let (strand, fiber, t, hairy) = (args.strand(), args.fiber(), args.real(), args.hairy());
            // The device counts from the whole period in which the piece starts.
            let base = strand.turns.migration.start.floor() * f64::from(hairy.flyaways.periods_per_migration);
            vec![number("turns", period::period_turns(&strand.turns, &fiber, t, &hairy.flyaways) - base, 1.0)]
        },
    )
}

fn period_rate() -> Case {
    case(
        "period_rate",
        |random| row().random_segment(random).random_hairy(random).end(),
        |args| {
            let (strand, hairy) = (args.strand(), args.hairy());
            vec![number("rate", period::period_rate(&strand.turns, &hairy.flyaways), FLOOR)]
        },
    )
}

fn period_base() -> Case {
    case(
        "period_base",
        |random| row().random_segment(random).random_hairy(random).end(),
        |args| {
            let (strand, hairy) = (args.strand(), args.hairy());
            let whole = strand.turns.migration.start.floor();
            vec![number("base", whole * f64::from(hairy.flyaways.periods_per_migration), 1.0)]
        },
    )
}

fn period_identity() -> Case {
    case(
        "period_identity",
        |random| {
            let index = random.below(10_000) as i32 - 5_000;
            row().random_segment(random).bits(index as u32).random_hairy(random).end()
        },
        |args| {
            let (strand, index, hairy) = (args.strand(), args.bits() as i32, args.hairy());
            vec![halves(period::period_identity(&strand.periods, index, &hairy.flyaways) as u32)]
        },
    )
}

fn draw_period() -> Case {
    case(
        "draw_period",
        |random| {
            let index = random.below(10_000) as i32 - 5_000;
            let placed = row().random_segment(random).random_fiber(random);
            placed.bits(random.below(600)).bits(index as u32).random_hairy(random).end()
        },
        |args| {
            let (strand, fiber, fiber_index) = (args.strand(), args.fiber(), args.bits());
            let (index, hairy) = (args.bits() as i32, args.hairy());
            let periods = with_periods(&strand, &hairy);
            period_parts(&period::draw_period(&periods, &fiber, fiber_index, index, &hairy.flyaways))
        },
    )
}

fn migration_shape() -> Case {
    case(
        "migration_shape",
        |random| {
            let fiber = row().random_fiber(random);
            fiber.real(random.between(0.0, 7.0)).real(random.between(-9.0, 9.0)).random_hairy(random).end()
        },
        |args| {
            let (fiber, phase, rate, hairy) = (args.fiber(), args.real(), args.real(), args.hairy());
            shape_parts(&period::migration_shape(&fiber, phase, rate, &hairy.yarn), rate)
        },
    )
}

/// The kernel gives the cosine and sine: phases a whole turn apart are one.
fn period_phase() -> Case {
    case(
        "period_phase",
        |random| row().random_period(random).real(random.t()).random_hairy(random).end(),
        |args| {
            let (drawn, x, hairy) = (args.period(), args.real(), args.hairy());
            let phase = period::period_phase(&drawn, x, &hairy.flyaways);
            vec![vector("phase", DVec3::new(phase.cos(), phase.sin(), 0.0), 1.0)]
        },
    )
}

fn placed_row(random: &mut Random) -> Row {
    let fiber = row().random_fiber(random).random_period(random);
    fiber.real(random.t()).real(random.between(-9.0, 9.0)).random_hairy(random).end()
}

fn period_migration() -> Case {
    case("period_migration", placed_row, |args| {
        let (fiber, drawn, x, rate, hairy) =
            (args.fiber(), args.period(), args.real(), args.real(), args.hairy());
        let yarn = (&hairy.yarn, &hairy.flyaways);
        let (radius, slope) = period::period_migration(&fiber, &drawn, x, rate, yarn);
        vec![number("radius", radius, FLOOR), number("rate", slope, FLOOR.max(1e-2 * rate.abs()))]
    })
}

fn shape_case(function: &'static str) -> Case {
    fn shape(
        args: &mut Args<'_>,
        of: impl Fn(&worsted::yarn::table::Fiber, &Period, f64, f64, &Hairy) -> FiberShape,
    ) -> Vec<Part> {
        let (fiber, drawn, x, rate, hairy) =
            (args.fiber(), args.period(), args.real(), args.real(), args.hairy());
        // A hair goes through its angle and reach in its share of the period.
        shape_parts(&of(&fiber, &drawn, x, rate, &hairy), rate / drawn.share)
    }
    let twin: Twin = match function {
        "loop_shape" => {
            |args| shape(args, |f, p, x, rate, h| period::loop_shape(f, p, x, rate, (&h.yarn, &h.flyaways)))
        }
        "hair_shape" => {
            |args| shape(args, |f, p, x, rate, h| period::hair_shape(f, p, x, rate, (&h.yarn, &h.flyaways)))
        }
        _ => {
            |args| shape(args, |f, p, x, rate, h| period::period_shape(f, p, x, rate, (&h.yarn, &h.flyaways)))
        }
    };
    case(function, placed_row, twin)
}

fn hair_cut() -> Case {
    case(
        "hair_cut",
        |random| row().random_period(random).end(),
        |args| vec![number("cut", period::hair_cut(&args.period()), FLOOR)],
    )
}

fn on_hair() -> Case {
    case(
        "on_hair",
        |random| row().random_period(random).real(random.t()).end(),
        |args| vec![truth("on it", period::on_hair(&args.period(), args.real()))],
    )
}

fn cut_side() -> Case {
    case(
        "cut_side",
        |random| row().random_period(random).real(random.t()).end(),
        |args| vec![number("side", f64::from(breaks::cut_side(&args.period(), args.real())), 1.0)],
    )
}

fn is_broken() -> Case {
    let near = |random: &mut Random| {
        let exit = random.below(8000) as i32 - 4000;
        row().bits(exit as u32).bits((exit + random.below(8) as i32 - 4) as u32).end()
    };
    case("is_broken", near, |args| {
        let (exit, entry) = (args.bits() as i32, args.bits() as i32);
        vec![truth("broken", breaks::is_broken(exit, entry))]
    })
}

/// The period the fiber is in at the place that the arguments name, and a neighbour within a period of it.
fn meets_tip() -> Case {
    let make = |random: &mut Random| {
        let base = random.below(2000);
        let u = random.between(-1.0, 2.0);
        let index = base + random.below(2);
        let placed = row().period(random, index).bits(base);
        placed.real(u).real(u + random.between(-1.0, 1.0)).end()
    };
    case("meets_tip", make, |args| {
        let (drawn, base) = (args.period(), f64::from(args.bits()));
        let (u, neighbour) = (args.real(), args.real());
        let tip = breaks::meets_tip(&drawn, u + base, neighbour + base);
        vec![truth("meets", tip.is_some()), number("tip", tip.map_or(0.0, |tip| tip - base), 1.0)]
    })
}

fn strand_vertex() -> Case {
    let make = |random: &mut Random| {
        let pieces = 12 + random.below(52);
        let placed = row().random_segment(random).random_fiber(random).bits(random.below(600));
        let t = f64::from(random.below(pieces + 1)) / f64::from(pieces);
        let [before, behind] = breaks::neighbours(t, pieces);
        placed.real(t).real(before).real(behind).random_hairy(random).end()
    };
    case("strand_vertex", make, |args| {
        let (strand, fiber, index) = (args.strand(), args.fiber(), args.bits());
        let (t, neighbours, hairy) = (args.real(), [args.real(), args.real()], args.hairy());
        let periods = with_periods(&strand, &hairy);
        let v = breaks::strand_vertex(&strand.turns, &fiber, index, t, neighbours, &periods, &hairy.flyaways);
        let mut parts = vec![number("t", v.t, 1.0), number("x", v.x, 1.0)];
        parts.extend([number("entry", v.entry.into(), 1.0), number("exit", v.exit.into(), 1.0)]);
        parts.extend(period_parts(&v.period));
        parts
    })
}
