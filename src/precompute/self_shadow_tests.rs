use super::*;
use crate::precompute::chord_shadow::bake_chord_shadow;
use crate::precompute::occlusion_table::bake_occlusion_table;
use crate::precompute::table_error::places;
use crate::yarn::density::extinction_per_mm;
use crate::yarn::presets;

fn error_of(table: &SelfShadowTable, yarn: &YarnParams) -> TableError {
    let section = CrossSection::new(yarn);
    let pair = |(position, toward): (DVec2, DVec2)| {
        let place = self_shadow_place(position, toward, yarn.ply_count, table.size);
        (self_shadow_depth(table, place), exact_self_shadow_depth(&section, position, toward))
    };
    let places: Vec<(DVec2, DVec2)> = places(50_000).collect();
    TableError::new(&places.into_par_iter().map(pair).collect::<Vec<_>>(), table.largest())
}

/// The default yarn with other plies: so many that they overlap, or one alone beside the yarn's centre, so that
/// every angle of the light differs.
fn yarn_of(ply_count: u32) -> YarnParams {
    YarnParams { ply_count, ..presets::yarn(presets::DEFAULT_YARN).unwrap() }
}

#[test]
fn the_table_is_close_to_the_integral_for_every_preset() {
    for name in presets::yarn_names() {
        let yarn = presets::yarn(name).unwrap();
        let table = bake_self_shadow(&yarn, SelfShadowSize::default());
        let error = error_of(&table, &yarn);
        assert!(error.within(&SELF_SHADOW_LIMIT), "{name}: {error:?}");
    }
}

/// A device's filter may have as few as 8 bits for each weight.
#[test]
fn coarse_weights_of_a_filter_keep_the_limits() {
    for name in presets::yarn_names() {
        let yarn = presets::yarn(name).unwrap();
        let table = bake_self_shadow(&yarn, SelfShadowSize::default());
        let section = CrossSection::new(&yarn);
        let size = DVec3::from_array(table.size.extent().map(f64::from));
        let read = |(position, toward): (DVec2, DVec2)| {
            let place = self_shadow_place(position, toward, yarn.ply_count, table.size);
            let coarse = (((place * size - 0.5) * 256.0).round() / 256.0 + 0.5) / size;
            let exact = exact_self_shadow_depth(&section, position, toward);
            [self_shadow_depth(&table, coarse), self_shadow_depth(&table, place), exact]
        };
        let reads: Vec<[f64; 3]> = places(20_000).map(read).collect();
        let error = |other: usize| {
            TableError::new(&reads.iter().map(|r| (r[0], r[other])).collect::<Vec<_>>(), table.largest())
        };
        assert!(error(2).within(&SELF_SHADOW_LIMIT), "{name}: {:?}", error(2));
        assert!(error(1).worst <= 2e-3, "{name}: {:?}", error(1));
    }
}

#[test]
fn extreme_yarns_give_finite_depths() {
    let some = yarn_of(8);
    let wide = YarnParams { ellipse_long_mm: 1e6, ellipse_short_mm: 1001.0, ..some.clone() };
    let tall =
        YarnParams { ellipse_long_mm: 1e-3, ellipse_short_mm: 0.5, yarn_radius_mm: 0.9, ..some.clone() };
    let far = YarnParams { yarn_radius_mm: 798.0, density_beta: 20.0, density_epsilon: 0.0, ..some.clone() };
    let flat = YarnParams { yarn_radius_mm: 0.0, density_beta: 0.0, density_epsilon: 0.5, ..some };
    for yarn in [wide, tall, far, flat] {
        assert_eq!(yarn.validate(), Ok(()));
        let table = bake_self_shadow(&yarn, SelfShadowSize { across: 33, slices: 5 });
        // Eight plies on top of each other, as dense as can be.
        assert!(table.depths.iter().all(|depth| (0.0..=16.1).contains(&f64::from(*depth))), "{yarn:?}");
        let chords = bake_chord_shadow(&yarn);
        assert!(chords.rests.iter().all(|rest| (0.0..=2.001).contains(&f64::from(*rest))), "{yarn:?}");
        let occlusion = bake_occlusion_table(&yarn, extinction_per_mm(&yarn), 9);
        assert!(occlusion.visibilities.iter().all(|v| (0.0..=1.0).contains(&f64::from(*v))), "{yarn:?}");
    }
}

