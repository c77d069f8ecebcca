use super::*;
use crate::precompute::self_shadow::{
    SELF_SHADOW_LIMIT, SelfShadowSize, bake_self_shadow, exact_self_shadow_depth, self_shadow_depth,
    self_shadow_place,
};
use crate::precompute::table_error::places;
use crate::yarn::inside::fits_table;
use crate::yarn::presets;

fn wool(edit: impl FnOnce(&mut YarnParams)) -> YarnParams {
    let mut yarn = presets::yarn("worsted_3ply").unwrap();
    edit(&mut yarn);
    yarn
}

/// Yarns whose plies fit no table by place, each with what is wrong with them.
fn unfit() -> Vec<(&'static str, YarnParams)> {
    let still = |yarn: &mut YarnParams| (yarn.migration_min, yarn.migration_max) = (1.0, 1.0);
    vec![
        ("radial 100:1", wool(|y| (y.ellipse_short_mm, y.ellipse_long_mm) = (4.0, 0.04))),
        ("tangential 100:1", wool(|y| (y.ellipse_short_mm, y.ellipse_long_mm) = (0.04, 4.0))),
        ("the thinnest", wool(|y| (y.ellipse_short_mm, y.ellipse_long_mm) = (0.0042, 4.0))),
        ("far apart", wool(|y| y.yarn_radius_mm = 100.0)),
        ("one beside the axis", wool(|y| y.ply_count = 1)),
        ("eight flat ones", wool(|y| (y.ply_count, y.ellipse_short_mm) = (8, 0.1))),
        ("a step", wool(|y| (still(y), y.density_beta = 0.0).1)),
        ("half a step", wool(|y| (still(y), y.density_epsilon = 0.5).1)),
        ("a peak", wool(|y| (still(y), y.density_beta = 20.0, y.density_epsilon = 0.0).1)),
        ("all through the axis", wool(|y| y.migration_min = 0.0)),
    ]
}

/// Places all over the yarn, and as many in its plies, with light from all around.
fn tried(yarn: &YarnParams) -> impl Iterator<Item = (DVec2, DVec2)> {
    let plies = Plies::new(yarn);
    (0..40_000).zip(places(40_000)).map(move |(index, (place, light))| {
        let angle = DVec2::from_angle(TAU * f64::from(index) / f64::from(plies.count));
        let in_ply = angle.rotate(DVec2::new(plies.offset, 0.0) + plies.axes * place);
        (if index % 2 == 0 { place } else { in_ply }, light)
    })
}

fn error(yarn: &YarnParams, read: impl Fn(DVec2, DVec2) -> f64 + Sync) -> TableError {
    let section = CrossSection::new(yarn);
    let all: Vec<_> = tried(yarn).collect();
    let pairs: Vec<(f64, f64)> = all
        .into_par_iter()
        .map(|(place, light)| (read(place, light), exact_self_shadow_depth(&section, place, light)))
        .collect();
    let range = pairs.iter().map(|pair| pair.1).fold(0.0, f64::max);
    TableError::new(&pairs, range)
}

#[test]
fn chords_are_close_to_the_integral_where_the_table_by_place_is_not() {
    let mut beyond = 0;
    for (what, yarn) in unfit() {
        assert!(!fits_table(&yarn), "{what}");
        assert_eq!(yarn.validate(), Ok(()), "{what}");
        let (table, plies) = (bake_chord_shadow(&yarn), Plies::new(&yarn));
        let by_chords = error(&yarn, |place, light| chord_depth(&table, place, light, &plies));
        let size = SelfShadowSize::default();
        let by_place = bake_self_shadow(&yarn, size);
        let read = |place, light| {
            self_shadow_depth(&by_place, self_shadow_place(place, light, yarn.ply_count, size))
        };
        let by_place = error(&yarn, read);
        println!("{what}: {by_chords:?}, by place {by_place:?}");
        assert!(by_chords.within(&CHORD_LIMIT), "{what}: {by_chords:?}");
        assert!(by_chords.rms < 0.2 * by_place.rms, "{what}: {by_chords:?}, by place {by_place:?}");
        beyond += usize::from(!by_place.within(&SELF_SHADOW_LIMIT));
    }
    assert!(beyond >= 6, "only {beyond} of these need chords");
}

