//! Matches the twin's fibers with given ones: a robust least-squares fit of what is random, then the worst
//! departure of any point.

use crate::equations::phase_and_radius;
use crate::truth::Truth;
use crate::twin::{Reading, StraightTwin, Unknowns};
use glam::DVec3;
use std::f64::consts::TAU;
use worsted::yarn::params::YarnParams;

/// Largest departures over all points of all fibers; NaN counts as infinite.
pub struct Errors {
    /// Of the polar angle in the ply's rotating elliptical frame.
    pub phase_rad: f64,
    /// As a share of the ply's radius.
    pub radius: f64,
    /// The fitted angle of ply 0 at z = 0.
    pub ply_start_rad: f64,
}

/// Beyond this many mm a departure counts linearly (Huber 1964): a tenth of the promised radius.
const HUBER_MM: f64 = 2e-6;
const STEPS: usize = 12;
/// Steps below this, in radians or shares of a radius, end a fit: a thousandth of the given points' rounding.
const SETTLED: f64 = 1e-9;

/// How far the twin, reading the yarn as `yarn`, departs from `truth` after matching.
pub fn compare(truth: &Truth, yarn: &YarnParams, reading: Reading) -> Errors {
    let twin = StraightTwin::new(yarn, reading);
    let fiber = |i: usize| (truth.ply(i), truth.fibers[i].as_slice());
    let all = 0..truth.fibers.len();
    let start = ply_start(truth);
    // The plies start where most of some fibers, each for itself, would have them start.
    let some = all.clone().step_by(all.len().div_ceil(15));
    let own_starts = some.map(|i| {
        let (ply, points) = fiber(i);
        let first = first_guess(&twin, truth, ply, points, start);
        fit::<4>(&twin, ply, points, first)[3] - start
    });
    let start = start + median(own_starts.collect());
    let mut worst = Errors { phase_rad: 0.0, radius: 0.0, ply_start_rad: start };
    for i in all {
        let (ply, points) = fiber(i);
        let first = first_guess(&twin, truth, ply, points, start);
        let fitted = fit::<3>(&twin, ply, points, first);
        for p in points {
            // Both positions are taken apart by the same true frame: a twin that puts it elsewhere shows.
            let apart = |p: DVec3| phase_and_radius(&truth.yarn, ply, start, p.to_array());
            let [found, expected] = [apart(twin.position(ply, &fitted, p.z)), apart(*p)];
            worst.phase_rad = larger(worst.phase_rad, wrapped(found[0] - expected[0]).abs());
            worst.radius = larger(worst.radius, (found[1] - expected[1]).abs());
        }
    }
    worst
}

fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Roughly where ply 0 starts: the mean direction of all points, turned back with their plies.
fn ply_start(truth: &Truth) -> f64 {
    let mut mean = [0.0; 2];
    for (i, fiber) in truth.fibers.iter().enumerate() {
        for p in fiber.iter().filter(|p| p.is_finite()) {
            let turn = TAU * f64::from(truth.ply(i)) / f64::from(truth.yarn.ply_count)
                + TAU * truth.yarn.ply_turns_per_mm() * p.z;
            mean[0] += p.x * turn.cos() + p.y * turn.sin();
            mean[1] += p.y * turn.cos() - p.x * turn.sin();
        }
    }
    mean[1].atan2(mean[0])
}

/// R_i, theta_i and m_i from what the points look like in the ply's frame: means turned back by the twin's
/// own turns, over the radius.
fn first_guess(twin: &StraightTwin, truth: &Truth, ply: u32, points: &[DVec3], start: f64) -> Unknowns {
    let mut turned = [0.0; 2];
    let mut wave = [0.0; 2];
    let apart: Vec<_> = points
        .iter()
        .filter(|p| p.is_finite())
        .map(|p| (phase_and_radius(&truth.yarn, ply, start, p.to_array()), twin.phases(p.z)))
        .collect();
    let middle = apart.iter().map(|([_, radius], _)| radius).sum::<f64>() / apart.len() as f64;
    for ([phase, radius], [twist, migration]) in apart {
        turned[0] += radius * (phase - twist).cos();
        turned[1] += radius * (phase - twist).sin();
        wave[0] += (radius - middle) * migration.cos();
        wave[1] -= (radius - middle) * migration.sin();
    }
    let radius = 2.0 * middle / (truth.yarn.migration_max + truth.yarn.migration_min);
    [radius, turned[1].atan2(turned[0]), wave[1].atan2(wave[0]), start]
}

/// Gauss and Newton's method on positions for the first `N` unknowns, departures weighed by Huber.
fn fit<const N: usize>(twin: &StraightTwin, ply: u32, points: &[DVec3], mut unknowns: Unknowns) -> Unknowns {
    const NUDGE: f64 = 1e-6;
    for _ in 0..STEPS {
        let mut normal = [[0.0; N]; N];
        let mut right = [0.0; N];
        for p in points.iter().filter(|p| p.is_finite()) {
            let here = twin.position(ply, &unknowns, p.z);
            let gap = *p - here;
            let weight = HUBER_MM / gap.length().max(HUBER_MM);
            let slopes: [DVec3; N] = std::array::from_fn(|k| {
                let mut nudged = unknowns;
                nudged[k] += NUDGE;
                (twin.position(ply, &nudged, p.z) - here) / NUDGE
            });
            for (row, a) in slopes.iter().enumerate() {
                right[row] += weight * a.dot(gap);
                for (column, b) in slopes.iter().enumerate() {
                    normal[row][column] += weight * a.dot(*b);
                }
            }
        }
        let step = solve(normal, right);
        for (unknown, step) in unknowns.iter_mut().zip(step) {
            // Fits of a wrong twin wander: they only have to stay finite.
            *unknown += step.clamp(-0.5, 0.5);
        }
        if step.iter().all(|step| step.abs() < SETTLED) {
            break;
        }
    }
    unknowns
}

/// Solves a symmetric positive system by elimination; unknowns that nothing depends on get no step.
fn solve<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> [f64; N] {
    let scale = (0..N).map(|i| a[i][i]).fold(0.0, f64::max);
    let mut x = [0.0; N];
    for i in 0..N {
        if a[i][i] <= 1e-12 * scale {
            continue;
        }
        let (pivots, pivot_right) = (a[i], b[i]);
        for row in i + 1..N {
            let factor = a[row][i] / pivots[i];
            a[row].iter_mut().zip(pivots).for_each(|(entry, pivot)| *entry -= factor * pivot);
            b[row] -= factor * pivot_right;
        }
    }
    for i in (0..N).rev() {
        if a[i][i] > 1e-12 * scale {
            let known: f64 = (i + 1..N).map(|k| a[i][k] * x[k]).sum();
            x[i] = (b[i] - known) / a[i][i];
        }
    }
    x
}

#[test]
fn systems_are_solved_and_unused_unknowns_left_alone() {
    let x = solve([[4.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 0.0]], [6.0, 7.0, 0.0]);
    assert!((x[0] - 1.0).abs() < 1e-14 && (x[1] - 2.0).abs() < 1e-14 && x[2] == 0.0, "{x:?}");
    assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
}
