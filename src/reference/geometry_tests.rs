use super::*;

/// A circle of circumference 100 mm in 100 pieces of 1 mm, or a straight line of as many.
fn fiber(closed: bool) -> RealisedFiber {
    let radius = 0.5 / (std::f64::consts::PI / 100.0).sin();
    let at = |k: u32| {
        let (s, c) = (std::f64::consts::TAU * f64::from(k) / 100.0).sin_cos();
        (radius * DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0))
    };
    let line = |k: u32| (DVec3::X * f64::from(k), DVec3::X);
    let points: Vec<_> = if closed { (0..100).map(at).collect() } else { (0..=100).map(line).collect() };
    RealisedFiber {
        closed,
        radii_mm: vec![0.1; points.len()],
        points: points.iter().map(|p| p.0).collect(),
        tangents: points.iter().map(|p| p.1).collect(),
        ..Default::default()
    }
}

#[test]
fn the_part_around_a_place_has_the_asked_length_across_the_closing_point_too() {
    let geometry = FiberGeometry::<f64>::new(vec![fiber(false), fiber(true)], DVec3::ZERO);
    assert_eq!((geometry.run_count(), geometry.piece_count()), (2, 200));
    assert_eq!(geometry.pieces().count(), 200);
    // The closed one's points begin at 101 and end, closed, at 201.
    let held = |point: u32, share: f64, distance: f64| {
        let ignored = geometry.around(Place { point, share }, distance);
        let numbers = (0..20_200).map(|k| f64::from(k) / 100.0 + 0.005);
        let held: Vec<f64> = numbers
            .filter(|n| n.floor() != 100.0)
            .filter(|n| ignored.holds(Place { point: *n as u32, share: n.fract() }))
            .collect();
        (held.len() as f64 / 100.0, held[0], held[held.len() - 1])
    };
    let near = |found: (f64, f64, f64), expected: (f64, f64, f64)| {
        let off = [found.0 - expected.0, found.1 - expected.1, found.2 - expected.2];
        assert!(off.iter().all(|d| d.abs() < 0.02), "{found:?}, expected {expected:?}");
    };
    near(held(50, 0.3, 0.2), (0.4, 50.1, 50.5));
    near(held(50, 0.3, 2.5), (5.0, 47.8, 52.8));
    near(held(0, 0.5, 2.0), (2.5, 0.0, 2.5));
    near(held(99, 0.5, 2.0), (2.5, 97.5, 100.0));
    near(held(102, 0.5, 4.0), (8.0, 101.0, 201.0));
    near(held(199, 0.5, 4.0), (8.0, 101.0, 201.0));
}

#[test]
fn normals_are_round_and_directions_have_no_corners() {
    let geometry = FiberGeometry::<f64>::new(vec![fiber(true)], DVec3::ZERO);
    let up = DVec3::Z;
    let mut last = None::<DVec3>;
    for k in 0..1000 {
        let (s, c) = (std::f64::consts::TAU * f64::from(k) / 1000.0).sin_cos();
        let axis = DVec3::new(c, s, 0.0) * 15.91;
        let (point, share) = ((k / 10) as u32, f64::from(k % 10) / 10.0);
        let (t, place) = geometry.enter(point, axis + 5.0 * up, -up).unwrap();
        assert!((t - 4.9).abs() < 0.01 && (place.share - share).abs() < 0.02, "{k}: {t} {place:?}");
        let surface = geometry.surface(place, axis + (5.0 - t) * up);
        assert!(surface.normal.dot(up) > 0.9 && surface.normal.dot(surface.tangent).abs() < 1e-12);
        let exact = DVec3::new(-s, c, 0.0);
        assert!(surface.tangent.cross(exact).length() < 1e-3, "{k}");
        if let Some(last) = last {
            // A thousandth of a turn, and no more anywhere.
            assert!(last.cross(surface.tangent).length() < 1.2 * std::f64::consts::TAU / 1000.0);
        }
        last = Some(surface.tangent);
    }
}
