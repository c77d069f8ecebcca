//! Where a yarn's fibers are in its plies, on average over their migration.

use super::density::fiber_density;
use super::params::YarnParams;
use crate::math::quadrature::gauss_legendre;
use std::f64::consts::PI;

/// Steps of each of the two parts that radii are tabulated in.
const STEPS: usize = 1024;
/// Migration over less than this share of the radius is none.
const STILL: f64 = 1e-9;
/// Share of its radius below which a fiber counts as no nearer to the ply's axis: all of them there at once would be
/// infinitely dense.
const LEAST_MIGRATION: f64 = 0.05;

/// An area density over the radius of the ply's ellipse, with the mass of p: p is that of the R_i that fibers are
/// drawn with, but a fiber spends its way between R_min R_i and R_max R_i (Wu & Yuksel 2019, Eq. 2). Sec. 4.1 of the
/// paper takes p for both. Fibers seen at the rim, which only those of the outermost that are farthest out reach, are
/// then in the shadow of a crowd that is not there: a swatch of wool, lit by one lamp, came out 40% too dark.
#[derive(Clone, Debug)]
pub struct MigratedDensity {
    /// Where the two parts meet, in (0, 1]: at R_min, where the density has a kink.
    middle: f64,
    /// Densities at both parts' nodes, that crowd toward the parts' ends; the middle stands twice. None without
    /// migration: the density is then a formula.
    densities: Vec<f64>,
    yarn: YarnParams,
}

impl MigratedDensity {
    /// That of a yarn, tabulated: within 1e-4 of the integral where p is not steep, within 2e-3 anywhere.
    pub fn new(yarn: &YarnParams) -> Self {
        let middle = yarn.migration_min.clamp(LEAST_MIGRATION, 1.0);
        if yarn.migration_max - yarn.migration_min < STILL {
            return Self { middle, densities: Vec::new(), yarn: yarn.clone() };
        }
        let node = |i: usize| 0.5 - 0.5 * (PI * i as f64 / STEPS as f64).cos();
        let inner = (0..=STEPS).map(|i| middle * node(i));
        let outer = (0..=STEPS).map(|i| middle + (1.0 - middle) * node(i));
        let densities = inner.chain(outer).map(|radius| migrated_density(yarn, radius)).collect();
        Self { middle, densities, yarn: yarn.clone() }
    }

    /// The density at `radius`, in [0, 1] of the ply's ellipse; 0 outside, where a yarn whose R_max is above 1 has
    /// fibers that are not counted.
    pub fn at(&self, radius: f64) -> f64 {
        if !(0.0..=1.0).contains(&radius) {
            return 0.0;
        }
        if self.densities.is_empty() {
            return migrated_density(&self.yarn, radius);
        }
        let outside = radius > self.middle;
        let (from, to) = if outside { (self.middle, 1.0) } else { (0.0, self.middle) };
        let share = ((radius - from) / (to - from)).clamp(0.0, 1.0);
        let place = (1.0 - 2.0 * share).acos() / PI * STEPS as f64;
        let low = (place as usize).min(STEPS - 1);
        let part = &self.densities[if outside { STEPS + 1 } else { 0 }..];
        let along = place - low as f64;
        (1.0 - along) * part[low] + along * part[low + 1]
    }

    /// Radius at which the density has a kink.
    pub fn kink(&self) -> f64 {
        self.middle
    }
}

