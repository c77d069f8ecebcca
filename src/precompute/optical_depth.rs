//! Fiber density met by a straight line through a yarn's cross-section (Wu & Yuksel 2019, Sec. 4.1).

use crate::math::quadrature::gauss_legendre;
use crate::yarn::density::fiber_density;
use crate::yarn::params::YarnParams;
use glam::DVec2;
use std::f64::consts::TAU;

/// Integral over distance, from `position` outward along the unit `direction`, of the sum of all
/// plies' densities p(R); in mm. Ply 0 lies at (ply offset, 0); all positions in mm.
pub fn optical_depth_mm(yarn: &YarnParams, position: DVec2, direction: DVec2) -> f64 {
    (0..yarn.ply_count).map(|ply| ply_depth_mm(yarn, ply, position, direction)).sum()
}

fn ply_depth_mm(yarn: &YarnParams, ply: u32, position: DVec2, direction: DVec2) -> f64 {
    // Into the ply's frame, scaled so that its ellipse is the unit circle.
    let (sin, cos) = (TAU * f64::from(ply) / f64::from(yarn.ply_count)).sin_cos();
    let turn = |v: DVec2| DVec2::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x);
    let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
    let o = (turn(position) - DVec2::new(yarn.ply_offset_mm(), 0.0)) / axes;
    let d = turn(direction) / axes;

    // |o + s d|^2 = 1; s is a distance in mm because `direction` is a unit vector.
    let (a, b) = (d.length_squared(), o.dot(d));
    let discriminant = b * b - a * (o.length_squared() - 1.0);
    if discriminant <= 0.0 {
        return 0.0;
    }
    let half_chord = discriminant.sqrt() / a;
    let nearest = -b / a;
    let (start, end) = ((nearest - half_chord).max(0.0), nearest + half_chord);
    if end <= start {
        return 0.0;
    }
    let density =
        |s: f64| fiber_density((o + s * d).length().min(1.0), yarn.density_beta, yarn.density_epsilon);
    // p has a kink where the line passes the centre and bends hardest at the rim: split there.
    let turn = nearest.clamp(start, end);
    [start, turn, end]
        .windows(2)
        .filter(|w| w[1] > w[0])
        .map(|w| {
            let rim = 0.9 * (w[1] - w[0]);
            let cut = if w[0] == turn { w[0] + rim } else { w[1] - rim };
            gauss_legendre(w[0], cut, density) + gauss_legendre(cut, w[1], density)
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yarn::density::density_mass_mm2;
    use crate::yarn::presets;

    #[test]
    fn parallel_lines_add_up_to_the_whole_mass() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let outer = yarn.outer_radius_mm();
        for angle in [0.0, 0.4, 2.0] {
            let direction = DVec2::from_angle(angle);
            let n = 4000;
            let width = 2.0 * outer / f64::from(n);
            let sum: f64 = (0..n)
                .map(|i| {
                    let across = -outer + (f64::from(i) + 0.5) * width;
                    let start = -2.0 * outer * direction + across * direction.perp();
                    optical_depth_mm(&yarn, start, direction) * width
                })
                .sum();
            let mass = f64::from(yarn.ply_count) * density_mass_mm2(&yarn);
            assert!((sum / mass - 1.0).abs() < 2e-3, "angle {angle}: {sum} vs {mass}");
        }
    }

    #[test]
    fn one_line_agrees_with_a_fine_sum_and_outside_is_clear() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let (position, direction) = (DVec2::new(0.1, 0.05), DVec2::from_angle(1.1));
        let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
        let density_at = |q: DVec2| -> f64 {
            (0..yarn.ply_count)
                .map(|ply| {
                    let turn = DVec2::from_angle(-TAU * f64::from(ply) / f64::from(yarn.ply_count));
                    let r = (turn.rotate(q) - DVec2::new(yarn.ply_offset_mm(), 0.0)) / axes;
                    fiber_density(r.length(), yarn.density_beta, yarn.density_epsilon)
                })
                .sum()
        };
        let n = 400_000;
        let step = 2.0 / f64::from(n);
        let sum: f64 =
            (0..n).map(|i| density_at(position + (f64::from(i) + 0.5) * step * direction) * step).sum();
        let depth = optical_depth_mm(&yarn, position, direction);
        assert!((depth / sum - 1.0).abs() < 2e-3, "{depth} vs {sum}");
        assert_eq!(optical_depth_mm(&yarn, DVec2::new(5.0, 0.0), DVec2::X), 0.0);
    }
}