#[test]
fn finer_tables_are_closer() {
    let yarn = presets::yarn("silk2").unwrap();
    let error =
        |(across, slices)| error_of(&bake_self_shadow(&yarn, SelfShadowSize { across, slices }), &yarn);
    let errors = [(32, 8), (64, 16), (128, 32), (256, 64)].map(error);
    for pair in errors.windows(2) {
        assert!(pair[1].rms < 0.6 * pair[0].rms && pair[1].worst < pair[0].worst, "{errors:?}");
    }
}

#[test]
fn wrong_tables_are_refused() {
    let yarn = yarn_of(3);
    let right = bake_self_shadow(&yarn, SelfShadowSize::default());
    assert!(error_of(&right, &yarn).within(&SELF_SHADOW_LIMIT));
    let mut backward = right.clone();
    backward.depths.chunks_exact_mut(right.size.across as usize).for_each(<[f16]>::reverse);
    let mut sideways = right.clone();
    let slice = (right.size.across * right.size.across) as usize;
    for slice in sideways.depths.chunks_exact_mut(slice) {
        slice.reverse();
        slice.chunks_exact_mut(right.size.across as usize).for_each(<[f16]>::reverse);
    }
    let mut turned = right.clone();
    turned.depths.rotate_left(slice);
    let other = bake_self_shadow(&presets::yarn("cotton1").unwrap(), right.size);
    for (what, wrong) in
        [("backward", backward), ("sideways", sideways), ("turned", turned), ("other", other)]
    {
        let error = error_of(&wrong, &yarn);
        assert!(!error.within(&SELF_SHADOW_LIMIT), "{what}: {error:?}");
    }
}

#[test]
fn a_turn_by_one_ply_changes_nothing() {
    for ply_count in [1, 2, 3, 4, 8] {
        let yarn = yarn_of(ply_count);
        let extinction = extinction_per_mm(&yarn) * yarn.outer_radius_mm();
        let table = bake_self_shadow(&yarn, SelfShadowSize::default());
        // A fiber and light that stay in the world as the yarn turns.
        let factor = |position: DVec2, light: DVec2, phase: f64| {
            let from_world = DVec2::from_angle(-phase);
            let place = self_shadow_place(
                from_world.rotate(position),
                from_world.rotate(light),
                ply_count,
                table.size,
            );
            self_shadow_light(self_shadow_depth(&table, place), extinction, light.length())
        };
        for (position, light) in places(2000) {
            let light = 0.9 * light;
            let phase = 0.37 + position.x;
            let (before, after) =
                (factor(position, light, phase), factor(position, light, phase + TAU / f64::from(ply_count)));
            assert!((before - after).abs() < 1e-9, "{ply_count} plies: {before} and {after}");
        }
    }
}

/// The largest change of the depth from one step of the light's angle to the next, all the way round, over the
/// table's range.
fn largest_step(table: &SelfShadowTable, place: impl Fn(DVec2, DVec2) -> DVec3) -> f64 {
    const STEPS: u32 = 7200;
    let at = |position, step: u32| {
        let light = DVec2::from_angle(TAU * (f64::from(step) + 0.5) / f64::from(STEPS));
        self_shadow_depth(table, place(position, light))
    };
    let steps = |position| {
        let step = move |i| (at(position, i) - at(position, (i + 1) % STEPS)).abs();
        (0..STEPS).map(step).fold(0.0, f64::max)
    };
    places(40).map(|(position, _)| steps(position)).fold(0.0, f64::max) / table.largest()
}

