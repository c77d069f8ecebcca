//! Densities along the chords of a ply, tabulated once for bakes that follow very many lines.

use crate::math::quadrature::gauss_legendre;
use crate::yarn::migrated_density::MigratedDensity;

/// Steps of each side: errors stay below 5e-4 of a ply's half-axis.
const STEPS: usize = 512;

/// Integrals of the density from places on chords of the unit circle to their ends.
pub struct ChordTable {
    /// Chord by chord from the rim to the middle, by [`chord_share`]; on each from its middle to its end.
    rests: Vec<f64>,
}

impl ChordTable {
    /// The table of a yarn's density.
    pub fn new(of: &MigratedDensity) -> Self {
        let side = STEPS + 1;
        let mut rests = vec![0.0; side * side];
        for (chord, rests) in rests.chunks_exact_mut(side).enumerate() {
            let half = half_of_share(chord as f64 / STEPS as f64);
            let density = |s: f64| {
                let radius = (1.0 - half * half * (1.0 - s * s)).max(0.0).sqrt();
                of.at(radius.min(1.0))
            };
            for i in (0..STEPS).rev() {
                let at = |i: usize| i as f64 / STEPS as f64;
                rests[i] = rests[i + 1] + gauss_legendre(at(i), at(i + 1), density);
            }
        }
        Self { rests }
    }

    /// Integral along the chord whose half is `half` (in [0, 1], as a share of the radius), from `from` (in
    /// [-1, 1], as a share of that half, from its middle) to its end at 1, in units of its half.
    pub fn rest(&self, half: f64, from: f64) -> f64 {
        let onward = self.filtered(half, from.abs());
        if from < 0.0 { 2.0 * self.filtered(half, 0.0) - onward } else { onward }
    }

    fn filtered(&self, half: f64, from: f64) -> f64 {
        let cell = |v: f64| {
            let at = (v * STEPS as f64).clamp(0.0, STEPS as f64);
            let low = (at as usize).min(STEPS - 1);
            (low, at - low as f64)
        };
        let ((chord, up), (place, along)) = (cell(chord_share(half)), cell(from));
        let row = |chord: usize| {
            let start = chord * (STEPS + 1) + place;
            (1.0 - along) * self.rests[start] + along * self.rests[start + 1]
        };
        (1.0 - up) * row(chord) + up * row(chord + 1)
    }
}

/// Place of a chord among all, from 0 for those at the rim to 1 for those through the middle: even in half its
/// length near the rim, and in its distance from the middle near that, where densities change as these do.
pub fn chord_share(half: f64) -> f64 {
    0.5 * (1.0 + half - (1.0 - half * half).max(0.0).sqrt())
}

/// The inverse of [`chord_share`].
pub fn half_of_share(share: f64) -> f64 {
    let difference = 2.0 * share - 1.0;
    (0.5 * (difference + (2.0 - difference * difference).sqrt())).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precompute::optical_depth::{CrossSection, PlyLine};
    use crate::precompute::table_error::places;
    use crate::yarn::presets;

    #[test]
    fn shares_of_chords_go_there_and_back() {
        for i in 0..=100 {
            let share = f64::from(i) / 100.0;
            assert!((chord_share(half_of_share(share)) - share).abs() < 1e-8, "{share}");
        }
        assert_eq!((chord_share(0.0), chord_share(1.0)), (0.0, 1.0));
    }

    #[test]
    fn chords_agree_with_integrals_along_their_lines() {
        for name in presets::yarn_names() {
            let yarn = presets::yarn(name).unwrap();
            let section = CrossSection::new(&yarn);
            let chords = ChordTable::new(&section.density);
            let (radius, half_axis) = (yarn.outer_radius_mm(), yarn.ellipse_short_mm);
            let (mut met, mut worst) = (0, 0f64);
            for (position, direction) in places(20_000) {
                let Some(line) = PlyLine::new(&section, 0, position * radius, direction) else { continue };
                let (exact, fast) = (line.depth_mm(0.0, f64::INFINITY), line.depth_by(&chords));
                worst = worst.max((exact - fast).abs() / half_axis);
                met += usize::from(exact > 0.0);
            }
            println!("{name}: {worst:.1e}");
            assert!(met > 3000 && worst < 5e-4, "{name}: {met} chords, off by {worst}");
        }
    }
}
