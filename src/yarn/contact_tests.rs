use super::*;

fn open(points: impl IntoIterator<Item = DVec3>) -> Curve {
    Curve { points: points.into_iter().collect(), closed: false }
}

fn assert_near(found: Option<f64>, expected: f64, relative: f64) {
    let found = found.expect("strands touch");
    assert!((found / expected - 1.0).abs() < relative, "found {found}, expected {expected}");
}

/// A plane of straight yarns `spacing` apart, each of `points` points over a length of 10.
fn rods(count: usize, spacing: f64, points: usize) -> Vec<Curve> {
    let x = |i: usize| 10.0 * i as f64 / (points - 1) as f64;
    let rod = |k: usize| open((0..points).map(|i| DVec3::new(x(i), k as f64 * spacing, 0.3)));
    (0..count).map(rod).collect()
}

#[test]
fn parallel_rods_are_half_their_spacing_thick() {
    for basis in [Basis::CatmullRom, Basis::BSpline, Basis::Polyline] {
        assert_near(estimate_contact_radius(&rods(8, 0.35, 40), basis), 0.175, 1e-3);
    }
    assert_near(estimate_contact_radius(&rods(20, 0.2, 2), Basis::Polyline), 0.1, 1e-3);
    assert_near(estimate_contact_radius(&rods(20, 0.2, 4_000), Basis::Polyline), 0.1, 1e-3);
    // Far thinner than the finest links: found all the same, without cutting them finer still.
    assert_near(estimate_contact_radius(&rods(2, 5e-6, 2), Basis::Polyline), 2.5e-6, 1e-3);
    assert_near(estimate_contact_radius(&rods(10, 0.2, 61), Basis::Bezier), 0.1, 1e-3);
}

/// Plain weave of round yarns, radius 0.1: at each crossing the centre lines are 0.2 apart.
fn weave(scale: f64) -> Vec<Curve> {
    let (n, pitch, amplitude) = (12, 0.5, 0.1);
    let at = |k: usize, i: usize, over: f64| {
        let along = i as f64 * pitch / 8.0;
        let height = over * amplitude * (std::f64::consts::PI * (along / pitch + k as f64)).cos();
        (along, k as f64 * pitch, height)
    };
    let warp = (0..n)
        .map(|k| open((0..=8 * (n - 1)).map(|i| at(k, i, 1.0)).map(|(a, b, h)| scale * DVec3::new(a, b, h))));
    let weft = (0..n).map(|k| {
        open((0..=8 * (n - 1)).map(|i| at(k, i, -1.0)).map(|(a, b, h)| scale * DVec3::new(b, a, h)))
    });
    warp.chain(weft).collect()
}

#[test]
fn weave_is_as_thick_as_its_yarn_at_every_scale() {
    for scale in [1e-6, 1.0, 1e9] {
        assert_near(estimate_contact_radius(&weave(scale), Basis::CatmullRom), 0.1 * scale, 0.03);
    }
}

/// A coil touches itself: the turns of one strand, `pitch` apart, are found though no other strand is.
#[test]
fn one_strand_may_touch_itself() {
    let (pitch, radius) = (0.3, 1.0);
    let coil = open((0..1_000).map(|i| {
        let turns = i as f64 / 40.0;
        let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
        DVec3::new(radius * cos, radius * sin, pitch * turns)
    }));
    assert_near(estimate_contact_radius(&[coil], Basis::CatmullRom), 0.15, 0.01);
}

#[test]
fn strands_that_never_meet_give_nothing() {
    let lone = rods(1, 1.0, 100);
    assert_eq!(estimate_contact_radius(&lone, Basis::CatmullRom), None);
    let ring = |i: usize| DVec3::new((i as f64 / 8.0).cos(), (i as f64 / 8.0).sin(), 0.0);
    let ring = Curve { points: (0..50).map(ring).collect(), closed: true };
    assert_eq!(estimate_contact_radius(&[ring], Basis::CatmullRom), None);
    assert_eq!(estimate_contact_radius(&rods(2, 50.0, 100), Basis::CatmullRom), None);
    // Two yarns through the same points cross; they do not touch.
    let cross = [open([-DVec3::X, DVec3::X]), open([-DVec3::Y, DVec3::Y])];
    assert_eq!(estimate_contact_radius(&cross, Basis::Polyline), None);
}

#[test]
fn garbage_gives_an_answer_in_bounded_time() {
    for basis in [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline] {
        for closed in [false, true] {
            for n in 0..6 {
                let short = Curve { points: vec![DVec3::ONE; n], closed };
                assert_eq!(estimate_contact_radius(&[short], basis), None);
            }
            let wild = [f64::NAN, f64::INFINITY, 1e300, -1e15, 0.0, 1.0];
            let wild = Curve { points: wild.iter().map(|&x| DVec3::new(x, 1.0, x)).collect(), closed };
            assert_eq!(estimate_contact_radius(&[wild], basis), None);
        }
    }
    // A knot of noise with one far outlier: everything falls into one cell.
    let mut rng = crate::math::rng::Rng::new(3, &[]);
    let mut noise = || DVec3::new(rng.uniform(), rng.uniform(), rng.uniform()) * 1e-3;
    let mut points: Vec<DVec3> = (0..50_000).map(|_| noise()).collect();
    points.push(DVec3::splat(1e15));
    let start = std::time::Instant::now();
    let _ = estimate_contact_radius(&[open(points)], Basis::CatmullRom);
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}
