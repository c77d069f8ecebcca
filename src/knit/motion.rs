//! Motions of generated fabric: cyclic, and a closed form of place and time.

use crate::io::curves::CurveSet;
use crate::io::gltf_write::Moves;
use crate::math::bounds::{Bounds, bounds};
use glam::{DQuat, DVec3};
use std::f64::consts::{PI, TAU};

/// How a fabric moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dance {
    /// It is pulled up and down about its middle, and narrows.
    Stretch,
    /// Waves run through it, from bottom to top.
    Wave,
    /// Its upper half bends over, as a sleeve does at the elbow.
    Bend,
}

/// Most that it is stretched by, and narrows, as shares of its size.
const STRETCH: f64 = 0.25;
const NARROWING: f64 = 0.1;
/// Waves that there are over its height, and how high they are as a share of it.
const WAVES: f64 = 1.5;
const WAVE_HEIGHT: f64 = 0.08;
/// How far it bends, in radians, and between which shares of its height.
const BEND: f64 = 1.2;
const ELBOW: [f64; 2] = [0.3, 0.7];
/// A cycle of a written motion in seconds, and keys of it.
const CYCLE_SECONDS: f64 = 2.0;
const KEYS: u32 = 48;

/// The place of every point, given at rest, after that many cycles. Whole cycles are the same, and after none a fabric
/// that is stretched or bent is at rest.
pub fn danced(points: &[DVec3], dance: Dance, cycles: f64) -> Vec<DVec3> {
    let around = bounds(points.iter().copied());
    if dance == Dance::Bend {
        let turn = bend(cycles);
        let elbow = elbow(around);
        let place = |p: &DVec3| {
            let share = share_above(around, *p);
            (1.0 - share) * *p + share * (elbow + turn * (*p - elbow))
        };
        return points.iter().map(place).collect();
    }
    let weights = weights(dance, cycles);
    let mut moved = points.to_vec();
    for (target, weight) in targets(points, dance).iter().zip(weights) {
        moved.iter_mut().zip(target).for_each(|(point, target)| *point += weight * *target);
    }
    moved
}

/// One cycle of a motion, for a file.
pub fn written(set: &CurveSet, dance: Dance) -> Moves {
    let points: Vec<DVec3> = set.curves.iter().flat_map(|curve| &curve.points).copied().collect();
    let times = (0..=KEYS).map(|key| f64::from(key) / f64::from(KEYS));
    if dance != Dance::Bend {
        let keys = times.map(|cycles| (CYCLE_SECONDS * cycles, weights(dance, cycles))).collect();
        return Moves::Morph { targets: targets(&points, dance), keys };
    }
    let around = bounds(points.iter().copied());
    let foot = DVec3::new(elbow(around).x, around.0.y, elbow(around).z);
    let hung = |p: &DVec3| {
        let share = share_above(around, *p) as f32;
        ([0, 1, 0, 0], [1.0 - share, share, 0.0, 0.0])
    };
    let keys = times.map(|cycles| (CYCLE_SECONDS * cycles, vec![DQuat::IDENTITY, bend(cycles)])).collect();
    Moves::Skin { joints: vec![foot, elbow(around)], weights: points.iter().map(hung).collect(), keys }
}

/// What is added to every point: by [`weights`] as much of it.
fn targets(points: &[DVec3], dance: Dance) -> Vec<Vec<DVec3>> {
    let (low, high) = bounds(points.iter().copied());
    let (middle, height) = (0.5 * (low + high), high.y - low.y);
    let of = |target: &dyn Fn(&DVec3) -> DVec3| points.iter().map(target).collect();
    let angle = |p: &DVec3| TAU * WAVES * (p.y - low.y) / height.max(f64::MIN_POSITIVE);
    match dance {
        Dance::Stretch => {
            let by = DVec3::new(-NARROWING, STRETCH, -NARROWING);
            vec![of(&|p| (*p - middle) * by)]
        }
        // sin(angle - phase) is a sum of two waves that stand.
        Dance::Wave => vec![
            of(&|p| DVec3::Z * WAVE_HEIGHT * height * angle(p).sin()),
            of(&|p| DVec3::Z * WAVE_HEIGHT * height * angle(p).cos()),
        ],
        Dance::Bend => Vec::new(),
    }
}

fn weights(dance: Dance, cycles: f64) -> Vec<f64> {
    let phase = TAU * cycles.rem_euclid(1.0);
    match dance {
        Dance::Stretch => vec![pulled(cycles)],
        Dance::Wave => vec![phase.cos(), -phase.sin()],
        Dance::Bend => Vec::new(),
    }
}

/// From 0 to 1 and back in a cycle.
fn pulled(cycles: f64) -> f64 {
    (PI * cycles.rem_euclid(1.0)).sin().powi(2)
}

fn bend(cycles: f64) -> DQuat {
    DQuat::from_rotation_z(BEND * pulled(cycles))
}

fn elbow((low, high): Bounds) -> DVec3 {
    0.5 * (low + high)
}

/// How much of a point hangs on what is above the elbow.
fn share_above((low, high): Bounds, p: DVec3) -> f64 {
    let height = (p.y - low.y) / (high.y - low.y).max(f64::MIN_POSITIVE);
    let t = ((height - ELBOW[0]) / (ELBOW[1] - ELBOW[0])).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Rng;

    #[test]
    fn motions_are_cyclic_and_as_large_as_they_say() {
        let mut rng = Rng::new(5, &[]);
        let points: Vec<DVec3> =
            (0..100).map(|_| 30.0 * DVec3::from_array(std::array::from_fn(|_| rng.uniform()))).collect();
        let size = |points: &[DVec3]| {
            let (low, high) = bounds(points.iter().copied());
            high - low
        };
        for dance in [Dance::Stretch, Dance::Wave, Dance::Bend] {
            for cycles in [0.0, 0.2, 0.5] {
                let (now, later) = (danced(&points, dance, cycles), danced(&points, dance, cycles + 100.0));
                assert!(now.iter().zip(&later).all(|(a, b)| (*a - *b).length() < 1e-9));
            }
        }
        assert_eq!(danced(&points, Dance::Stretch, 0.0), points);
        let stretched = size(&danced(&points, Dance::Stretch, 0.5)) / size(&points);
        assert!((stretched - DVec3::new(0.9, 1.25, 0.9)).length() < 1e-9, "{stretched}");
        let waved = danced(&points, Dance::Wave, 0.3);
        assert!(waved.iter().zip(&points).all(|(a, b)| (a.x, a.y) == (b.x, b.y)));
        let bent = danced(&points, Dance::Bend, 0.5);
        let (low, _) = bounds(points.iter().copied());
        let height = size(&points).y;
        for (bent, p) in bent.iter().zip(&points).filter(|(_, p)| p.y < low.y + 0.3 * height) {
            assert!((*bent - *p).length() < 1e-9, "below the elbow nothing moves");
        }
        assert!(bent.iter().zip(&points).any(|(a, b)| (*a - *b).length() > 5.0));
        assert!(danced(&[DVec3::ONE], Dance::Wave, 0.3)[0].is_finite());
    }
}
