//! Tables of the factors by which fiber scattering departs from closed forms; read by
//! `glsl/bsdf/khungurn.glsl` and `bsdf::khungurn::tabulated`.

use crate::bsdf::khungurn::tabulated::{
    ambient_position, gaussian_normaliser, grazing_moment, normaliser_cosine, through_moment,
};
use crate::bsdf::khungurn::{FiberScattering, ambient_integrals, concentration, longitudinal_normaliser};
use crate::math::special::i0e;
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::RangeInclusive;

/// Entries that a table may have.
pub const ENTRIES: RangeInclusive<u32> = 4..=1024;

/// The tables of both lobes of one kind of fiber.
#[derive(Clone, Debug, PartialEq)]
pub struct ScatteringTable {
    /// Entries of each lobe.
    pub entries: u32,
    /// R's entries, then TT's: factors of G at `normaliser_position`, and at `ambient_position` the integral of
    /// M cos^2 and the factors of its grazing part and of the rest.
    pub values: Vec<[f32; 4]>,
}

/// Bakes both lobes' tables. `entries` is brought into [`ENTRIES`].
pub fn bake(fiber: &FiberScattering, entries: u32) -> ScatteringTable {
    let mut values = bake_lobe(fiber.beta_r, entries);
    let entries = values.len() as u32;
    values.extend(bake_lobe(fiber.beta_tt, entries));
    ScatteringTable { entries, values }
}

/// gamma_TT^-2, and 1 / (2 pi exp(-k) I0(k)) of it: what the transmitted lobe's azimuth needs.
pub fn azimuthal_constants(fiber: &FiberScattering) -> (f64, f64) {
    let k = concentration(fiber.gamma_tt);
    (k, 1.0 / (TAU * i0e(k)))
}

/// The table of one lobe of this width in radians. `entries` is brought into [`ENTRIES`].
pub fn bake_lobe(width: f64, entries: u32) -> Vec<[f32; 4]> {
    let entries = entries.clamp(*ENTRIES.start(), *ENTRIES.end());
    let entry = |index: u32| {
        let position = f64::from(index) / f64::from(entries - 1);
        let [all, grazing, through] = ambient_factors(position, width);
        [normaliser_factor(position, width), all, grazing, through].map(|factor| factor as f32)
    };
    (0..entries).into_par_iter().map(entry).collect()
}

/// What an entry at `position`, 0 to 1, holds of G.
pub fn normaliser_factor(position: f64, width: f64) -> f64 {
    let cos_i = normaliser_cosine(position, width);
    longitudinal_normaliser(cos_i.acos(), width) / gaussian_normaliser(cos_i, width)
}

/// What it holds of light from everywhere: the integral of M cos^2, and factors of its grazing part and of the rest.
pub fn ambient_factors(position: f64, width: f64) -> [f64; 3] {
    let x_o = ambient_distance(position, width);
    let cos_o = x_o.sin();
    let [all, grazing, through] = ambient_integrals(FRAC_PI_2 - x_o, width);
    [all, grazing / grazing_moment(cos_o, width), through / through_moment(cos_o, width)]
}

/// Halvings that bring the bracket below down to a double's last bit.
const HALVINGS: u32 = 54;

/// The distance from the pole, radians, that `ambient_position` puts at `position`.
fn ambient_distance(position: f64, width: f64) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    // Exact at both ends, which halving only approaches.
    if position <= 0.0 || position >= 1.0 {
        return if position > 0.0 { high } else { low };
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if ambient_position(middle, width) < position {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::khungurn::longitudinal;
    use crate::bsdf::khungurn::tabulated::DEFAULT_ENTRIES;
    use crate::bsdf::khungurn::tabulated::{self, TabulatedLobe};

    const WIDTHS_DEG: [f64; 12] = [0.5, 1.0, 2.0, 3.5, 5.0, 7.0, 10.0, 14.0, 20.0, 30.0, 40.0, 60.0];

    /// Worst error of G, of the integral of M cos^2, of its grazing part and of the rest, each as a share of the
    /// value, of which no less than 1e-4 of the largest counts, or of the range over theta where that is less.
    fn worst(width: f64, table: &[[f32; 4]]) -> [f64; 4] {
        let lobe = TabulatedLobe { width, table };
        let rows: Vec<([f64; 4], [f64; 4])> = (0..=500)
            .map(|i| {
                let x = width * ((1.0 + FRAC_PI_2 / width).powf(f64::from(i) / 500.0) - 1.0);
                let theta = FRAC_PI_2 - x;
                let [all, grazing, through] = tabulated::ambient_integrals(x, x.sin(), lobe);
                // M at its peak is g / G.
                let peak = longitudinal(0.0, theta, width, 0.0);
                let g = peak / tabulated::longitudinal(0.0, x.sin(), 0.0, lobe);
                let [a, b, d] = ambient_integrals(theta, width);
                ([g, all, grazing, through], [1.0, a, b, d])
            })
            .collect();
        std::array::from_fn(|n| {
            let exact = || rows.iter().map(|(_, exact)| exact[n]);
            let peak = exact().fold(0.0, f64::max);
            // G stands for itself: it is compared as a ratio.
            let range = if n == 0 { 1.0 } else { peak - exact().fold(f64::INFINITY, f64::min) };
            let error = |(found, exact): &([f64; 4], [f64; 4])| {
                (found[n] - exact[n]).abs() / exact[n].max(1e-4 * peak).min(range)
            };
            rows.iter().map(error).fold(0.0, f64::max)
        })
    }

    #[test]
    fn tables_of_the_default_size_are_within_a_thousandth_of_every_value() {
        for width_deg in WIDTHS_DEG {
            let width = width_deg.to_radians();
            let found = worst(width, &bake_lobe(width, DEFAULT_ENTRIES));
            println!("width {width_deg}: {:.1e}", found.into_iter().fold(0.0, f64::max));
            assert!(found.iter().all(|error| *error < 1e-3), "width {width_deg}: {found:?}");
            let coarse = worst(width, &bake_lobe(width, 8));
            assert!(coarse.iter().any(|error| *error > 1e-3), "width {width_deg}: {coarse:?} at 8 entries");
        }
    }

    #[test]
    fn both_lobes_are_baked_and_sizes_are_kept_within_their_range() {
        let colour = glam::DVec3::ONE;
        let fiber = FiberScattering { c_r: colour, c_tt: colour, beta_r: 0.1, beta_tt: 0.3, gamma_tt: 0.2 };
        let table = bake(&fiber, 16);
        assert_eq!((table.entries, table.values.len()), (16, 32));
        assert_eq!(table.values[..16], bake_lobe(0.1, 16)[..]);
        assert_eq!(table.values[16..], bake_lobe(0.3, 16)[..]);
        assert_eq!(bake(&fiber, 0).entries, 4);
        assert_eq!(bake(&fiber, u32::MAX).entries, 1024);
    }

    #[test]
    fn distances_invert_positions() {
        for width_deg in WIDTHS_DEG {
            let width = width_deg.to_radians();
            assert_eq!([0.0, 1.0].map(|p| ambient_distance(p, width)), [0.0, FRAC_PI_2]);
            for i in 0..=64 {
                let position = f64::from(i) / 64.0;
                let back = ambient_position(ambient_distance(position, width), width);
                assert!((back - position).abs() < 1e-12, "width {width_deg}: {position} came back as {back}");
            }
        }
    }
}
