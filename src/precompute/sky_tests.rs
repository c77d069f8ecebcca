use super::*;
use crate::math::curve::Curve;
use crate::yarn::presets;
use crate::yarn::strand::strands;

const RADIUS: f64 = 0.5;

/// Straight yarns along X at these places across, side by side.
fn yarns_at(places: &[[f64; 2]]) -> Strands {
    let line = |[y, z]: &[f64; 2]| Curve {
        points: (-100..=100).map(|i| DVec3::new(0.3 * f64::from(i), *y, *z)).collect(),
        closed: false,
    };
    let curves: Vec<Curve> = places.iter().map(line).collect();
    strands(&curves, Basis::CatmullRom, &presets::yarn("cotton1").unwrap(), 1)
}

fn skies(strands: &Strands) -> Vec<[f64; 4]> {
    let yarns = SkyYarns { strands, hiding_radius_mm: RADIUS, outer_radius_mm: RADIUS };
    let baked = bake_skies(&[yarns]).remove(0);
    assert_eq!(baked.len(), strands.points.len());
    baked.into_iter().map(|sky| sky.map(f64::from)).collect()
}

/// That of the control point nearest to a place.
fn at(strands: &Strands, place: DVec3) -> DVec4 {
    let distance = |i: &usize| (strands.points[*i] - place).length();
    let nearest = (0..strands.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    DVec4::from_array(skies(strands)[nearest.unwrap()])
}

#[test]
fn a_yarn_alone_has_all_of_the_sky() {
    let alone = yarns_at(&[[0.0, 0.0]]);
    // But for its own far ends, where a look along it meets them.
    for sky in skies(&alone) {
        assert!(sky[0] > 0.95 && DVec3::new(sky[1], sky[2], sky[3]).length() < 0.2, "{sky:?}");
    }
}

#[test]
fn a_yarn_on_a_sheet_of_yarns_sees_the_half_above_it() {
    let sheet: Vec<[f64; 2]> = (-60..=60).map(|i| [f64::from(i), -1.0]).collect();
    let places = [&[[0.0, 0.0]][..], &sheet].concat();
    let sky = at(&yarns_at(&places), DVec3::ZERO);
    assert!((sky.x - 0.5).abs() < 0.06, "{sky}");
    assert!((sky.w - 0.75).abs() < 0.1 && sky.y.abs() < 0.1 && sky.z.abs() < 0.1, "{sky}");
    assert!(sky_toward(sky, DVec3::Z) > 0.95 && sky_toward(sky, DVec3::NEG_Z) < 0.05);
}

#[test]
fn what_one_yarn_beside_another_hides_is_the_angle_it_spans() {
    for distance in [1.0, 2.0, 5.0] {
        let sky = at(&yarns_at(&[[0.0, 0.0], [0.0, -distance]]), DVec3::ZERO);
        // A long tube hides the directions whose angle about its axis is within asin(radius / distance).
        let hidden = (RADIUS / distance).asin() / PI;
        assert!((1.0 - sky.x - hidden).abs() < 0.07, "{distance}: {sky}, hidden {hidden}");
        assert!(sky_toward(sky, DVec3::Z) > sky_toward(sky, DVec3::NEG_Z), "{distance}: {sky}");
    }
}

#[test]
fn yarns_of_another_fabric_hide_as_well_and_those_within_one_another_do_not() {
    let (below, above) = (yarns_at(&[[0.0, 0.0]]), yarns_at(&[[0.0, 1.0], [0.5, 1.0], [-0.5, 1.0]]));
    let yarns = |strands, radius| SkyYarns { strands, hiding_radius_mm: radius, outer_radius_mm: RADIUS };
    let middle = below.points.len() / 2;
    let up = |skies: Vec<Vec<[f16; 4]>>| f64::from(skies[0][middle][3]);
    assert!(up(bake_skies(&[yarns(&below, RADIUS), yarns(&above, RADIUS)])) < -0.2);
    assert!(up(bake_skies(&[yarns(&below, RADIUS), yarns(&above, 0.0)])).abs() < 0.1);
    let within = bake_skies(&[yarns(&below, 2.0), yarns(&above, 2.0)]);
    assert!(f64::from(within[0][middle][0]) > 0.1, "{:?}", within[0][middle]);
}

#[test]
fn closed_curves_know_their_own_ends_and_no_yarn_is_no_special_case() {
    let turn = |i: i32| f64::from(i) / 64.0 * 2.0 * PI;
    let ring = Curve {
        points: (0..64).map(|i| 6.0 * DVec3::new(turn(i).cos(), turn(i).sin(), 0.0)).collect(),
        closed: true,
    };
    let ring = strands(&[ring], Basis::CatmullRom, &presets::yarn("cotton1").unwrap(), 1);
    let open: Vec<f64> = skies(&ring).into_iter().map(|sky| sky[0]).collect();
    let (least, most) = open.iter().fold((1f64, 0f64), |(low, high), v| (low.min(*v), high.max(*v)));
    assert!(least > 0.85 && most - least < 0.12, "{least} to {most}");
    assert!(bake_skies(&[]).is_empty());
    let yarns = SkyYarns { strands: &yarns_at(&[]), hiding_radius_mm: 0.5, outer_radius_mm: 0.5 };
    assert!(bake_skies(&[yarns])[0].is_empty());
}

#[test]
fn places_between_those_looked_from_have_skies_between_theirs() {
    let (below, above) = (yarns_at(&[[0.0, 0.0], [5.0, 0.0]]), yarns_at(&[[0.0, 1.0]]));
    let yarns = |strands| SkyYarns { strands, hiding_radius_mm: RADIUS, outer_radius_mm: RADIUS };
    let both = [yarns(&below), yarns(&above)];
    let places = places(0, &both[0]);
    let looked = looked_from(&places, 1.0);
    assert!(looked.len() < places.len() / 2 && looked.len() > places.len() / 6, "{}", looked.len());
    for pair in looked.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
        let (from, to) = (&places[pair[0]], &places[pair[1]]);
        assert!(from.curve == to.curve && to.length_mm - from.length_mm <= 1.0 + 1e-9, "{from:?} {to:?}");
    }
    let tubes = Tubes::new(&both, DETAIL.part).unwrap();
    let directions: Vec<DVec3> = (0..DIRECTIONS).map(|i| direction(i, DIRECTIONS)).collect();
    let skies: Vec<DVec4> = looked.iter().map(|&at| tubes.sky(&places[at], &directions)).collect();
    for (place, found) in places.iter().zip(between(&places, &looked, &skies)) {
        assert!((found - tubes.sky(place, &directions)).abs().max_element() < 0.12, "{place:?}");
    }
}

