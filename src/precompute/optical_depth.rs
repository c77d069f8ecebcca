//! Fiber density met by a straight line through a yarn's cross-section (Wu & Yuksel 2019, Sec. 4.1).

use super::chord_table::ChordTable;
use crate::math::quadrature::gauss_legendre;
use crate::yarn::migrated_density::MigratedDensity;
use crate::yarn::params::YarnParams;
use glam::DVec2;
use std::f64::consts::TAU;

/// A yarn and how dense its fibers are across it.
#[derive(Clone, Debug)]
pub struct CrossSection<'a> {
    /// The yarn.
    pub yarn: &'a YarnParams,
    /// That of each of its plies, over the radius.
    pub density: MigratedDensity,
}

impl<'a> CrossSection<'a> {
    /// That of a yarn.
    pub fn new(yarn: &'a YarnParams) -> Self {
        Self { yarn, density: MigratedDensity::new(yarn) }
    }

    /// The parts that lie in its plies of the line through `position` (mm) along the unit `direction`, both ways.
    pub fn lines(&self, position: DVec2, direction: DVec2) -> impl Iterator<Item = PlyLine<'_>> {
        (0..self.yarn.ply_count).filter_map(move |ply| PlyLine::new(self, ply, position, direction))
    }
}

/// Integral over distance, from `position` outward along the unit `direction`, of the sum of all
/// plies' densities; in mm. Ply 0 lies at (ply offset, 0); all positions in mm.
pub fn optical_depth_mm(section: &CrossSection<'_>, position: DVec2, direction: DVec2) -> f64 {
    section.lines(position, direction).map(|line| line.depth_mm(0.0, f64::INFINITY)).sum()
}

/// The part of a line that lies in one ply.
pub struct PlyLine<'a> {
    /// Where the line starts and how it goes on per mm, in the ply's frame scaled so that its ellipse is the
    /// unit circle.
    origin: DVec2,
    step: DVec2,
    /// Distance in mm along the line to where it passes the ply's centre.
    nearest_mm: f64,
    /// Half of the chord's length, and that in the scaled frame.
    half_chord_mm: f64,
    half_chord: f64,
    density: &'a MigratedDensity,
}

impl<'a> PlyLine<'a> {
    /// The line through `position` (mm) along the unit `direction`, both ways; `None` where it misses the ply.
    pub fn new(section: &'a CrossSection<'_>, ply: u32, position: DVec2, direction: DVec2) -> Option<Self> {
        let yarn = section.yarn;
        let (sin, cos) = (TAU * f64::from(ply) / f64::from(yarn.ply_count)).sin_cos();
        let turn = |v: DVec2| DVec2::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x);
        let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
        let origin = (turn(position) - DVec2::new(yarn.ply_offset_mm(), 0.0)) / axes;
        let step = turn(direction) / axes;

        // |origin + s step|^2 = 1; s is a distance in mm because `direction` is a unit vector. The distance
        // from the centre is taken as it is: b^2 - a c loses it in the difference.
        let (a, b) = (step.length_squared(), origin.dot(step));
        let closest_squared = step.perp_dot(origin).powi(2) / a;
        let half_chord = (1.0 - closest_squared).max(0.0).sqrt();
        (half_chord > 0.0).then(|| Self {
            origin,
            step,
            nearest_mm: -b / a,
            half_chord_mm: half_chord / a.sqrt(),
            half_chord,
            density: &section.density,
        })
    }

    /// Integral of the ply's density over the distances `start_mm` to `end_mm` along the line.
    pub fn depth_mm(&self, start_mm: f64, end_mm: f64) -> f64 {
        let (near, half) = (self.nearest_mm, self.half_chord_mm);
        let (start, end) = (start_mm.max(near - half), end_mm.min(near + half));
        let density = |s: f64| self.density.at((self.origin + s * self.step).length().min(1.0));
        // It has kinks where the line passes the centre and the radius from which on all fibers are at times farther
        // in, and bends hardest at the rim: split there.
        let kink = self.density.kink();
        let kink_half = half * (1.0 - (1.0 - kink * kink) / self.half_chord.powi(2)).max(0.0).sqrt();
        let (inner, outer) = (kink_half.min(0.9 * half), kink_half.max(0.9 * half));
        let (mut sum, mut from) = (0.0, start);
        for cut in [near - outer, near - inner, near, near + inner, near + outer, end] {
            if from < cut.min(end) {
                sum += gauss_legendre(from, cut.min(end), density);
                from = cut.min(end);
            }
        }
        sum
    }

    /// [`Self::depth_mm`] from the line's start onward, by a table of the yarn's chords.
    pub fn depth_by(&self, chords: &ChordTable) -> f64 {
        let from = (-self.nearest_mm / self.half_chord_mm).clamp(-1.0, 1.0);
        self.half_chord_mm * chords.rest(self.half_chord, from)
    }
}

