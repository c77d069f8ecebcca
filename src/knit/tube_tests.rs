//! The generated tube, judged by the checkers, and the checkers, by broken tubes.

use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

use super::clearance::{min_clearance, min_curvature_radius};
use super::layout::TubeLayout;
use super::params::KnitParams;
use super::stockinette::KEPT_DISTANCE;
use super::tube::{inner_radius_mm, tube};
use super::unrolled::check_tube_interlock;
use crate::io::curves::CurveSet;

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

/// Clearance in yarn diameters and bending radius in yarn radii of a sound tube; the first thing that is
/// wrong otherwise.
fn judge(p: &KnitParams, tube: &CurveSet) -> Result<[f64; 2], String> {
    check_tube_interlock(tube, &TubeLayout::new(p)).map_err(|e| e.to_string())?;
    let clearance = min_clearance(tube, p.arc_skip_mm()).ok_or("no strands")?;
    let relative = clearance.distance / (2.0 * p.yarn_radius_mm);
    if relative < KEPT_DISTANCE {
        return Err(format!("clearance {relative:.4}: {clearance:?}"));
    }
    let radius = min_curvature_radius(tube).ok_or("nothing bends")? / p.yarn_radius_mm;
    if radius < 1.1 {
        return Err(format!("curvature radius {radius:.3} yarn radii"));
    }
    Ok([relative, radius])
}

#[test]
fn tubes_across_the_allowed_range_are_sound() {
    let mut cases = vec![
        params(4, 17, 0.1, [4.3, 2.7], 20),
        params(2, 40, 40.0, [4.15, 3.1], 32),
        params(3, 10, 0.75, [4.15, 2.9], 64),
    ];
    for wales in [10, 11, 24] {
        for wale in [4.15, 4.2, 6.5] {
            cases.extend([2.2, 2.9, 4.5].map(|course| params(3, wales, 0.75, [wale, course], 16)));
        }
    }
    cases.extend((1..=3).map(|courses| KnitParams { courses, ..KnitParams::tube() }));
    let (mut faults, mut least) = (Vec::new(), [f64::INFINITY; 2]);
    for p in &cases {
        let verdict = tube(p).map_err(|e| e.to_string()).and_then(|tube| judge(p, &tube));
        match verdict {
            Ok(found) => least = std::array::from_fn(|k| least[k].min(found[k])),
            Err(fault) => faults.push(format!("{p:?}: {fault}")),
        }
    }
    println!("{} tubes: clearance {:.4} diameters, bending {:.3} radii", cases.len(), least[0], least[1]);
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), cases.len(), faults.join("\n"));
    // Not loosened to be sound: somewhere strands touch.
    assert!(least[0] < 1.01, "{}", least[0]);
}

#[test]
fn default_stands_centred_with_its_face_outward() {
    let p = KnitParams::tube();
    let knit = tube(&p).unwrap();
    assert_eq!(knit, tube(&p).unwrap());
    assert_eq!(knit.curves.len(), 16);
    assert_eq!(knit.point_count() as u64, TubeLayout::new(&p).point_count());
    assert!(knit.curves.iter().all(|c| c.closed && c.points.len() == 24 * 20));
    let points: Vec<DVec3> = knit.curves.iter().flat_map(|c| c.points.iter().copied()).collect();
    let centre = points.iter().sum::<DVec3>() / points.len() as f64;
    assert!(centre.length() < 1e-9, "{centre}");
    let radii = || points.iter().map(|q| q.x.hypot(q.z));
    let inner = radii().fold(f64::INFINITY, f64::min);
    assert!((inner - inner_radius_mm(&p)).abs() < 1e-9, "{inner}, expected {}", inner_radius_mm(&p));
    // Wale by wale, the inside is as the flat cloth or a little wider.
    let [wale_mm, course_mm] = p.spacing_mm();
    let ratio = TAU * inner / (24.0 * wale_mm);
    assert!((1.0..1.001).contains(&ratio), "{ratio}");
    let step = knit.curves[1].points[7] - knit.curves[0].points[7];
    assert!((step - DVec3::Y * course_mm).length() < 1e-9, "{step}");
    // Heads and sinkers lie behind the legs of a technical face.
    let radius_of = |i: usize| knit.curves[3].points[i].x.hypot(knit.curves[3].points[i].z);
    assert!(radius_of(10) < radius_of(5) - 1.0 && radius_of(0) < radius_of(5) - 1.0);
}

