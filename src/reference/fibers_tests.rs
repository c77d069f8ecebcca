use super::*;
use crate::math::bounds::bounds;
use crate::math::curve::{Basis, Curve};
use crate::math::rng::Rng;
use crate::reference::test_scene::{scene_of, straight, yarn};
use crate::yarn::breaks::is_broken;
use crate::yarn::presets;
use crate::yarn::strand::strands;
use std::f64::consts::TAU;

fn wavy(points: u32, closed: bool) -> Curve {
    let at = |i: u32| {
        let u = TAU * f64::from(i) / f64::from(points);
        DVec3::new((4.0 + (4.0 * u).cos()) * u.cos(), (4.0 + (4.0 * u).cos()) * u.sin(), (7.0 * u).sin())
    };
    Curve { points: (0..points).map(at).collect(), closed }
}

fn field(preset: &str, closed: bool, change: impl Fn(&mut crate::yarn::params::YarnParams)) -> FiberField {
    let mut yarn = presets::yarn(preset).unwrap();
    yarn.fibers_per_ply = 12;
    change(&mut yarn);
    FiberField::new(strands(&[wavy(40, closed)], Basis::CatmullRom, &yarn, 4), &yarn, 4)
}

fn runs_of(field: &FiberField, chord_error: f64) -> Vec<RealisedFiber> {
    let settings = RealiseSettings { chord_error, ..Default::default() };
    realise_field(field, &settings, &AtomicU64::new(0)).unwrap()
}

fn segments(run: &RealisedFiber) -> impl Iterator<Item = [usize; 2]> {
    let n = run.points.len();
    (0..run.segment_count()).map(move |k| [k, (k + 1) % n])
}

fn length(run: &RealisedFiber) -> f64 {
    segments(run).map(|[a, b]| run.points[a].distance(run.points[b])).sum()
}

fn distance_to(p: DVec3, run: &RealisedFiber) -> f64 {
    let to_segment = |[a, b]: [usize; 2]| {
        let (from, to) = (run.points[a], run.points[b]);
        let share = (p - from).dot(to - from) / (to - from).length_squared();
        p.distance(from.lerp(to, share.clamp(0.0, 1.0)))
    };
    segments(run).map(to_segment).fold(f64::INFINITY, f64::min)
}

#[test]
fn every_fiber_lies_within_the_chord_error_of_its_runs() {
    for (preset, closed) in [("cotton1", true), ("rayon1", false), ("worsted_3ply", true)] {
        let field = field(preset, closed, |_| ());
        for chord_error in [0.5, 0.05] {
            let runs = runs_of(&field, chord_error);
            let tolerance = chord_error * field.yarn.fiber_radius_mm();
            for index in 0..300 {
                let mut rng = Rng::new(3, &[index]);
                let mut below = |n: usize| (rng.uniform() * n as f64) as usize;
                let (piece, fiber) = (below(field.strands.pieces.len()), below(field.fibers.len()));
                let (point, _) = field.fiber_at(&field.strands.pieces[piece], fiber, rng.uniform());
                let own = runs.iter().filter(|run| run.fiber == fiber as u32);
                let off = own.map(|run| distance_to(point.position, run)).fold(f64::INFINITY, f64::min);
                assert!(off <= 1.05 * tolerance, "{preset} {chord_error}: {off} of {tolerance} mm");
            }
        }
    }
}

