//! The generated swatch, judged by the checkers, and the checkers, by broken swatches.

use glam::DVec3;

use super::clearance::{min_clearance, min_curvature_radius};
use super::interlock::{check_interlock, crossings_along_z};
use super::layout::Layout;
use super::params::KnitParams;
use super::stockinette::{KEPT_DISTANCE, stockinette};
use crate::io::curves::CurveSet;
use crate::math::curve::bezier_from_basis;
use crate::yarn::turning::turning_of;

fn params(courses: u32, wales: u32, yarn_radius_mm: f64, gauge: [f64; 2], points: u32) -> KnitParams {
    KnitParams {
        courses,
        wales,
        yarn_radius_mm,
        wale_spacing_mm: Some(gauge[0] * 2.0 * yarn_radius_mm),
        course_spacing_mm: Some(gauge[1] * 2.0 * yarn_radius_mm),
        points_per_loop: points,
    }
}

/// Everything that a sound swatch has; the first thing that is wrong otherwise.
fn judge(p: &KnitParams, swatch: &CurveSet) -> Result<f64, String> {
    check_interlock(swatch, &Layout::new(p)).map_err(|e| e.to_string())?;
    let clearance = min_clearance(swatch, p.arc_skip_mm()).ok_or("no strands")?;
    let relative = clearance.distance / (2.0 * p.yarn_radius_mm);
    if relative < KEPT_DISTANCE {
        return Err(format!("clearance {relative:.4}: {clearance:?}"));
    }
    let radius = min_curvature_radius(swatch).ok_or("nothing bends")? / p.yarn_radius_mm;
    if radius < 1.1 {
        return Err(format!("curvature radius {radius:.3} yarn radii"));
    }
    Ok(relative)
}

#[test]
fn swatches_across_the_allowed_range_are_sound() {
    let mut cases = Vec::new();
    for wale in [4.15, 4.2, 4.6, 5.4, 6.5] {
        for course in [2.2, 2.5, 2.9, 3.4, 4.5] {
            for points in [16, 24] {
                cases.push(params(4, 3, 0.75, [wale, course], points));
            }
        }
    }
    cases.push(params(5, 2, 0.1, [4.3, 2.7], 20));
    cases.push(params(2, 5, 40.0, [4.15, 3.1], 32));
    cases.push(params(3, 3, 0.75, [4.15, 2.9], 64));
    let mut faults = Vec::new();
    for p in &cases {
        let verdict = stockinette(p).map_err(|e| e.to_string()).and_then(|swatch| judge(p, &swatch));
        // Tight cloth: somewhere strands touch.
        match verdict {
            Ok(relative) if relative < 1.01 => {}
            other => faults.push(format!("{p:?}: {other:?}")),
        }
    }
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), cases.len(), faults.join("\n"));
}

#[test]
fn swatches_of_every_small_size_are_sound() {
    for courses in 1..=3 {
        for wales in 1..=3 {
            let p = KnitParams { courses, wales, ..KnitParams::swatch() };
            let swatch = stockinette(&p).unwrap();
            assert_eq!(swatch.point_count() as u64, Layout::new(&p).point_count());
            if courses * wales > 1 {
                judge(&p, &swatch).unwrap_or_else(|e| panic!("{courses} x {wales}: {e}"));
            }
            let crossings = crossings_along_z(&swatch).len() as u32;
            assert_eq!(crossings, 4 * (courses - 1) * wales, "{courses} x {wales}");
        }
    }
}

#[test]
fn strands_nearly_touch_wherever_they_cross() {
    let p = KnitParams::swatch();
    let swatch = stockinette(&p).unwrap();
    assert!(judge(&p, &swatch).is_ok());
    for crossing in crossings_along_z(&swatch) {
        let gap = (crossing.over.position.z - crossing.under.position.z) / (2.0 * p.yarn_radius_mm);
        assert!((KEPT_DISTANCE..1.15).contains(&gap), "{gap}: {crossing:?}");
    }
}

#[test]
fn default_lies_centred_with_its_face_to_the_front() {
    let p = KnitParams::swatch();
    let swatch = stockinette(&p).unwrap();
    let points = &swatch.curves[0].points;
    let low = points.iter().fold(DVec3::INFINITY, |m, &q| m.min(q));
    let high = points.iter().fold(DVec3::NEG_INFINITY, |m, &q| m.max(q));
    let [wale_mm, course_mm] = p.spacing_mm();
    assert!((high.y + low.y).abs() < 1e-9 && (high.z + low.z).abs() < 0.1, "{low} {high}");
    assert!((high.x - low.x - f64::from(p.wales) * wale_mm).abs() < wale_mm);
    assert!((high.y - low.y - f64::from(p.courses) * course_mm).abs() < course_mm);
    let longest = points.windows(2).map(|q| q[0].distance(q[1])).fold(0.0, f64::max) / p.yarn_radius_mm;
    let shortest = points.windows(2).map(|q| q[0].distance(q[1])).fold(9.0, f64::min) / p.yarn_radius_mm;
    assert!(longest < 2.5 && shortest > 0.7, "{shortest} to {longest} radii");
    assert_eq!(swatch, stockinette(&p).unwrap());
}