/// Root mean square and largest difference of two bakes, over the constant and the slope's parts.
fn difference(a: &[[f16; 4]], b: &[[f16; 4]]) -> [f64; 2] {
    let apart = |(a, b): (&[f16; 4], &[f16; 4])| {
        std::array::from_fn::<f64, 4, _>(|i| f64::from(a[i]) - f64::from(b[i]))
    };
    let all: Vec<f64> = a.iter().zip(b).flat_map(apart).collect();
    let squares: f64 = all.iter().map(|d| d * d).sum();
    [(squares / all.len() as f64).sqrt(), all.iter().fold(0.0, |most, d| most.max(d.abs()))]
}

/// What lies between two places along the yarn is worth no look: few directions err by more, and a line between two
/// looks evens out what they err by.
#[test]
fn yarns_are_looked_at_as_closely_as_the_directions_are_worth() {
    let yarn = presets::yarn("worsted_3ply").unwrap();
    let diameter = 2.0 * yarn.outer_radius_mm();
    // Loops through loops (64 points to each), as in stockinette.
    let course = |course: i32| Curve {
        points: (0..=6 * 64)
            .map(|i| {
                let u = f64::from(i) / 64.0 * 2.0 * PI;
                let x = 4.2 * (u / (2.0 * PI)) + 0.9 * (2.0 * u).sin();
                diameter * DVec3::new(x, 2.9 * f64::from(course) + 2.2 * u.cos(), 0.5 * (2.0 * u).cos())
            })
            .collect(),
        closed: false,
    };
    let curves: Vec<Curve> = (0..5).map(course).collect();
    let strands = strands(&curves, Basis::CatmullRom, &yarn, 1);
    let radius = yarn.outer_radius_mm();
    let yarns = [SkyYarns { strands: &strands, hiding_radius_mm: 0.8 * radius, outer_radius_mm: radius }];
    let of = |detail, directions| baked(&yarns, detail, directions).remove(0);
    let finest = Detail { apart: 0.0, part: 0.0 };
    let truth = of(finest, 640);
    let error = |detail| difference(&truth, &of(detail, DIRECTIONS))[0];
    let [chosen, finest, wide] = [DETAIL, finest, Detail { apart: 24.0, ..DETAIL }].map(error);
    println!("{chosen:.4} as chosen, {finest:.4} from everywhere, {wide:.4} from far between");
    assert!(chosen < 1.1 * finest && wide > 1.3 * finest, "{chosen} {finest} {wide}");
}

/// Periods of very long open yarn wrap as those of closed yarn do: it is not closed by that.
#[test]
fn the_ends_of_open_yarn_hide_each_other_however_long_its_fibers_migrate() {
    let out = (0..=40).map(|i| DVec3::new(0.5 * f64::from(i), 0.0, 0.0));
    let back = (0..=40).rev().map(|i| DVec3::new(0.5 * f64::from(i), 0.0, 1.2));
    let curve = Curve { points: out.chain(back).collect(), closed: false };
    let usual = presets::yarn("cotton1").unwrap();
    let mut migrating = usual.clone();
    (migrating.fiber_pitch_mm, migrating.migration_rate) = (Some(1e-6), 1.0);
    let baked = |yarn| strands(std::slice::from_ref(&curve), Basis::CatmullRom, yarn, 1);
    let (usual, migrating) = (baked(&usual), baked(&migrating));
    assert!(usual.period_counts == [0] && migrating.period_counts != [0]);
    assert_eq!(skies(&usual), skies(&migrating));
}

#[test]
fn points_on_top_of_each_other_give_numbers() {
    let curve = Curve { points: vec![DVec3::ONE; 3000], closed: false };
    let other = Curve { points: vec![DVec3::ZERO, DVec3::X, 1e6 * DVec3::X, 1e-6 * DVec3::X], closed: false };
    let strands = strands(&[curve, other], Basis::CatmullRom, &presets::yarn("cotton1").unwrap(), 1);
    assert!(skies(&strands).iter().flatten().all(|v| v.is_finite()));
}

#[test]
fn a_fiber_at_the_rim_gathers_from_the_viewers_side() {
    let sky = DVec4::new(0.5, 0.0, 0.0, 0.75);
    let deep = sky_toward(sky, sky_gathered(DVec3::Z, DVec3::ZERO));
    let rim = sky_toward(sky, sky_gathered(DVec3::Z, DVec3::Z));
    let hidden = sky_toward(sky, sky_gathered(DVec3::Z, DVec3::NEG_Z));
    assert!((deep - 0.75).abs() < 1e-12 && (rim - 1.0).abs() < 1e-12 && (hidden - 0.5).abs() < 1e-12);
}