#[test]
fn chords_show_presets_as_well() {
    for name in presets::yarn_names() {
        let yarn = presets::yarn(name).unwrap();
        let (table, plies) = (bake_chord_shadow(&yarn), Plies::new(&yarn));
        let found = error(&yarn, |place, light| chord_depth(&table, place, light, &plies));
        assert!(found.within(&CHORD_LIMIT), "{name}: {found:?}");
    }
}

#[test]
fn wrong_chords_are_refused() {
    let yarn = wool(|y| y.ellipse_short_mm = 0.05);
    let (right, plies) = (bake_chord_shadow(&yarn), Plies::new(&yarn));
    let judged = |table: &ChordShadow, plies: Plies| {
        error(&yarn, |place, light| chord_depth(table, place, light, &plies)).within(&CHORD_LIMIT)
    };
    assert!(judged(&right, plies));
    let mut backward = right.clone();
    backward.rests.chunks_exact_mut(ALONG as usize).for_each(<[f16]>::reverse);
    let mut inside_out = right.clone();
    inside_out.rests.reverse();
    inside_out.rests.chunks_exact_mut(ALONG as usize).for_each(<[f16]>::reverse);
    assert!(!judged(&backward, plies) && !judged(&inside_out, plies));
    let swapped = DVec2::new(plies.axes.y, plies.axes.x);
    for wrong in [
        Plies { axes: swapped, ..plies },
        Plies { turn: plies.turn.perp(), ..plies },
        Plies { offset: 1.05 * plies.offset, ..plies },
        Plies { count: plies.count - 1, ..plies },
    ] {
        assert!(!judged(&right, wrong), "{wrong:?}");
    }
}

#[test]
fn light_passes_clear_places_and_meets_whole_plies() {
    let yarn = wool(|y| (y.ply_count, y.yarn_radius_mm) = (1, 0.0));
    let (table, plies) = (bake_chord_shadow(&yarn), Plies::new(&yarn));
    let depth = |place: DVec2, light: DVec2| chord_depth(&table, place, light, &plies);
    assert_eq!(depth(1.1 * DVec2::Y, DVec2::Y), 0.0);
    assert_eq!(depth(1.1 * DVec2::Y - DVec2::X, DVec2::X), 0.0);
    let (whole, half) = (depth(-3.0 * DVec2::Y, DVec2::Y), depth(DVec2::ZERO, DVec2::Y));
    assert!((half / whole - 0.5).abs() < 1e-3, "{half} and {whole}");
    assert_eq!(depth(DVec2::ZERO, DVec2::ZERO), depth(DVec2::ZERO, DVec2::X), "no direction");
    assert_eq!(depth(DVec2::ZERO, DVec2::Y), depth(DVec2::ZERO, 1e-6 * DVec2::Y));
}

#[test]
fn a_ply_is_touched_without_a_jump() {
    let axes = DVec2::new(1e-3, 1.0);
    let length = |distance: f64| ply_chord(DVec2::new(distance, 0.3), DVec2::Y, 0.5, axes).z;
    assert_eq!((length(0.499 - 1e-9), length(0.501 + 1e-9)), (0.0, 0.0));
    let steps = (0..=1000).map(|i| length(0.499 + 2e-6 * f64::from(i)));
    let lengths: Vec<f64> = steps.collect();
    assert!(lengths.iter().all(|l| (0.0..=1.0).contains(l)) && (lengths[500] - 1.0).abs() < 1e-9);
    // A circle's chord a thousandth of its width from the rim is 6% of the longest.
    assert!(lengths.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 0.07), "{lengths:?}");
}