#[test]
fn broken_tubes_are_rejected() {
    let p = params(4, 10, 0.75, [4.15, 2.9], 20);
    let sound = tube(&p).unwrap();
    assert!(judge(&p, &sound).is_ok());
    let fault = |edit: &dyn Fn(&mut CurveSet)| {
        let mut broken = sound.clone();
        edit(&mut broken);
        judge(&p, &broken).unwrap_err()
    };
    let each = |tube: &mut CurveSet, course: usize, edit: &dyn Fn(DVec3) -> DVec3| {
        tube.curves[course].points.iter_mut().for_each(|q| *q = edit(*q));
    };

    let thick = KnitParams { yarn_radius_mm: 0.8, wale_spacing_mm: None, ..p };
    assert!(judge(&thick, &sound).unwrap_err().contains("clearance"));
    assert!(
        fault(&|t| t.curves.iter_mut().for_each(|c| c.points.iter_mut().for_each(|q| *q *= 0.9)))
            .contains("clearance")
    );

    assert!(fault(&|t| t.curves[2].closed = false).contains("course 2"));
    assert!(fault(&|t| t.curves.truncate(3)).contains("3 curves for 4 courses"));
    assert!(fault(&|t| t.curves[1].points.truncate(199)).contains("199 control points"));
    assert!(fault(&|t| t.curves[1].points[5].x = f64::NAN).contains("course 1"));

    // A course drawn off outward, turned by half a wale, by a whole one, and beside the axis.
    let outward = |q: DVec3| q + DVec3::new(q.x, 0.0, q.z).normalize() * 10.0;
    let turned = |wales: f64| move |q: DVec3| DQuat::from_rotation_y(TAU / 10.0 * wales) * q;
    assert!(fault(&|t| each(t, 2, &outward)).contains("course 2"));
    assert!(fault(&|t| each(t, 2, &turned(0.5))).contains("expected"));
    assert!(fault(&|t| each(t, 2, &turned(1.0))).contains("against course 1"));
    assert!(fault(&|t| each(t, 2, &|q| q + DVec3::X * 50.0)).contains("0.000 times"));

    // The courses in the wrong order; all of them inside out.
    assert!(fault(&|t| t.curves.swap(1, 2)).contains("expected"));
    assert!(fault(&|t| (0..4).for_each(|c| each(t, c, &|q| DVec3::new(-q.x, q.y, q.z)))).contains("-1.000"));
    let mirrored = |q: DVec3| {
        let radius = q.x.hypot(q.z);
        q * DVec3::new(30.0 / radius - 1.0, 1.0, 30.0 / radius - 1.0)
    };
    assert!(fault(&|t| (0..4).for_each(|c| each(t, c, &mirrored))).contains("wale 0"));
}

/// One stitch let down, or two of them hooked up, at the seam: the first and the last wale.
#[test]
fn faults_at_the_seam_are_seen_from_both_sides() {
    let p = params(3, 10, 0.75, [4.15, 2.9], 20);
    let sound = tube(&p).unwrap();
    for (wale, heads) in [(0, 10), (9, 190), (4, 90)] {
        let mut dropped = sound.clone();
        // The head comes out in front of the loop that holds it.
        for q in &mut dropped.curves[1].points[heads - 5..=heads + 5] {
            *q += DVec3::new(q.x, 0.0, q.z).normalize() * 6.0;
        }
        let found = check_tube_interlock(&dropped, &TubeLayout::new(&p)).unwrap_err();
        assert_eq!((found.course, found.wale), (2, wale), "{found}");
    }
    // The last loop of course 1 reaches across the seam into the first one's place.
    let mut across = sound.clone();
    for q in &mut across.curves[1].points[184..=196] {
        *q = DQuat::from_rotation_y(TAU / 10.0) * *q;
    }
    let found = check_tube_interlock(&across, &TubeLayout::new(&p)).unwrap_err().to_string();
    assert!(found.contains("crossings with the loop above and below only"), "{found}");
}

#[test]
fn bad_parameters_are_named_in_one_line() {
    let good = KnitParams::tube;
    let cases = [
        (KnitParams { courses: 0, ..good() }, "courses: expected at least 1, found 0"),
        (KnitParams { wales: 9, ..good() }, "wales: expected at least 10, found 9"),
        (
            KnitParams { wale_spacing_mm: Some(6.0), ..good() },
            "wale_spacing_mm: expected at least 6.2250 mm for yarn_radius_mm = 0.75, below which strands \
             enter each other, found 6",
        ),
        (
            KnitParams { courses: u32::MAX, wales: u32::MAX, ..good() },
            "courses and wales: expected a tube of at most 16777216 control points, found 4294967295 \
             courses of 4294967295 loops, 18446744073709551615 control points",
        ),
    ];
    for (p, want) in cases {
        assert_eq!(tube(&p).unwrap_err().to_string(), want);
    }
    for p in [
        KnitParams { yarn_radius_mm: f64::NAN, ..good() },
        KnitParams { course_spacing_mm: Some(f64::INFINITY), ..good() },
        KnitParams { points_per_loop: 0, ..good() },
    ] {
        let line = tube(&p).unwrap_err().to_string();
        assert!(line.contains("expected") && !line.contains('\n'), "{line}");
    }
}