/// One twentieth of a degree moves a place by a twentieth of a texel, and slices of 8 plies by less than a tenth.
const LARGEST_STEP: f64 = 0.015;

#[test]
fn the_depth_is_continuous_all_the_way_round() {
    for ply_count in [1, 2, 3, 4, 8] {
        let table = bake_self_shadow(&yarn_of(ply_count), SelfShadowSize::default());
        let step = largest_step(&table, |p, light| self_shadow_place(p, light, ply_count, table.size));
        assert!(step <= LARGEST_STEP, "{ply_count} plies: {step}");
        // Slices read without folding, as if they went once round and began again.
        let wrong = largest_step(&table, |p, light| {
            let z = angle_of(light.y, light.x).rem_euclid(TAU / f64::from(ply_count)) * f64::from(ply_count)
                / TAU;
            self_shadow_place(p, light, ply_count, table.size).with_z(node_coordinate(z, table.size.slices))
        });
        assert!(wrong > 3.0 * LARGEST_STEP, "{ply_count} plies: a wrong wrap passes with {wrong}");
    }
}

#[test]
fn outside_of_the_circle_light_has_met_nothing_or_all() {
    let yarn = yarn_of(3);
    let table = bake_self_shadow(&yarn, SelfShadowSize::default());
    let section = CrossSection::new(&yarn);
    let depth =
        |p: DVec2, light: DVec2| self_shadow_depth(&table, self_shadow_place(p, light, 3, table.size));
    for (_, light) in places(100) {
        for across in [-0.9, -0.2, 0.0, 0.5] {
            let side = across * light.perp();
            assert_eq!(depth(side + 1.5 * light, light), 0.0);
            let all = exact_self_shadow_depth(&section, side - 3.0 * light, light);
            assert!(
                (depth(side - 1.01 * light, light) / table.largest() - all / table.largest()).abs() < 0.05
            );
            let (just, far) = (depth(side - 1.01 * light, light), depth(side - 100.0 * light, light));
            assert!((just - far).abs() < 1e-9, "{just} and {far}");
        }
        assert_eq!(depth(1.01 * light.perp(), light), 0.0);
        assert_eq!(depth(-1.01 * light.perp() - light, light), 0.0);
    }
}

#[test]
fn one_slice_is_enough_for_a_round_ply_alone() {
    let yarn = YarnParams { yarn_radius_mm: 0.0, ellipse_long_mm: 0.4, ellipse_short_mm: 0.4, ..yarn_of(1) };
    let one = bake_self_shadow(&yarn, SelfShadowSize { across: 128, slices: 1 });
    assert!(error_of(&one, &yarn).within(&SELF_SHADOW_LIMIT));
    assert_eq!(bake_self_shadow(&yarn, SelfShadowSize { across: 0, slices: 0 }).depths.len(), 4);
}

#[test]
fn light_falls_to_nothing_along_the_yarn_without_a_jump() {
    for depth in [0.0, 1e-3, 0.1, 2.0] {
        let light = |sin: f64| self_shadow_light(depth, 7.0, sin);
        assert_eq!(light(0.0), 0.0);
        assert_eq!(light(1.0), (-7.0 * depth).exp());
        let step = (0..1000).map(|i| (light(f64::from(i) * 1e-3) - light(f64::from(i + 1) * 1e-3)).abs());
        assert!(step.fold(0.0, f64::max) <= 1e-3 / SELF_SHADOW_LEAST_SIN + 1e-12, "depth {depth}");
        assert!(
            (0..1000).all(|i| light(f64::from(i) * 1e-3) <= light(f64::from(i + 1) * 1e-3)),
            "depth {depth}"
        );
    }
    assert_eq!(self_shadow_stretch(0.0), 8.0);
    assert_eq!(self_shadow_stretch(0.5), 2.0);
}
