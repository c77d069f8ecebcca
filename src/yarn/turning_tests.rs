use super::*;
use crate::math::curve::{Basis, Curve, bezier_from_basis};
use crate::yarn::presets;
use crate::yarn::strand::strands;

/// A piece of yarn that runs 9 mm and turns back at both of its ends onto a line 1.6 mm beside.
fn hairpin() -> [DVec3; 4] {
    let p = [(-4.5, 0.0), (4.5, 0.0), (-4.5, 1.6), (4.5, 1.6)].map(|(x, y)| DVec3::new(x, y, 0.0));
    bezier_from_basis(&p, Basis::CatmullRom)
}

/// One that stops in its middle and goes back.
fn cusp() -> [DVec3; 4] {
    [(-6.0, -2.0), (6.0, 5.0), (-6.0, 5.0), (6.0, -2.0)].map(|(x, y)| DVec3::new(x, y, 0.0))
}

fn table(turning: &Turning, turned_share: f64) -> [f64; TABLED_BREAKS] {
    std::array::from_fn(|k| match k + 1 {
        TABLED_BREAKS => 1.0,
        next => break_at(turning, turned_share, next as f64 / TABLED_BREAKS as f64),
    })
}

/// Most that the yarn's direction turns between two of `count` + 1 cuts, in radians.
fn most_turned(b: &[DVec3; 4], count: u32, cut: impl Fn(f64) -> f64) -> f64 {
    let cuts: Vec<f64> = (0..=count).map(|k| cut(f64::from(k) / f64::from(count))).collect();
    assert!(cuts.windows(2).all(|pair| pair[1] > pair[0]) && cuts[0] == 0.0 && cuts[count as usize] == 1.0);
    let along = |t: f64| bezier_point(b, t).derivative;
    cuts.windows(2).map(|pair| turning_angle(along(pair[0]), along(pair[1]))).fold(0.0, f64::max)
}

#[test]
fn a_plane_curve_turns_as_its_two_spots_say() {
    for b in [hairpin(), hairpin().map(|p| DVec3::new(p.x, 0.0, 40.0 * p.y))] {
        let turning = turning_of(&b);
        let along = |t: f64| bezier_point(&b, t).derivative;
        for k in 0..200 {
            let (from, to) = (f64::from(k) / 200.0, f64::from(k + 1) / 200.0);
            let expected = turning_angle(along(from), along(to));
            let found = turned_angle(&turning, to) - turned_angle(&turning, from);
            assert!((found - expected).abs() < 0.02, "{from}: {found} for {expected}");
        }
    }
}

#[test]
fn cuts_of_a_hairpin_follow_its_turn() {
    let turning = turning_of(&hairpin());
    assert_eq!(turning.swift, 1.0);
    let breaks = table(&turning, 0.5);
    let (evenly, tabled) =
        (most_turned(&hairpin(), 30, |t| t), most_turned(&hairpin(), 30, |t| tabled_break(&breaks, t)));
    // Half of the cuts go to two quarters of a turn: 12 degrees each.
    assert!(evenly > 1.0 && tabled < 0.3, "{evenly} and {tabled} rad");
    for k in 0..=TABLED_BREAKS {
        let share = k as f64 / TABLED_BREAKS as f64;
        assert!((share_before(&turning, 0.5, tabled_break(&breaks, share)) - share).abs() < 1e-5);
    }
}

#[test]
fn no_step_is_longer_than_the_calm_part_allows() {
    for b in [hairpin(), cusp()] {
        let breaks = table(&turning_of(&b), MOST_TURNED);
        let longest = (0..64).map(|k| {
            let cut = |k: u32| tabled_break(&breaks, f64::from(k) / 64.0);
            cut(k + 1) - cut(k)
        });
        assert!(longest.fold(0.0, f64::max) * 64.0 * (1.0 - MOST_TURNED) <= 1.0 + 1e-5);
    }
}

#[test]
fn a_cusp_is_cut_where_it_lies() {
    let turning = turning_of(&cusp());
    assert!((turning.places - 0.5).abs().max_element() < 1e-3, "{turning:?}");
    assert_eq!(turning.swift, 1.0);
    assert!(
        (break_at(&turning, 0.5, 0.4) - 0.5).abs() < 1e-3
            && (break_at(&turning, 0.5, 0.6) - 0.5).abs() < 1e-3
    );
}

#[test]
fn straight_and_standing_pieces_do_not_turn() {
    let at = |x: [f64; 4]| x.map(|x| DVec3::X * x);
    for b in [at([0.0; 4]), at([7.0; 4]), at([0.0, 1.0, 2.0, 3.0]), at([0.0, 1.0, 1.5, 1.6])] {
        let turning = turning_of(&b);
        assert!(turning.swift == 0.0 && turning.widths.is_finite(), "{b:?}: {turning:?}");
    }
}

#[test]
fn what_swings_around_a_hairpin_departs_by_no_more_than_allowed() {
    let turning = turning_of(&hairpin());
    for (calm, tolerance_mm) in [(1, 0.01), (12, 0.01), (12, 0.003), (40, 0.01)] {
        let cutting = UnevenCutting { even: calm + 3, calm, reach_mm: 1.5, tolerance_mm, largest: 1000 };
        let Cut { pieces, share } = uneven_cut(&turning, &hairpin(), &cutting);
        let breaks = table(&turning, share);
        let swung = most_turned(&hairpin(), pieces, |t| tabled_break(&breaks, t));
        // A table's cuts lie evenly in between: a little apart from where they should.
        let departure = cutting.reach_mm * swung * swung / 8.0;
        assert!(departure < 2.0 * tolerance_mm, "{pieces} pieces, {share}: {departure} mm");
        let longest = (0..pieces).map(|k| {
            let cut = |k: u32| tabled_break(&breaks, f64::from(k) / f64::from(pieces));
            cut(k + 1) - cut(k)
        });
        assert!(longest.fold(0.0, f64::max) * f64::from(calm) < 1.0 + 1e-5, "{pieces} for {calm} calm ones");
    }
}

#[test]
fn one_hairpin_among_many_pieces_is_found() {
    let yarn = presets::yarn(presets::DEFAULT_YARN).unwrap();
    let wave: Vec<_> = (0..41).map(|i| DVec3::new(f64::from(i), (0.5 * f64::from(i)).sin(), 0.0)).collect();
    let swift = |points: Vec<DVec3>| {
        turns_swiftly(&strands(&[Curve { points, closed: false }], Basis::CatmullRom, &yarn, 0))
    };
    assert!(!swift(wave.clone()));
    let mut folded = wave;
    // It comes back beside itself.
    folded[30] = folded[28] + 0.01 * DVec3::Z;
    assert!(swift(folded));
}
