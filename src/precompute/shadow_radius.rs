//! How wide a shadow a yarn casts.

use super::optical_depth::{CrossSection, optical_depth_mm};
use crate::math::quadrature::gauss_legendre;
use glam::DVec2;
use std::f64::consts::PI;

/// Angles of the light over which the mean is taken, and parts of the yarn's width.
const ANGLES: u32 = 16;
const PARTS: u32 = 16;

/// Radius in mm, at most the outer one, of the opaque tube that takes as much light as the yarn does, on average over
/// its twist: the integral over the yarn's half width of 1 - exp(-extinction x depth) for light across it. Wu &
/// Yuksel 2019, Sec. 4.1 takes the outer radius, where the yarn's thin rim lets nearly all light pass: in a knit
/// swatch of wool its shadow map alone took 10% too much.
pub fn shadow_radius_mm(section: &CrossSection<'_>, extinction_per_mm: f64) -> f64 {
    let outer = section.yarn.outer_radius_mm();
    let taken = |across: f64, angle: f64| {
        let toward = DVec2::from_angle(angle);
        let start = -2.0 * outer * toward + across * outer * toward.perp();
        1.0 - (-extinction_per_mm * optical_depth_mm(section, start, toward)).exp()
    };
    let over_width = |angle: f64| {
        let part = |i: u32| {
            let end = |i: u32| 2.0 * f64::from(i) / f64::from(PARTS) - 1.0;
            gauss_legendre(end(i), end(i + 1), |across| taken(across, angle))
        };
        (0..PARTS).map(part).sum::<f64>()
    };
    // Every ply's share of the turn is like the others, and each half of it the other's mirror image.
    let angle = |i: u32| PI * (f64::from(i) + 0.5) / f64::from(ANGLES * section.yarn.ply_count);
    let mean = (0..ANGLES).map(|i| over_width(angle(i))).sum::<f64>() / f64::from(ANGLES);
    (0.5 * mean).clamp(0.0, 1.0) * outer
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::density::extinction_per_mm;
    use crate::yarn::params::YarnParams;
    use crate::yarn::presets;

    #[test]
    fn dense_yarn_casts_its_outline_and_clear_yarn_nothing() {
        let round = YarnParams {
            ply_count: 1,
            yarn_radius_mm: 0.0,
            ellipse_long_mm: 0.4,
            ellipse_short_mm: 0.4,
            ..presets::yarn("cotton1").unwrap()
        };
        let section = CrossSection::new(&round);
        assert_eq!(shadow_radius_mm(&section, 0.0), 0.0);
        assert!((shadow_radius_mm(&section, 1e6) - 0.4).abs() < 2e-3);
        let thin = shadow_radius_mm(&section, 1e-3);
        let mass = crate::yarn::density::density_mass_mm2(&round);
        assert!((thin / (1e-3 * mass / 2.0) - 1.0).abs() < 0.01, "{thin}: half of what all fibers block");
    }

    #[test]
    fn shadows_of_presets_are_narrower_than_their_outline() {
        for name in presets::yarn_names() {
            let yarn = presets::yarn(name).unwrap();
            let share = shadow_radius_mm(&CrossSection::new(&yarn), extinction_per_mm(&yarn))
                / yarn.outer_radius_mm();
            println!("{name}: {share:.3}");
            assert!((0.3..0.99).contains(&share), "{name}: {share}");
        }
    }
}
