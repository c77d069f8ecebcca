//! `glsl/yarn/turning.glsl`.

use crate::harness::{Args, Case, Row, number};
use crate::inputs::{Random, RowBuilder, random_rows, row, special_pieces};
use glam::{DVec2, DVec3};
use worsted::yarn::turning::{self, TABLED_BREAKS, Turning, UnevenCutting};

pub fn cases() -> Vec<Case> {
    vec![turn_spot(), turning_of(), turned_angle(), share_before(), break_at(), tabled_break(), uneven_cut()]
}

fn with_turning(row: RowBuilder, turning: &Turning) -> RowBuilder {
    let (places, widths) = (turning.places, turning.widths);
    [places.x, places.y, widths.x, widths.y, turning.swift].iter().fold(row, |row, v| row.real(*v))
}

fn read(args: &mut Args<'_>) -> Turning {
    let mut pair = || DVec2::new(args.real(), args.real());
    let (places, widths) = (pair(), pair());
    Turning { places, widths, swift: args.real() }
}

/// Spots in the piece and beside it, from the narrowest to none.
fn some_turning(random: &mut Random) -> Turning {
    let mut spot = || (random.between(-0.2, 1.2), random.magnitude(1e-4, 1e3));
    let (first, second) = (spot(), spot());
    Turning {
        places: DVec2::new(first.0, second.0),
        widths: DVec2::new(first.1, second.1),
        swift: random.between(0.0, 1.0),
    }
}

/// A piece that comes to a point or nearly so: a quarter of the rows are of any kind.
fn sharp_piece(random: &mut Random) -> [DVec3; 4] {
    if random.below(4) == 0 {
        return random.piece();
    }
    let size = random.magnitude(1e-3, 1e3);
    let (along, side) = (random.unit(), random.unit());
    let off = size * random.magnitude(1e-3, 0.3);
    let start = size * random.unit();
    let back = random.between(-0.9, 0.9);
    // A short leg, a long one back, and a short one: a turn at either end.
    [start, start + off * side, start + size * along, start + size * along + off * back * side]
}

fn turn_spot() -> Case {
    let mut rows = random_rows("turn_spot", |random| {
        let b = sharp_piece(random);
        row().piece(&b).real(f64::from(random.below(2))).end()
    });
    rows.extend(special_pieces().iter().flat_map(|b| [0.0, 1.0].map(|t| row().piece(b).real(t).end())));
    Case {
        function: "turn_spot",
        rows,
        twin: |args| {
            let spot = turning::turn_spot(&args.piece(), args.real());
            // Places and widths matter to the piece's own length: far off or wide is no turn.
            vec![number("place", spot.x, 1.0), number("width", spot.y, 1e-2)]
        },
        invariant: Some(|_, found| (found[1] > 0.0).then_some(()).ok_or_else(|| "no width".into())),
    }
}

fn turning_of() -> Case {
    let mut rows = random_rows("turning_of", |random| row().piece(&sharp_piece(random)).end());
    rows.extend(special_pieces().iter().map(|b| row().piece(b).end()));
    Case {
        function: "turning_of",
        rows,
        twin: |args| vec![number("swift", turning::turning_of(&args.piece()).swift, 1e-1)],
        invariant: Some(|_, found| {
            (0.0..=1.0).contains(&found[0]).then_some(()).ok_or_else(|| "no share".into())
        }),
    }
}

fn turned_angle() -> Case {
    Case {
        function: "turned_angle",
        rows: random_rows("turned_angle", |random| {
            with_turning(row(), &some_turning(random)).real(random.t()).end()
        }),
        twin: |args| {
            let turning = read(args);
            vec![number("angle", turning::turned_angle(&turning, args.real()), 1.0)]
        },
        invariant: None,
    }
}

/// Turnings as pieces have them that are cut unevenly: one of their spots is sharp and in or at the piece.
fn uneven_turning(random: &mut Random) -> Turning {
    let mut turning = some_turning(random);
    turning.places.x = random.between(0.0, 1.0);
    turning.widths.x = random.magnitude(1e-4, 0.07);
    turning
}

