//! A ply as its viewer sees it: what places a core fiber and its texture; twin of `glsl/yarn/core.glsl`.

use super::detail::CORE_LEVELS;
use crate::math::frame::{direction_or, normal_perpendicular_to};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The ply's elliptical cross-section, seen along `toward`. A fiber at angle a and radius R of the ellipse
/// lies `R width cos(a - phase)` along `side` and `R (depth sin(a - phase) + shear cos(a - phase))` toward the
/// viewer: the image of a circle, whatever the ellipse and the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoreSection {
    /// Unit, perpendicular to the ply and the view.
    pub side: DVec3,
    /// Unit, perpendicular to the ply, toward the viewer.
    pub toward: DVec3,
    /// Of the ply's centre from the yarn's, along side and toward, as a share of the ply's offset.
    pub from_yarn: DVec2,
    /// In mm.
    pub width_mm: f64,
    /// In mm.
    pub depth_mm: f64,
    /// In mm.
    pub shear_mm: f64,
    /// In radians.
    pub phase: f64,
}

/// `ply_axes`: unit vectors along the ellipse's short and long half-axis, whose lengths are `ellipse_mm`.
/// `to_eye` is unit.
pub fn core_section(
    ply_axes: [DVec3; 2],
    ply_tangent: DVec3,
    to_eye: DVec3,
    ellipse_mm: DVec2,
) -> CoreSection {
    let toward = normal_perpendicular_to(ply_tangent, to_eye);
    let side = toward.cross(ply_tangent);
    let s = DVec2::new(side.dot(ply_axes[0]), side.dot(ply_axes[1]));
    let d = DVec2::new(toward.dot(ply_axes[0]), toward.dot(ply_axes[1]));
    let stretched = ellipse_mm * s;
    let width_mm = stretched.length().max(1e-30);
    CoreSection {
        side,
        toward,
        from_yarn: DVec2::new(s.x, d.x),
        width_mm,
        depth_mm: ellipse_mm.x * ellipse_mm.y * s.perp_dot(d) / width_mm,
        shear_mm: stretched.dot(ellipse_mm * d) / width_mm,
        phase: stretched.y.atan2(stretched.x),
    }
}

/// Direction in which the core's strip runs: the ply's, without what is not continuous from one piece of yarn to
/// the next (the rate of twist by the curve's own parameter, and its second derivative), or strips would part.
pub fn core_axis(ply_axes: [DVec3; 2], ply_turns_per_mm: f64, ply_offset_mm: f64) -> DVec3 {
    let yarn_tangent = ply_axes[0].cross(ply_axes[1]);
    direction_or(yarn_tangent + TAU * ply_turns_per_mm * ply_offset_mm * ply_axes[1], yarn_tangent)
}

/// Where in a turn the texture is read, in turns. Wu & Yuksel 2019, Eq. 3, derived anew: as printed it has a
/// pole where plies and fibers twist alike. What a viewer sees turn is the fibers' angle in the ply's frame
/// less the direction from which the ply is seen in that frame.
pub fn core_turns(fiber_twist: f64, phase: f64) -> f64 {
    (fiber_twist - phase) / TAU
}

/// `turns` moved by whole turns to within half a turn of `expected`.
pub fn nearest_turn(turns: f64, expected: f64) -> f64 {
    turns - (turns - expected).round_ties_even()
}

/// Distance of the farthest fiber that the core stands for from the ply's centre, as a share of the ellipse,
/// at a place in its levels.
pub fn core_thickness(level: f64, thickness: &[f64; CORE_LEVELS as usize]) -> f64 {
    let place = level.clamp(0.0, f64::from(CORE_LEVELS - 1));
    let low = (place as usize).min(CORE_LEVELS as usize - 2);
    let t = place - low as f64;
    (1.0 - t) * thickness[low] + t * thickness[low + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ellipse_is_seen_as_a_circle_from_everywhere() {
        let axes = [DVec3::X, DVec3::Y];
        let ellipse = DVec2::new(0.3, 0.5);
        for view in 0..24 {
            let angle = TAU * f64::from(view) / 24.0;
            let to_eye = DVec3::new(angle.cos(), angle.sin(), 0.4).normalize();
            let seen = core_section(axes, DVec3::Z, to_eye, ellipse);
            assert!(seen.depth_mm > 0.0 && seen.toward.dot(to_eye) > 0.0);
            for fiber in 0..24 {
                let a = TAU * f64::from(fiber) / 24.0;
                let p = DVec3::new(ellipse.x * a.cos(), ellipse.y * a.sin(), 0.0);
                let (c, s) = ((a - seen.phase).cos(), (a - seen.phase).sin());
                assert!((p.dot(seen.side) - seen.width_mm * c).abs() < 1e-12);
                assert!((p.dot(seen.toward) - seen.depth_mm * s - seen.shear_mm * c).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn turns_are_those_of_a_round_ply_and_have_no_pole() {
        let axes = |ply: f64| [DVec3::new(ply.cos(), ply.sin(), 0.0), DVec3::new(-ply.sin(), ply.cos(), 0.0)];
        let seen = |ply: f64| core_section(axes(ply), DVec3::Z, DVec3::X, DVec2::splat(0.4));
        // Where fibers turn against their ply as fast as it turns, what is seen stands still.
        for step in 0..40 {
            let ply = 0.37 * f64::from(step);
            let turns = core_turns(-ply, seen(ply).phase);
            assert!((nearest_turn(turns, core_turns(0.0, seen(0.0).phase)) - 0.25).abs() < 1e-9, "{turns}");
        }
    }

    #[test]
    fn thickness_runs_through_its_levels() {
        let thickness = [0.0, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0];
        assert_eq!(core_thickness(0.0, &thickness), 0.0);
        assert!((core_thickness(1.5, &thickness) - 0.3).abs() < 1e-12);
        assert_eq!(core_thickness(7.0, &thickness), 1.0);
        assert_eq!(core_thickness(9.0, &thickness), 1.0);
    }
}