/// Angles in radians, two for each ply, at which directions from `position` (mm) begin and cease to meet the
/// ply; from inside of it, those at right angles to the way out. Between them what a line meets is smooth.
pub fn ply_tangent_angles(yarn: &YarnParams, position: DVec2) -> Vec<f64> {
    let axes = DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm);
    let of_ply = |ply: u32| {
        let ply_angle = DVec2::from_angle(TAU * f64::from(ply) / f64::from(yarn.ply_count));
        let origin = (DVec2::new(ply_angle.dot(position), ply_angle.perp_dot(position))
            - DVec2::new(yarn.ply_offset_mm(), 0.0))
            / axes;
        let toward = -origin.try_normalize().unwrap_or(DVec2::X);
        let half = (1.0 / origin.length().max(1.0)).asin();
        [half, -half].map(|side| ply_angle.rotate(DVec2::from_angle(side).rotate(toward) * axes).to_angle())
    };
    (0..yarn.ply_count).flat_map(of_ply).collect()
}

/// Ratio of a ply's half-axes from which on its ellipse counts as flat.
const FLAT: f64 = 2.0;

/// Angles in radians, two for each ply that is flat, of its long axis: within so small a share of the turn as the ply is
/// flat, what a line from inside of it meets grows from little to much there.
pub fn flat_ply_angles(yarn: &YarnParams) -> Vec<f64> {
    let (short, long) = (yarn.ellipse_short_mm, yarn.ellipse_long_mm);
    let axis = if long > short { DVec2::Y } else { DVec2::X };
    let plies = if (long / short).max(short / long) > FLAT { yarn.ply_count } else { 0 };
    let of_ply = |ply: u32| {
        let along = DVec2::from_angle(TAU * f64::from(ply) / f64::from(yarn.ply_count)).rotate(axis);
        [along.to_angle(), (-along).to_angle()]
    };
    (0..plies).flat_map(of_ply).collect()
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
        let section = CrossSection::new(&yarn);
        for angle in [0.0, 0.4, 2.0] {
            let direction = DVec2::from_angle(angle);
            let n = 4000;
            let width = 2.0 * outer / f64::from(n);
            let sum: f64 = (0..n)
                .map(|i| {
                    let across = -outer + (f64::from(i) + 0.5) * width;
                    let start = -2.0 * outer * direction + across * direction.perp();
                    optical_depth_mm(&section, start, direction) * width
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
        let section = CrossSection::new(&yarn);
        let density_at = |q: DVec2| -> f64 {
            (0..yarn.ply_count)
                .map(|ply| {
                    let turn = DVec2::from_angle(-TAU * f64::from(ply) / f64::from(yarn.ply_count));
                    let r = (turn.rotate(q) - DVec2::new(yarn.ply_offset_mm(), 0.0)) / axes;
                    section.density.at(r.length())
                })
                .sum()
        };
        let n = 400_000;
        let step = 2.0 / f64::from(n);
        let sum: f64 =
            (0..n).map(|i| density_at(position + (f64::from(i) + 0.5) * step * direction) * step).sum();
        let depth = optical_depth_mm(&section, position, direction);
        assert!((depth / sum - 1.0).abs() < 2e-3, "{depth} vs {sum}");
        assert_eq!(optical_depth_mm(&section, DVec2::new(5.0, 0.0), DVec2::X), 0.0);
    }

    #[test]
    fn directions_beside_a_tangent_just_meet_and_just_miss_the_ply() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let section = CrossSection::new(&yarn);
        for position in [DVec2::new(2.0, 0.3), DVec2::new(-1.0, 1.5), DVec2::new(0.1, -3.0)] {
            let angles = ply_tangent_angles(&yarn, position);
            assert_eq!(angles.len(), 6);
            for (ply, pair) in (0..).zip(angles.chunks_exact(2)) {
                let meets =
                    |angle: f64| PlyLine::new(&section, ply, position, DVec2::from_angle(angle)).is_some();
                assert!(meets(pair[0] - 1e-6) && !meets(pair[0] + 1e-6), "ply {ply} from {position}");
                assert!(meets(pair[1] + 1e-6) && !meets(pair[1] - 1e-6), "ply {ply} from {position}");
            }
        }
    }
}
