//! Ambient occlusion by distance from the yarn's centre; twin of `glsl/shading/occlusion.glsl`.

use super::optical_depth::{CrossSection, optical_depth_mm};
use glam::{DMat4, DVec2, DVec4};
use std::f64::consts::TAU;

/// Distances, positions around the yarn and ray directions of the radial average.
const DISTANCES: u32 = 33;
const AROUND: u32 = 16;
const DIRECTIONS: u32 = 48;

/// Ambient light by distance from a yarn's centre: cubics in (distance / outer radius), constant term first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionFit {
    /// Share of it that arrives. Where the cubic leaves [0, 1] the shader clamps it.
    pub visibility: DVec4,
    /// How much more of it comes from outside than from the other side: 0 where both are alike.
    pub lean: DVec4,
}

/// Share of ambient light that reaches `position` (mm, ply 0 at (ply offset, 0)): the mean over
/// in-plane directions of exp(-extinction x depth). Wu & Yuksel 2019, Sec. 4.2.
pub fn ambient_visibility(section: &CrossSection<'_>, position: DVec2, extinction_per_mm: f64) -> f64 {
    seen(section, position, DVec2::X, extinction_per_mm).x
}

/// That, and how much more of it comes from `outward` (unit) than from the other side: twice the mean of the same times
/// the cosine of the angle from there, so that visibility by direction is about its mean plus this times that cosine.
fn seen(section: &CrossSection<'_>, position: DVec2, outward: DVec2, extinction_per_mm: f64) -> DVec2 {
    let along = |i: u32| {
        let direction = DVec2::from_angle(TAU * (f64::from(i) + 0.5) / f64::from(DIRECTIONS));
        let visibility = (-extinction_per_mm * optical_depth_mm(section, position, direction)).exp();
        visibility * DVec2::new(1.0, 2.0 * direction.dot(outward))
    };
    (0..DIRECTIONS).map(along).sum::<DVec2>() / f64::from(DIRECTIONS)
}

/// Mean of `of`, given a place in mm and the unit direction to it from the yarn's centre, over the circle at `share` of
/// the outer radius.
fn radial_average(section: &CrossSection<'_>, share: f64, of: &impl Fn(DVec2, DVec2) -> DVec2) -> DVec2 {
    let yarn = section.yarn;
    let radius = share * yarn.outer_radius_mm();
    let at = |i: u32| {
        // One ply's share of the circle stands for all.
        let angle = TAU * (f64::from(i) + 0.5) / f64::from(AROUND * yarn.ply_count);
        let outward = DVec2::from_angle(angle);
        of(radius * outward, outward)
    };
    (0..AROUND).map(at).sum::<DVec2>() / f64::from(AROUND)
}

/// Least-squares fits to the radial averages (Wu & Yuksel 2019, Sec. 4.2).
pub fn fit_occlusion(section: &CrossSection<'_>, extinction_per_mm: f64) -> OcclusionFit {
    let (mut normal, mut visible, mut leaning) = (DMat4::ZERO, DVec4::ZERO, DVec4::ZERO);
    for i in 0..DISTANCES {
        let d = f64::from(i) / f64::from(DISTANCES - 1);
        let powers = DVec4::new(1.0, d, d * d, d * d * d);
        let outer =
            DMat4::from_cols(powers * powers.x, powers * powers.y, powers * powers.z, powers * powers.w);
        normal += outer;
        let at = |position, outward| seen(section, position, outward, extinction_per_mm);
        let mean = radial_average(section, d, &at);
        visible += powers * mean.x;
        leaning += powers * mean.y;
    }
    let inverse = normal.inverse();
    OcclusionFit { visibility: inverse * visible, lean: inverse * leaning }
}

/// The fitted visibility at `distance`, a share of the outer radius.
pub fn distance_occlusion(cubic: DVec4, distance: f64) -> f64 {
    let d = distance.clamp(0.0, 1.0);
    cubic.dot(DVec4::new(1.0, d, d * d, d * d * d)).clamp(0.0, 1.0)
}

/// Share of ambient light that a fiber reflects, of which `visibility` reaches it from all around: R's azimuthal lobe,
/// cos(phi / 2) about the viewer, has a third of what leans toward there. `facing` is the cosine of the angle between
/// the way out of the yarn and the viewer, `distance` the fiber's from the yarn's centre as a share of the outer radius.
pub fn reflected_occlusion(visibility: f64, lean: DVec4, distance: f64, facing: f64) -> f64 {
    let d = distance.clamp(0.0, 1.0);
    let leaning = lean.dot(DVec4::new(1.0, d, d * d, d * d * d));
    (visibility + leaning * facing / 3.0).clamp(0.0, 1.0)
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
        let seen =
            |position: DVec2, _: DVec2| DVec2::splat(ambient_visibility(&section, position, extinction));
        let cubic = fit_occlusion(&section, extinction).visibility;
        for i in 0..=20 {
            let d = f64::from(i) / 20.0;
            let (fitted, exact) = (distance_occlusion(cubic, d), radial_average(&section, d, &seen).x);
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

    /// Against the mean over R's lobe itself, about a viewer to any side.
    #[test]
    fn what_is_reflected_is_what_the_lobe_sees() {
        for name in ["worsted_3ply", "rayon1"] {
            let yarn = presets::yarn(name).unwrap();
            let (section, extinction) = (CrossSection::new(&yarn), extinction_per_mm(&yarn));
            let lean = fit_occlusion(&section, extinction).lean;
            let (mut worst, mut without) = (0f64, 0f64);
            for distance in [0.0, 0.3, 0.6, 0.9, 1.0] {
                for viewer in 0..8 {
                    let viewer = TAU * f64::from(viewer) / 8.0;
                    let lobe = |position: DVec2, outward: DVec2| {
                        let n = 96;
                        let light = |i: u32| {
                            let phi = TAU * ((f64::from(i) + 0.5) / f64::from(n) - 0.5);
                            let toward = DVec2::from_angle(viewer + phi).rotate(outward);
                            let depth = optical_depth_mm(&section, position, toward);
                            (0.5 * phi).cos() * (-extinction * depth).exp()
                        };
                        DVec2::splat((0..n).map(light).sum::<f64>() * TAU / f64::from(n) / 4.0)
                    };
                    let exact = radial_average(&section, distance, &lobe).x;
                    let all = |position, outward| seen(&section, position, outward, extinction);
                    let all = radial_average(&section, distance, &all).x;
                    let found = reflected_occlusion(all, lean, distance, viewer.cos());
                    worst = worst.max((found - exact).abs());
                    without = without.max((all - exact).abs());
                }
            }
            println!("{name}: {worst:.3}, without {without:.3}");
            assert!(worst < 0.05 && without > 2.0 * worst, "{name}: {worst}, without the lean {without}");
        }
    }
}