#[test]
fn nothing_is_left_out_or_added_beside_what_the_fast_path_draws_in_many_steps() {
    const STEPS: u32 = 3000;
    for (preset, closed) in [("cotton1", true), ("cotton1", false), ("rayon1", true), ("mohair", false)] {
        let field = field(preset, closed, |yarn| yarn.fibers_per_ply = 4);
        let runs = runs_of(&field, 0.01);
        for fiber in 0..field.fibers.len() {
            let (mut drawn, mut breaks, mut last) = (0.0, 0, None::<(DVec3, i32)>);
            for piece in &field.strands.pieces {
                for k in 0..=STEPS {
                    let t = f64::from(k) / f64::from(STEPS);
                    let (point, vertex) = field.fiber_vertex(piece, fiber, t, STEPS);
                    if let Some((from, exit)) = last.filter(|_| k > 0) {
                        let broken = is_broken(exit, vertex.entry);
                        breaks += usize::from(broken);
                        drawn += if broken { 0.0 } else { from.distance(point.position) };
                    }
                    last = Some((point.position, vertex.exit));
                }
            }
            let own: Vec<_> = runs.iter().filter(|run| run.fiber == fiber as u32).collect();
            let found: f64 = own.iter().map(|run| length(run)).sum();
            assert!((found / drawn - 1.0).abs() < 2e-3, "{preset} {closed}: {found} mm, drawn {drawn}");
            let expected = if closed { breaks.max(1) } else { breaks + 1 };
            assert_eq!(own.len(), expected, "{preset} {closed}: {breaks} breaks");
            assert!(own.iter().all(|run| run.closed == (closed && breaks == 0)));
        }
    }
}

#[test]
fn directions_follow_the_points_and_radii_taper() {
    let field = field("cotton1", true, |yarn| yarn.fibers_per_ply = 40);
    let runs = runs_of(&field, 0.02);
    let (mut bends, mut count, mut tips) = (0.0, 0.0, 0);
    for run in &runs {
        let n = run.points.len();
        assert_eq!((n, n), (run.tangents.len(), run.radii_mm.len()));
        for [a, b] in segments(run) {
            let chord = (run.points[b] - run.points[a]).normalize();
            let mean = (run.tangents[a] + run.tangents[b]).normalize();
            bends += chord.cross(mean).length().powi(2);
            count += 1.0;
            assert!(run.tangents[a].is_normalized() && run.radii_mm[a] >= 0.0);
        }
        tips += [0, run.points.len() - 1].iter().filter(|k| run.radii_mm[**k] < 1e-9).count();
    }
    // A few hairs' roots are kinks.
    assert!((bends / count).sqrt() < 0.02, "{}", (bends / count).sqrt());
    let open = runs.iter().filter(|run| !run.closed).count();
    assert!(tips == open && tips > 20, "{tips} tips of {open} open runs");
}

#[test]
fn finer_settings_give_more_points_and_too_many_are_refused() {
    let field = field("rayon1", false, |_| ());
    let count = |chord_error: f64| runs_of(&field, chord_error).iter().map(|r| r.points.len()).sum::<usize>();
    let (coarse, fine) = (count(0.1), count(0.001));
    // A chord's error goes with its length squared.
    assert!((5.0..20.0).contains(&(fine as f64 / coarse as f64)), "{coarse} {fine}");
    let settings = RealiseSettings { chord_error: 0.1, max_points: coarse as u64 - 1 };
    let error = realise_field(&field, &settings, &AtomicU64::new(0)).unwrap_err().to_string();
    assert!(error.contains("found more") && !error.contains('\n'), "{error}");
}

#[test]
fn a_scene_s_fibers_keep_its_origin_and_its_order() {
    let curves = [straight(90.0, 100.0, 50.0), straight(90.0, 100.0, 52.0)];
    let yarn = yarn("cotton1", 9);
    let scene = scene_of("seed = 5", &curves, &yarn);
    let settings = RealiseSettings { chord_error: 1.0, ..Default::default() };
    let runs = realise(&scene, &settings).unwrap();
    assert_eq!(runs, realise(&scene, &settings).unwrap(), "the same whatever thread makes which");
    let (low, high) = bounds(runs.iter().flat_map(|run| run.points.iter().copied()));
    assert!((0.5 * (low + high) - scene.origin_mm).length() < 0.5, "{low} {high}");
    assert!((scene.origin_mm - DVec3::new(95.0, 51.0, 0.0)).length() < 1e-9);
    assert!(runs.windows(2).all(|w| (w[0].curve, w[0].fiber) <= (w[1].curve, w[1].fiber)));
    assert_eq!(runs.last().map(|run| (run.curve, run.fiber)), Some((1, yarn.fiber_count() - 1)));
}
