//! Ambient occlusion by distance from the yarn's centre; twin of `glsl/shading/occlusion.glsl`.

use super::optical_depth::{CrossSection, optical_depth_mm};
use crate::yarn::params::YarnParams;
use glam::{DMat4, DVec2, DVec4};
use std::f64::consts::TAU;

/// Distances, positions around the yarn and ray directions of the radial average.
const DISTANCES: u32 = 33;
const AROUND: u32 = 16;
const DIRECTIONS: u32 = 48;

/// Share of ambient light that reaches `position` (mm, ply 0 at (ply offset, 0)): the mean over
/// in-plane directions of exp(-extinction x depth). Wu & Yuksel 2019, Sec. 4.2.
pub fn ambient_visibility(section: &CrossSection<'_>, position: DVec2, extinction_per_mm: f64) -> f64 {
    let visibility = |i: u32| {
        let direction = DVec2::from_angle(TAU * (f64::from(i) + 0.5) / f64::from(DIRECTIONS));
        (-extinction_per_mm * optical_depth_mm(section, position, direction)).exp()
    };
    (0..DIRECTIONS).map(visibility).sum::<f64>() / f64::from(DIRECTIONS)
}

/// Mean of [`ambient_visibility`] over the circle at `share` of the outer radius.
fn radial_average(section: &CrossSection<'_>, share: f64, extinction_per_mm: f64) -> f64 {
    let yarn = section.yarn;
    let radius = share * yarn.outer_radius_mm();
    let at = |i: u32| {
        // One ply's share of the circle stands for all.
        let angle = TAU * (f64::from(i) + 0.5) / f64::from(AROUND * yarn.ply_count);
        ambient_visibility(section, radius * DVec2::from_angle(angle), extinction_per_mm)
    };
    (0..AROUND).map(at).sum::<f64>() / f64::from(AROUND)
}

/// Cubic in (distance / outer radius), constant term first, least-squares fitted to the radial average
/// of the visibility (Wu & Yuksel 2019, Sec. 4.2). Where the cubic leaves [0, 1] the shader clamps it.
pub fn fit_distance_occlusion(yarn: &YarnParams, extinction_per_mm: f64) -> DVec4 {
    let section = CrossSection::new(yarn);
    let (mut normal, mut right) = (DMat4::ZERO, DVec4::ZERO);
    for i in 0..DISTANCES {
        let d = f64::from(i) / f64::from(DISTANCES - 1);
        let powers = DVec4::new(1.0, d, d * d, d * d * d);
        let outer =
            DMat4::from_cols(powers * powers.x, powers * powers.y, powers * powers.z, powers * powers.w);
        normal += outer;
        right += powers * radial_average(&section, d, extinction_per_mm);
    }
    normal.inverse() * right
}

/// The fitted visibility at `distance`, a share of the outer radius.
pub fn distance_occlusion(cubic: DVec4, distance: f64) -> f64 {
    let d = distance.clamp(0.0, 1.0);
    cubic.dot(DVec4::new(1.0, d, d * d, d * d * d)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::density::extinction_per_mm;
    use crate::yarn::presets;

    #[test]
    fn the_fit_is_close_to_the_integral_it_stands_for() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let extinction = extinction_per_mm(&yarn);
        let section = CrossSection::new(&yarn);
        let cubic = fit_distance_occlusion(&yarn, extinction);
        for i in 0..=20 {
            let d = f64::from(i) / 20.0;
            let (fitted, exact) = (distance_occlusion(cubic, d), radial_average(&section, d, extinction));
            assert!((fitted - exact).abs() < 0.06, "at {d}: {fitted} vs {exact}");
        }
        assert!(distance_occlusion(cubic, 0.0) < distance_occlusion(cubic, 1.0));
    }

    #[test]
    fn clear_yarn_is_unoccluded_and_dense_yarn_is_dark_inside() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let section = CrossSection::new(&yarn);
        assert_eq!(ambient_visibility(&section, DVec2::ZERO, 0.0), 1.0);
        assert!(ambient_visibility(&section, DVec2::new(yarn.ply_offset_mm(), 0.0), 100.0) < 1e-3);
    }
}
