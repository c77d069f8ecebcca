use super::*;

fn at(xs: &[f64]) -> Vec<DVec3> {
    xs.iter().map(|&x| DVec3::new(x, 0.0, 0.0)).collect()
}

fn ring(n: usize) -> Vec<DVec3> {
    let step = std::f64::consts::TAU / n as f64;
    (0..n).map(|i| DVec3::new((i as f64 * step).cos(), (i as f64 * step).sin(), 0.0)).collect()
}

fn repaired(basis: Basis, curves: Vec<(Vec<DVec3>, bool)>) -> Repaired {
    let curves = curves.into_iter().map(|(points, closed)| Curve { points, closed }).collect();
    repair_curves(CurveSet { basis, up_axis: None, curves })
}

fn kinds(r: &Repaired) -> Vec<RepairKind> {
    r.repairs.iter().map(|r| r.kind).collect()
}

#[test]
fn sound_curves_come_through_untouched() {
    let handles = at(&[0.0, 0.0, 1.0, 1.0]);
    for (basis, curves) in [
        (Basis::CatmullRom, vec![(ring(20), true), (at(&[0.0, 1.0]), false), (ring(3), true)]),
        // Handles on their knots are a straight piece, not a duplicate.
        (Basis::Bezier, vec![(handles, false), (ring(9), true)]),
    ] {
        let r = repaired(basis, curves.clone());
        assert!(r.repairs.is_empty() && r.kept_points.is_none(), "{:?}", r.repairs);
        assert!(r.curves.curves.iter().zip(&curves).all(|(a, b)| (&a.points, a.closed) == (&b.0, b.1)));
    }
}

#[test]
fn duplicates_and_the_repeated_end_go_and_the_kept_points_are_known() {
    let mut points = ring(12);
    points.insert(4, points[3]);
    points.insert(4, points[3] + DVec3::splat(1e-9));
    points.push(points[0]);
    let r = repaired(Basis::CatmullRom, vec![(at(&[0.0, 1.0, 1.0]), false), (points, true)]);
    let merged = |points| RepairKind::DuplicatesMerged { points };
    assert_eq!(kinds(&r), [merged(1), merged(2), RepairKind::RepeatedEndDropped]);
    assert_eq!(r.curves.curves[1].points, ring(12));
    let kept: Vec<usize> = [0, 1].into_iter().chain(3..7).chain(9..17).collect();
    assert_eq!(r.kept_points.unwrap(), kept);
    let lines = summarize_repairs(&r.repairs);
    assert_eq!(lines[0], "3 zero-length segments merged in 2 curves");
    assert_eq!(lines[1], "1 loop with the first point repeated as last: last dropped");
}

#[test]
fn one_wild_jump_does_not_merge_everything_else() {
    let r = repaired(Basis::Polyline, vec![(at(&[0.0, 0.1, 0.2, 0.3, 1e9]), false)]);
    assert!(r.repairs.is_empty());
}

#[test]
fn wide_loops_open_and_tight_ones_do_not() {
    let row: Vec<f64> = (0..150).map(|i| i as f64 * 0.25).collect();
    let r = repaired(Basis::BSpline, vec![(at(&row), true), (ring(40), true), (at(&row[..11]), true)]);
    assert_eq!(kinds(&r), [RepairKind::LoopOpened { gap: 37.25, mean_segment: 0.25 }]);
    assert_eq!((r.curves.curves[0].closed, r.curves.curves[0].points.len()), (false, 150));
    assert!(r.curves.curves[1].closed && r.curves.curves[2].closed && r.kept_points.is_none());
    assert_eq!(summarize_repairs(&r.repairs), ["1 loop opened: gap 37.250 = 149 mean segments"]);
    assert_eq!(r.repairs[0].to_string(), "curve 0: loop opened: gap 37.250 = 149 mean segments");
}

#[test]
fn bezier_pieces_go_as_a_whole() {
    // Closed with the first point repeated; the second of three pieces is collapsed.
    let xs = [0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0, 2.0, 1.0, 0.0];
    let r = repaired(Basis::Bezier, vec![(at(&xs), true)]);
    assert_eq!(kinds(&r), [RepairKind::DuplicatesMerged { points: 3 }, RepairKind::RepeatedEndDropped]);
    assert_eq!(r.curves.curves[0].points, at(&[0.0, 1.0, 2.0, 3.0, 2.0, 1.0]));
    // The closing piece of an opened loop takes its handles with it.
    let row: Vec<f64> = (0..60).map(f64::from).collect();
    let r = repaired(Basis::Bezier, vec![(at(&row), true)]);
    assert_eq!((r.curves.curves[0].closed, r.curves.curves[0].points.len()), (false, 58));
    // All pieces collapsed: nothing is left.
    let r = repaired(Basis::Bezier, vec![(at(&[2.0; 6]), true), (at(&[2.0; 4]), false)]);
    assert!(r.curves.curves.is_empty() && r.repairs.len() == 2);
}

#[test]
fn curves_too_short_are_dropped_with_a_record() {
    let short = vec![
        (vec![], false),
        (at(&[1.0]), true),
        (at(&[1.0, 1.0, 1.0]), false),
        (at(&[0.0, 1.0]), true),
        (at(&[0.0, 1.0, 0.0]), true),
        (at(&[0.0, 1.0]), false),
    ];
    let r = repaired(Basis::CatmullRom, short);
    let dropped: Vec<usize> = r.repairs.iter().map(|r| r.curve).collect();
    assert_eq!((dropped, r.curves.curves.len()), (vec![0, 1, 2, 3, 4], 1));
    assert!(r.repairs.iter().all(|r| matches!(r.kind, RepairKind::CurveDropped { .. })));
    assert_eq!(r.kept_points, Some(vec![9, 10]));
    assert_eq!(summarize_repairs(&r.repairs), ["5 curves too short to draw dropped"]);
}