fn uneven_rows(function: &str) -> Vec<Row> {
    random_rows(function, |random: &mut Random| {
        let turned = with_turning(row(), &uneven_turning(random)).real(random.between(0.0, 0.75));
        turned.real(random.between(0.0, 1.0)).end()
    })
}

fn share_before() -> Case {
    Case {
        function: "share_before",
        rows: uneven_rows("share_before"),
        twin: |args| {
            let turning = read(args);
            vec![number("share", turning::share_before(&turning, args.real(), args.real()), 1.0)]
        },
        invariant: Some(|_, found| {
            (-1e-5..=1.00001).contains(&found[0]).then_some(()).ok_or_else(|| "no share".into())
        }),
    }
}

fn break_at() -> Case {
    Case {
        function: "break_at",
        rows: uneven_rows("break_at"),
        twin: |args| {
            let turning = read(args);
            vec![number("t", turning::break_at(&turning, args.real(), args.real()), 1.0)]
        },
        invariant: Some(|_, found| {
            (0.0..=1.0).contains(&found[0]).then_some(()).ok_or_else(|| "outside of the piece".into())
        }),
    }
}

fn tabled_break() -> Case {
    let tabled = |random: &mut Random| {
        let mut breaks: Vec<f64> = (1..TABLED_BREAKS).map(|_| random.between(0.0, 1.0)).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.iter().chain([&1.0]).fold(row(), |row, t| row.real(*t))
    };
    let mut rows = random_rows("tabled_break", |random| tabled(random).real(random.between(0.0, 1.0)).end());
    let mut random = Random::of("special tables of breaks");
    rows.extend([0.0, 1.0, 0.0625, 0.9375, -0.1, 1.1].map(|share| tabled(&mut random).real(share).end()));
    Case {
        function: "tabled_break",
        rows,
        twin: |args| {
            let breaks = std::array::from_fn(|_| args.real());
            vec![number("t", turning::tabled_break(&breaks, args.real()), 1.0)]
        },
        invariant: None,
    }
}

fn uneven_cut() -> Case {
    let make = |random: &mut Random| loop {
        let (b, mut turning) = (sharp_piece(random), some_turning(random));
        if random.below(4) == 0 {
            turning.swift = 0.0;
        }
        let size = b[0].distance(b[2]);
        let cutting = UnevenCutting {
            even: 1 + random.below(40),
            calm: 1 + random.below(40),
            reach_mm: size * random.magnitude(0.01, 1.0),
            tolerance_mm: size * random.magnitude(1e-4, 0.1),
            largest: 64,
        };
        // A whole number of pieces rounds up or not as the last digit falls; both are right.
        let count = |reach: f64, swift: f64| {
            let turning = Turning { swift: turning.swift * swift, ..turning };
            let cutting = UnevenCutting { reach_mm: cutting.reach_mm * reach, ..cutting };
            turning::uneven_cut(&turning, &b, &cutting).pieces
        };
        let counts = [(0.9999, 0.9999), (0.9999, 1.0001), (1.0001, 0.9999), (1.0001, 1.0001)];
        if counts.iter().all(|(reach, swift)| count(*reach, *swift) == count(1.0, 1.0)) {
            let given = with_turning(row(), &turning).piece(&b).bits(cutting.even).bits(cutting.calm);
            return given.real(cutting.reach_mm).real(cutting.tolerance_mm).bits(64).end();
        }
    };
    Case {
        function: "uneven_cut",
        rows: random_rows("uneven_cut", make),
        twin: |args| {
            let (turning, b) = (read(args), args.piece());
            let cutting = UnevenCutting {
                even: args.bits(),
                calm: args.bits(),
                reach_mm: args.real(),
                tolerance_mm: args.real(),
                largest: args.bits(),
            };
            let cut = turning::uneven_cut(&turning, &b, &cutting);
            vec![number("pieces", cut.pieces.into(), 1.0), number("share", cut.share, 1e-2)]
        },
        invariant: None,
    }
}
