//! Ambient occlusion by place in a yarn's cross-section (Wu & Yuksel 2019, Sec. 4.2 and Fig. 8b); reading it is
//! the twin of `glsl/shading/occlusion.glsl`.

use super::chord_table::ChordTable;
use super::optical_depth::{CrossSection, flat_ply_angles, optical_depth_mm, ply_tangent_angles};
use super::table::{filtered, node, node_coordinate};
use crate::math::quadrature::gauss_legendre;
use crate::yarn::params::YarnParams;
use glam::DVec2;
use half::f16;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Texels across a table where nothing is said, and that is enough ([`super::occlusion_size`]).
pub const OCCLUSION_ACROSS: u32 = 256;
/// Largest error of a table of the size that is enough.
pub const OCCLUSION_LIMIT: f64 = 0.01;

/// The table: a square around the outer circle with ply 0 along +x, its outermost texels on its edges.
#[derive(Clone, Debug)]
pub struct OcclusionTable {
    /// Texels across, and up.
    pub across: u32,
    /// Row by row, from -y: share of ambient light that reaches the place, in [0, 1].
    pub visibilities: Vec<f16>,
}

/// Bakes the table of a yarn whose fibers take that much light from one another per mm of density 1
/// ([`crate::yarn::density::extinction_per_mm`]); `across` less than 2 is taken as 2.
pub fn bake_occlusion_table(yarn: &YarnParams, extinction_per_mm: f64, across: u32) -> OcclusionTable {
    let across = across.max(2);
    let section = CrossSection::new(yarn);
    let chords = ChordTable::new(&section.density);
    let row = |y: u32| -> Vec<f16> {
        let texel = |x| f16::from_f64(baked_occlusion(&section, &chords, extinction_per_mm, [x, y], across));
        (0..across).map(texel).collect()
    };
    // Mirrored about ply 0's axis the plies are themselves again.
    let half = across.div_ceil(2);
    let mut visibilities: Vec<f16> = (0..half).into_par_iter().flat_map_iter(row).collect();
    for y in half..across {
        let start = ((across - 1 - y) * across) as usize;
        visibilities.extend_from_within(start..start + across as usize);
    }
    OcclusionTable { across, visibilities }
}

/// The texel at a place of a table so many texels across.
pub fn baked_occlusion(
    section: &CrossSection<'_>,
    chords: &ChordTable,
    extinction_per_mm: f64,
    texel: [u32; 2],
    across: u32,
) -> f64 {
    let position = DVec2::from_array(texel.map(|k| 2.0 * node(k, across) - 1.0));
    let depth =
        |from: DVec2, toward: DVec2| section.lines(from, toward).map(|line| line.depth_by(chords)).sum();
    mean_visibility(section.yarn, extinction_per_mm, position, depth)
}

/// What the table stands for: the integral itself, at `position` in outer radii.
pub fn exact_occlusion(section: &CrossSection<'_>, extinction_per_mm: f64, position: DVec2) -> f64 {
    mean_visibility(section.yarn, extinction_per_mm, position, |from, toward| {
        optical_depth_mm(section, from, toward)
    })
}

/// Mean over all directions of exp(-extinction x depth) from `position` in outer radii; `depth_mm` is given it in
/// mm and a unit direction. What a line meets changes as a square root where it comes to touch a ply, so that
/// quadrature starts anew there, and at the long axes of flat plies, with nodes that crowd toward both ends of each
/// piece.
fn mean_visibility(
    yarn: &YarnParams,
    extinction_per_mm: f64,
    position: DVec2,
    depth_mm: impl Fn(DVec2, DVec2) -> f64,
) -> f64 {
    let from = position * yarn.outer_radius_mm();
    let mut angles = ply_tangent_angles(yarn, from);
    angles.extend(flat_ply_angles(yarn));
    angles.sort_by(f64::total_cmp);
    angles.extend(angles.first().map(|first| first + TAU));
    let piece = |ends: &[f64]| {
        let (start, length) = (ends[0], ends[1] - ends[0]);
        let visible = |s: f64| {
            let toward = DVec2::from_angle(start + length * s * s * (3.0 - 2.0 * s));
            length * 6.0 * s * (1.0 - s) * (-extinction_per_mm * depth_mm(from, toward)).exp()
        };
        gauss_legendre(0.0, 0.5, visible) + gauss_legendre(0.5, 1.0, visible)
    };
    angles.windows(2).map(piece).sum::<f64>() / TAU
}