/// The density that [`MigratedDensity`] tabulates, at `radius` in [0, 1] of the ply's ellipse: the mean over migration
/// itself. A fiber at phase x is at R_i m(x), m = (R_max + R_min)/2 + (R_max - R_min)/2 cos x;
/// all of them at x alone would be as dense as p(radius / m) / m^2.
pub fn migrated_density(yarn: &YarnParams, radius: f64) -> f64 {
    let middle = 0.5 * (yarn.migration_max + yarn.migration_min);
    let amplitude = 0.5 * (yarn.migration_max - yarn.migration_min);
    let share = |phase: f64| (middle + amplitude * phase.cos()).max(LEAST_MIGRATION);
    let drawn =
        |share: f64| fiber_density(radius / share, yarn.density_beta, yarn.density_epsilon) / (share * share);
    if 2.0 * amplitude < STILL {
        return drawn(share(0.0));
    }
    // Fibers reach this radius while m is at least it: from phase 0, where it is largest, to the last one.
    let reached = radius.max(LEAST_MIGRATION) - middle;
    let last = (reached / amplitude).clamp(-1.0, 1.0).acos();
    // There p ends like a power of what is left to its rim, possibly a low one: nodes crowd toward it.
    let crowded = |u: f64| {
        let phase = last * (1.0 - (1.0 - u).powi(4));
        drawn(share(phase)) * 4.0 * last * (1.0 - u).powi(3)
    };
    let cuts = [0.0, 0.25, 0.5, 0.75, 1.0];
    cuts.windows(2).map(|cut| gauss_legendre(cut[0], cut[1], crowded)).sum::<f64>() / PI
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::density::density_mass_mm2;
    use crate::yarn::migration::migration_radius;
    use crate::yarn::presets;
    use crate::yarn::table::fiber_table;
    use std::f64::consts::TAU;

    fn presets_of_yarn() -> impl Iterator<Item = (&'static str, YarnParams)> {
        presets::yarn_names().map(|name| (name, presets::yarn(name).unwrap()))
    }

    #[test]
    fn the_table_agrees_with_a_fine_sum_over_migration() {
        for (name, yarn) in presets_of_yarn() {
            let density = MigratedDensity::new(&yarn);
            let n = 100_000;
            let sum = |radius: f64| {
                let share = |i: u32| {
                    let phase = PI * (f64::from(i) + 0.5) / f64::from(n);
                    let share = migration_radius(1.0, phase, yarn.migration_min, yarn.migration_max).0;
                    fiber_density(radius / share, yarn.density_beta, yarn.density_epsilon) / (share * share)
                };
                (0..n).map(share).sum::<f64>() / f64::from(n)
            };
            for i in 0..60 {
                let radius = 0.999 * (0.5 + 0.618_034 * f64::from(i)).fract();
                let (read, fine) = (density.at(radius), sum(radius));
                assert!((read - fine).abs() < 1e-3 * fine.max(1.0), "{name} at {radius}: {read} and {fine}");
            }
        }
    }

    #[test]
    fn migration_moves_fibers_inward_and_keeps_their_number() {
        for (name, yarn) in presets_of_yarn() {
            let density = MigratedDensity::new(&yarn);
            let n = 20_000;
            let rings = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n));
            let mass: f64 = rings.map(|r| TAU * r * density.at(r) / f64::from(n)).sum();
            let expected = density_mass_mm2(&yarn) / (yarn.ellipse_short_mm * yarn.ellipse_long_mm);
            assert!((mass / expected - 1.0).abs() < 1e-3, "{name}: {mass} and {expected}");
            let rim = fiber_density(0.97, yarn.density_beta, yarn.density_epsilon);
            assert!(density.at(0.97) < rim, "{name}: {} at the rim, drawn {rim}", density.at(0.97));
        }
    }

    #[test]
    fn without_migration_it_is_the_density_that_fibers_are_drawn_with() {
        let cotton = presets::yarn("cotton1").unwrap();
        let still = YarnParams { migration_min: 1.0, migration_max: 1.0, ..cotton };
        let density = MigratedDensity::new(&still);
        for radius in [0.0, 0.3, 0.6, 0.9, 0.99] {
            let p = fiber_density(radius, still.density_beta, still.density_epsilon);
            assert!((density.at(radius) - p).abs() < 1e-12, "at {radius}: {} and {p}", density.at(radius));
        }
        for outside in [-0.1, 1.1, f64::NAN, f64::INFINITY] {
            assert_eq!(density.at(outside), 0.0);
        }
    }

    #[test]
    fn real_fibers_are_as_dense_as_it_says() {
        // Places of real fibers along their migration, counted ring by ring.
        let yarn = YarnParams { fibers_per_ply: 4000, ..presets::yarn("worsted_3ply").unwrap() };
        let density = MigratedDensity::new(&yarn);
        let fibers = fiber_table(&yarn, 5);
        let (low, high) = (yarn.migration_min, yarn.migration_max);
        let phases = (0..64).map(|k| TAU * f64::from(k) / 64.0);
        let radii: Vec<f64> = phases
            .flat_map(|phase| fibers.iter().map(move |f| (f.radius, f.migration_phase + phase)))
            .map(|(radius, phase)| migration_radius(radius, phase, low, high).0)
            .collect();
        let mass = density_mass_mm2(&yarn) / (yarn.ellipse_short_mm * yarn.ellipse_long_mm);
        for ring in 2..9 {
            let (low, high) = (0.1 * f64::from(ring), 0.1 * f64::from(ring) + 0.1);
            let found = radii.iter().filter(|r| (low..high).contains(*r)).count() as f64 / radii.len() as f64;
            let expected = gauss_legendre(low, high, |r| TAU * r * density.at(r)) / mass;
            assert!((found / expected - 1.0).abs() < 0.08, "ring {ring}: {found} of {expected}");
        }
    }
}