#[test]
fn broken_swatches_are_rejected() {
    let p = params(4, 3, 0.75, [4.15, 2.9], 20);
    let sound = stockinette(&p).unwrap();
    assert!(judge(&p, &sound).is_ok());

    let thick = params(4, 3, 1.5, [4.15, 2.9], 20);
    assert!(judge(&thick, &sound).unwrap_err().contains("clearance"));

    let mut flat = sound.clone();
    flat.curves[0].points.iter_mut().for_each(|q| q.z = 0.0);
    assert!(check_interlock(&flat, &Layout::new(&p)).is_err());
    assert!(min_clearance(&flat, p.arc_skip_mm()).unwrap().distance < 0.01);

    let mut mirrored = sound.clone();
    for (i, q) in mirrored.curves[0].points.iter_mut().enumerate() {
        if Layout::new(&p).place(i as f64).is_some_and(|place| place.course == 2) {
            q.z = -q.z;
        }
    }
    assert!(judge(&p, &mirrored).is_err());
    assert!(check_interlock(&mirrored, &Layout::new(&p)).unwrap_err().to_string().contains("course 2"));

    // One course drawn out to the front: every loop unhooked, every strand clear.
    let mut unhooked = sound.clone();
    for (i, q) in unhooked.curves[0].points.iter_mut().enumerate() {
        if Layout::new(&p).place(i as f64).is_some_and(|place| place.course == 2) {
            q.z += 10.0;
        }
    }
    assert!(check_interlock(&unhooked, &Layout::new(&p)).is_err());

    let mut moved = sound.clone();
    moved.curves[0].points[Layout::new(&p).point_count() as usize / 2].z += 0.4;
    assert!(judge(&p, &moved).is_err());
}

#[test]
fn bad_parameters_are_named_in_one_line() {
    let good = KnitParams::swatch;
    let cases = [
        (KnitParams { courses: 0, ..good() }, "courses: expected at least 1, found 0"),
        (KnitParams { wales: 0, ..good() }, "wales: expected at least 1, found 0"),
        (
            KnitParams { yarn_radius_mm: f64::NAN, ..good() },
            "yarn_radius_mm: expected 0.001 to 1000 mm, found NaN",
        ),
        (
            KnitParams { points_per_loop: 18, ..good() },
            "points_per_loop: expected a multiple of 4 from 16 to 64, found 18",
        ),
        (
            KnitParams { wale_spacing_mm: Some(6.0), ..good() },
            "wale_spacing_mm: expected at least 6.2250 mm for yarn_radius_mm = 0.75, below which strands \
             enter each other, found 6",
        ),
        (
            KnitParams { course_spacing_mm: Some(-1.0), ..good() },
            "course_spacing_mm: expected at least 3.3000 mm for yarn_radius_mm = 0.75, below which strands \
             enter each other, found -1",
        ),
    ];
    for (p, want) in cases {
        let got = stockinette(&p).unwrap_err().to_string();
        assert_eq!(got, want);
    }
    for p in [
        KnitParams { yarn_radius_mm: 0.0, ..good() },
        KnitParams { yarn_radius_mm: f64::INFINITY, ..good() },
        KnitParams { wale_spacing_mm: Some(f64::NAN), ..good() },
        KnitParams { course_spacing_mm: Some(f64::INFINITY), ..good() },
        KnitParams { wale_spacing_mm: Some(100.0), ..good() },
        KnitParams { courses: u32::MAX, wales: u32::MAX, ..good() },
        KnitParams { points_per_loop: u32::MAX, ..good() },
    ] {
        let line = stockinette(&p).unwrap_err().to_string();
        assert!(line.contains("expected") && !line.contains('\n'), "{line}");
    }
}

#[test]
fn fibers_of_knitted_cloth_are_cut_evenly() {
    let mut seen = 0;
    for points in [16, 24, 64] {
        let set = stockinette(&KnitParams { points_per_loop: points, ..KnitParams::swatch() }).unwrap();
        for window in set.curves.iter().flat_map(|curve| curve.points.windows(4)) {
            let b = bezier_from_basis(&[window[0], window[1], window[2], window[3]], set.basis);
            assert_eq!(turning_of(&b).swift, 0.0, "{window:?}");
            seen += 1;
        }
    }
    assert!(seen > 100);
}