/// Texture coordinates in the table for `position` in the cross-section, ply 0 along x, in outer radii. Beyond
/// the square around the outer circle they stay at its edge.
pub fn occlusion_place(position: DVec2, across: u32) -> DVec2 {
    let share = |place: f64| (0.5 + 0.5 * place).clamp(0.0, 1.0);
    DVec2::new(node_coordinate(share(position.x), across), node_coordinate(share(position.y), across))
}

/// Share of ambient light that reaches a place of the cross-section, given as [`occlusion_place`]'s.
pub fn texture_occlusion(table: &OcclusionTable, place: DVec2) -> f64 {
    filtered(&table.visibilities, [table.across; 2], place.to_array())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precompute::table_error::{TableError, places};
    use crate::yarn::density::extinction_per_mm;
    use crate::yarn::presets;

    fn error_of(table: &OcclusionTable, yarn: &YarnParams, count: u32) -> TableError {
        let section = CrossSection::new(yarn);
        let pair = |p: DVec2| {
            (
                texture_occlusion(table, occlusion_place(p, table.across)),
                exact_occlusion(&section, extinction_per_mm(yarn), p),
            )
        };
        let places: Vec<DVec2> = places(count).map(|(place, _)| place).collect();
        TableError::new(&places.into_par_iter().map(pair).collect::<Vec<_>>(), 1.0)
    }

    #[test]
    fn the_table_is_close_to_the_integral_for_every_preset() {
        for name in presets::yarn_names() {
            let yarn = presets::yarn(name).unwrap();
            let table = bake_occlusion_table(&yarn, extinction_per_mm(&yarn), OCCLUSION_ACROSS);
            let error = error_of(&table, &yarn, 2000);
            assert!(error.worst <= OCCLUSION_LIMIT, "{name}: {error:?}");
        }
    }

    #[test]
    fn finer_tables_are_closer_and_another_yarns_is_refused() {
        let yarn = presets::yarn("worsted_3ply").unwrap();
        let error =
            |across| error_of(&bake_occlusion_table(&yarn, extinction_per_mm(&yarn), across), &yarn, 2000);
        let [coarse, middle, fine] = [32, 64, 128].map(error);
        assert!(
            middle.rms < 0.5 * coarse.rms && fine.rms < 0.5 * middle.rms,
            "{coarse:?} {middle:?} {fine:?}"
        );
        let other = {
            let yarn = presets::yarn("mohair").unwrap();
            bake_occlusion_table(&yarn, extinction_per_mm(&yarn), 64)
        };
        assert!(error_of(&other, &yarn, 2000).worst > 5.0 * OCCLUSION_LIMIT);
    }

    #[test]
    fn the_directions_of_the_quadrature_are_enough() {
        for name in presets::yarn_names() {
            let yarn = presets::yarn(name).unwrap();
            let (radius, extinction, n) = (yarn.outer_radius_mm(), extinction_per_mm(&yarn), 3000);
            let section = CrossSection::new(&yarn);
            let fine = |p: DVec2| {
                let light = |i: u32| {
                    let toward = DVec2::from_angle(TAU * (f64::from(i) + 0.3) / f64::from(n));
                    (-extinction * optical_depth_mm(&section, radius * p, toward)).exp()
                };
                (0..n).map(light).sum::<f64>() / f64::from(n)
            };
            let pairs: Vec<_> = places(60)
                .map(|(p, _)| (exact_occlusion(&section, extinction_per_mm(&yarn), p), fine(p)))
                .collect();
            let error = TableError::new(&pairs, 1.0);
            assert!(error.worst <= 0.1 * OCCLUSION_LIMIT, "{name}: {error:?}");
        }
    }

    #[test]
    fn texels_of_odd_sizes_lie_where_they_are_read() {
        let yarn = presets::yarn("silk2").unwrap();
        let section = CrossSection::new(&yarn);
        for across in [2, 3, 7, 8] {
            let table = bake_occlusion_table(&yarn, extinction_per_mm(&yarn), across);
            for i in 0..across * across {
                let at = DVec2::new(node(i % across, across), node(i / across, across)) * 2.0 - 1.0;
                let read = texture_occlusion(&table, occlusion_place(at, across));
                assert!(
                    (read - exact_occlusion(&section, extinction_per_mm(&yarn), at)).abs() < 5e-4,
                    "{across}: {at}"
                );
            }
        }
        assert_eq!(bake_occlusion_table(&yarn, extinction_per_mm(&yarn), 0).visibilities.len(), 4);
    }
}
