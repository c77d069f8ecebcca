//! The fibers of one cross-section, drawn from Zhao's density.

use super::density::fiber_density;
use super::params::YarnParams;
use crate::math::rng::Rng;
use std::f64::consts::TAU;

/// One fiber of a cross-section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fiber {
    /// R_i in [0, 1]: distance from the ply's centre as a share of its ellipse.
    pub radius: f64,
    /// theta_i in radians, in the ply's frame.
    pub angle: f64,
    /// m_i in radians, independent of everything else.
    pub migration_phase: f64,
    /// The ply it belongs to.
    pub ply: u32,
}

/// Draws all fibers of a yarn: `rank * ply_count + ply`, outermost rank first, so that the first n
/// ranks are what level of detail keeps.
pub fn fiber_table(yarn: &YarnParams, seed: u64) -> Vec<Fiber> {
    let mut plies: Vec<Vec<Fiber>> = (0..yarn.ply_count)
        .map(|ply| (0..yarn.fibers_per_ply).map(|i| draw_fiber(yarn, seed, ply, i)).collect())
        .collect();
    for ply in &mut plies {
        ply.sort_by(|a, b| b.radius.total_cmp(&a.radius));
    }
    (0..yarn.fibers_per_ply as usize).flat_map(|rank| plies.iter().map(move |p| p[rank])).collect()
}

/// Uniform over the disc, accepted with p(R): p is an area density.
fn draw_fiber(yarn: &YarnParams, seed: u64, ply: u32, index: u32) -> Fiber {
    let mut rng = Rng::new(seed, &[u64::from(ply), u64::from(index)]);
    loop {
        let radius = rng.uniform().sqrt();
        let angle = TAU * rng.uniform();
        if rng.uniform() < fiber_density(radius, yarn.density_beta, yarn.density_epsilon) {
            return Fiber { radius, angle, migration_phase: TAU * rng.uniform(), ply };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::presets;

    #[test]
    fn radii_follow_the_density() {
        let mut yarn = presets::yarn("worsted_3ply").unwrap();
        yarn.ply_count = 8;
        yarn.fibers_per_ply = 2000;
        let fibers = fiber_table(&yarn, 5);
        let bins = 20;
        let mut counts = vec![0.0; bins];
        for f in &fibers {
            counts[((f.radius * bins as f64) as usize).min(bins - 1)] += 1.0;
        }
        let ring = |r: f64| r * fiber_density(r, yarn.density_beta, yarn.density_epsilon);
        let steps = 2000;
        let mass = |bin: usize| -> f64 {
            (0..steps)
                .map(|i| ring((bin as f64 + (f64::from(i) + 0.5) / f64::from(steps)) / bins as f64))
                .sum()
        };
        let masses: Vec<f64> = (0..bins).map(mass).collect();
        let total: f64 = masses.iter().sum();
        let chi2: f64 = counts
            .iter()
            .zip(&masses)
            .map(|(&n, &m)| {
                let expected = m / total * fibers.len() as f64;
                (n - expected) * (n - expected) / expected
            })
            .sum();
        // 19 degrees of freedom: 43.8 is exceeded by chance once in a thousand.
        assert!(chi2 < 43.8, "chi squared {chi2}");
    }

    #[test]
    fn ordered_outermost_first_and_reproducible() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let fibers = fiber_table(&yarn, 1);
        assert_eq!(fibers.len(), yarn.fiber_count() as usize);
        for ply in 0..yarn.ply_count {
            let radii: Vec<f64> = fibers.iter().filter(|f| f.ply == ply).map(|f| f.radius).collect();
            assert!(radii.windows(2).all(|w| w[0] >= w[1]));
        }
        assert_eq!(fibers, fiber_table(&yarn, 1));
        assert_ne!(fibers, fiber_table(&yarn, 2));
    }
}
