//! How much fiber light passes on its way into a yarn, ply by ply, where plies are too thin, too peaked or too abrupt for
//! the table over the whole cross-section ([`super::self_shadow`], [`crate::yarn::inside::fits_table`]): what a line
//! meets of a ply depends on no more than how far from the ply's axis it passes and where on it one is; twin of
//! `glsl/shading/chord_shadow.glsl`.

use super::chord_table::{ChordTable, half_of_share};
use super::optical_depth::CrossSection;
use super::table::{filtered, node, node_coordinate};
use super::table_error::TableError;
use crate::yarn::params::YarnParams;
use glam::{DVec2, DVec3};
use half::f16;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Chords of a ply that the table holds, and places along each.
const CHORDS: u32 = 256;
const ALONG: u32 = 256;

/// What it keeps within, as shares of the yarn's largest depth.
pub const CHORD_LIMIT: TableError = TableError { rms: 5e-4, p99: 3e-3, worst: 0.01 };

/// The table of one ply. Texels are samples for linear filtering, the first and last of each side on its ends.
#[derive(Clone, Debug)]
pub struct ChordShadow {
    /// Chord by chord from the rim to the middle, from the end away from the light to the one nearest to it: the
    /// density that is left of the chord, in units of its half.
    pub rests: Vec<f16>,
}

/// What is to be known of a yarn's plies, in outer radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plies {
    /// How many.
    pub count: u32,
    /// Distance of each one's centre from the yarn's.
    pub offset: f64,
    /// Half-axes, the one toward the yarn's centre first.
    pub axes: DVec2,
    /// Unit vector at the angle from each ply to the next.
    pub turn: DVec2,
}

impl Plies {
    /// Those of a yarn.
    pub fn new(yarn: &YarnParams) -> Self {
        let radius = yarn.outer_radius_mm();
        Self {
            count: yarn.ply_count,
            offset: yarn.ply_offset_mm() / radius,
            axes: DVec2::new(yarn.ellipse_short_mm, yarn.ellipse_long_mm) / radius,
            turn: DVec2::from_angle(TAU / f64::from(yarn.ply_count)),
        }
    }
}

/// Bakes the table of a yarn.
pub fn bake_chord_shadow(yarn: &YarnParams) -> ChordShadow {
    let chords = ChordTable::new(&CrossSection::new(yarn).density);
    let row = |chord: u32| {
        let half = half_of_share(node(chord, CHORDS));
        let chords = &chords;
        (0..ALONG).map(move |place| f16::from_f64(chords.rest(half, 2.0 * node(place, ALONG) - 1.0)))
    };
    ChordShadow { rests: (0..CHORDS).into_par_iter().flat_map_iter(row).collect() }
}

impl ChordShadow {
    /// Width, height and depth of the texture: a volume of one slice, so that it is bound where the other table is.
    pub const EXTENT: [u32; 3] = [ALONG, CHORDS, 1];
}

/// The chord of a ply on the line from `position` toward the light, the unit vector `toward`, both in the ply's frame:
/// place in the table along it and among chords, each from 0 to 1, and its half's length, 0 where the line misses the
/// ply.
pub fn ply_chord(position: DVec2, toward: DVec2, offset: f64, axes: DVec2) -> DVec3 {
    let from_center = position - DVec2::new(offset, 0.0);
    let width = DVec2::new(axes.y * toward.x, axes.x * toward.y).length();
    let closest = toward.perp_dot(from_center).abs() / width;
    let half = ((1.0 - closest) * (1.0 + closest)).max(0.0).sqrt();
    let passed = from_center.x / axes.x * (axes.y * toward.x) + from_center.y / axes.y * (axes.x * toward.y);
    let along = if half > 0.0 { (passed / (width * half)).clamp(-1.0, 1.0) } else { 1.0 };
    DVec3::new(0.5 + 0.5 * along, 0.5 * (1.0 + half - closest.min(1.0)), half * axes.x * axes.y / width)
}

/// Optical depth toward the light for light across the yarn, in units of the outer radius, of a fiber at `position` in
/// the cross-section (ply 0 along x, in outer radii); `light` is the projection there of the direction toward the light,
/// of any length; where it has none, ply 0's direction stands for it.
pub fn chord_depth(table: &ChordShadow, position: DVec2, light: DVec2, plies: &Plies) -> f64 {
    let projected = light.length();
    let (mut at, mut toward) = (position, if projected > 0.0 { light / projected } else { DVec2::X });
    let back = DVec2::new(plies.turn.x, -plies.turn.y);
    let mut depth = 0.0;
    for _ in 0..plies.count {
        let chord = ply_chord(at, toward, plies.offset, plies.axes);
        let place = [node_coordinate(chord.x, ALONG), node_coordinate(chord.y, CHORDS), 0.5];
        depth += chord.z * filtered(&table.rests, ChordShadow::EXTENT, place);
        (at, toward) = (back.rotate(at), back.rotate(toward));
    }
    depth
}

#[cfg(test)]
#[path = "chord_shadow_tests.rs"]
mod tests;
