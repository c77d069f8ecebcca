//! How much fiber light passes on its way into a yarn: the table of Wu & Yuksel 2019, Sec. 4.1; reading it is
//! the twin of `glsl/shading/self_shadow.glsl`.

use super::optical_depth::{CrossSection, PlyLine, optical_depth_mm};
use super::table::{filtered, node, node_coordinate};
use super::table_error::TableError;
use crate::math::angle::angle_of;
use crate::yarn::inside::{SELF_SHADOW_ACROSS, SELF_SHADOW_SLICES};
use crate::yarn::params::YarnParams;
use glam::{DVec2, DVec3};
use half::f16;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Sine of the least angle between light and yarn that lengthens the way into it.
pub const SELF_SHADOW_LEAST_SIN: f64 = 0.125;

/// What a table of the default size keeps within, as shares of its largest depth, for yarns that fit it
/// ([`crate::yarn::inside::fits_table`]).
pub const SELF_SHADOW_LIMIT: TableError = TableError { rms: 4e-3, p99: 0.02, worst: 0.05 };

/// Sides of the table in texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SelfShadowSize {
    /// Toward the light, and as many across it; less than 2 is taken as 2.
    pub across: u32,
    /// Angles between the light and ply 0; none is taken as 1, which is enough for a round ply about the yarn's
    /// centre alone.
    pub slices: u32,
}

impl Default for SelfShadowSize {
    fn default() -> Self {
        Self { across: SELF_SHADOW_ACROSS, slices: SELF_SHADOW_SLICES }
    }
}

impl SelfShadowSize {
    /// With so many texels across, if a scene states any.
    pub fn of(across: Option<u32>) -> Self {
        across.map_or_else(Self::default, |across| Self { across, slices: across / 4 })
    }

    /// Width, height and depth of the texture.
    pub fn extent(self) -> [u32; 3] {
        [self.across, self.across, self.slices]
    }
}

/// The table. Texels are samples for linear filtering, the first and last of each side on its ends: places
/// toward the light and across it run from -1 to 1 outer radii, slices from light along ply 0 to light along the
/// middle between it and the next ply. The other half of [0, 2 pi / plies) is the mirror image of this one, so
/// that its slices are twice as dense as those of the paper for the same memory.
#[derive(Clone, Debug)]
pub struct SelfShadowTable {
    /// Its sides.
    pub size: SelfShadowSize,
    /// Slice by slice, row by row, toward the light: optical depth in units of the outer radius. With densities
    /// up to 1 it is at most about 2, which half floats round by 5e-4 at most.
    pub depths: Vec<f16>,
}

impl SelfShadowTable {
    /// The largest depth, in units of the outer radius.
    pub fn largest(&self) -> f64 {
        self.depths.iter().map(|depth| f64::from(*depth)).fold(0.0, f64::max)
    }
}

/// Bakes the table of a yarn by exact line integrals.
pub fn bake_self_shadow(yarn: &YarnParams, size: SelfShadowSize) -> SelfShadowTable {
    let size = SelfShadowSize { across: size.across.max(2), slices: size.slices.max(1) };
    let section = CrossSection::new(yarn);
    let row = |row: u32| {
        let angle = PI / f64::from(yarn.ply_count) * node(row / size.across, size.slices);
        let across = 2.0 * node(row % size.across, size.across) - 1.0;
        depth_row(&section, DVec2::from_angle(angle), across, size.across)
    };
    let depths = (0..size.slices * size.across).into_par_iter().flat_map_iter(row).collect();
    SelfShadowTable { size, depths }
}

/// The depths along one line, `across` outer radii from the yarn's centre; the last texel is nearest to the light.
fn depth_row(section: &CrossSection<'_>, toward: DVec2, across: f64, texels: u32) -> Vec<f16> {
    let radius = section.yarn.outer_radius_mm();
    let middle = across * radius * toward.perp();
    let lines: Vec<PlyLine<'_>> = section.lines(middle, toward).collect();
    let place = |i: u32| radius * (2.0 * node(i, texels) - 1.0);
    let mut depth = 0.0;
    let mut row = vec![f16::ZERO; texels as usize];
    for i in (0..texels - 1).rev() {
        depth += lines.iter().map(|line| line.depth_mm(place(i), place(i + 1))).sum::<f64>();
        row[i as usize] = f16::from_f64(depth / radius);
    }
    row
}

/// What the table stands for: the integral itself, at `position` with light from the unit direction `toward`,
/// all in outer radii.
pub fn exact_self_shadow_depth(section: &CrossSection<'_>, position: DVec2, toward: DVec2) -> f64 {
    let radius = section.yarn.outer_radius_mm();
    optical_depth_mm(section, position * radius, toward) / radius
}

/// Texture coordinates in the table for a fiber at `position` in the cross-section (ply 0 along x, in outer
/// radii) and the projection there of the direction toward the light, of any length; where it has none, ply 0's
/// direction stands for it. The slices fold where light is its own mirror image, and places clamp to the outer
/// circle's square, outside of which only fly-aways lie, which the table does not hold: toward the light the depth
/// is 0 there, behind the yarn that of all of it.
pub fn self_shadow_place(position: DVec2, light: DVec2, ply_count: u32, size: SelfShadowSize) -> DVec3 {
    let projected = light.length();
    let toward = if projected > 0.0 { light / projected } else { DVec2::X };
    let turns = angle_of(toward.y, toward.x) * (f64::from(ply_count) / TAU);
    let from_ply = turns - turns.round();
    let across = toward.perp_dot(position);
    let across = if from_ply < 0.0 { -across } else { across };
    let share = |place: f64| (0.5 + 0.5 * place).clamp(0.0, 1.0);
    DVec3::new(
        node_coordinate(share(toward.dot(position)), size.across),
        node_coordinate(share(across), size.across),
        node_coordinate(2.0 * from_ply.abs(), size.slices),
    )
}

/// Optical depth toward the light for light across the yarn, in units of the outer radius; `place` is
/// [`self_shadow_place`]'s.
pub fn self_shadow_depth(table: &SelfShadowTable, place: DVec3) -> f64 {
    filtered(&table.depths, table.size.extent(), place.to_array())
}

/// How much longer than across the yarn the way into it is; `sin_angle` is that of the angle between the light
/// and the yarn. Capped where a way across the whole yarn, two outer radii, is 16 of them long: about as far as
/// a loop of knitwear is straight (chosen, not measured).
pub fn self_shadow_stretch(sin_angle: f64) -> f64 {
    1.0 / sin_angle.max(SELF_SHADOW_LEAST_SIN)
}

/// Share of light that comes through, in [0, 1]: `depth` for light across the yarn in outer radii, `extinction`
/// per outer radius. Toward the yarn's own direction it falls to nothing, as it does without the cap wherever
/// there is anything to pass; where there is nothing, it would depend on which side of the yarn the light is
/// just on, and jump.
pub fn self_shadow_light(depth: f64, extinction: f64, sin_angle: f64) -> f64 {
    let seen = (sin_angle / SELF_SHADOW_LEAST_SIN).min(1.0);
    seen * (-extinction * depth * self_shadow_stretch(sin_angle)).exp()
}

#[cfg(test)]
#[path = "self_shadow_tests.rs"]
mod tests;
