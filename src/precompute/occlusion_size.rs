//! How fine a table of ambient occlusion must be for a yarn: the error is measured where it is largest.

use super::chord_shadow::Plies;
use super::chord_table::ChordTable;
use super::occlusion_table::{OCCLUSION_ACROSS, OCCLUSION_LIMIT, baked_occlusion, exact_occlusion};
use super::optical_depth::CrossSection;
use super::table_error::places;
use crate::yarn::inside::fits_table;
use crate::yarn::params::YarnParams;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Texels across, of which the first that is enough is taken.
const SIZES: [u32; 3] = [OCCLUSION_ACROSS, 512, 1024];
/// Extinctions per outer radius up to which the first is enough for a yarn whose plies fit the table of self-shadows:
/// no preset has more, and half of the limit is left.
const CLEAR: f64 = 10.0;
/// Places at which a size is measured, and the share of the limit that its error there may have: others are worse.
const PLACES: u32 = 256;
const SHARE: f64 = 0.8;

/// Texels across a table that keeps within [`OCCLUSION_LIMIT`].
///
/// # Errors
/// The error that is left with the most texels.
pub fn occlusion_across(yarn: &YarnParams, extinction_per_mm: f64) -> Result<u32, f64> {
    if fits_table(yarn) && extinction_per_mm * yarn.outer_radius_mm() <= CLEAR {
        return Ok(OCCLUSION_ACROSS);
    }
    let section = CrossSection::new(yarn);
    let chords = ChordTable::new(&section.density);
    let mut left = f64::INFINITY;
    for across in SIZES {
        left = largest_error(&section, &chords, extinction_per_mm, across);
        if left <= SHARE * OCCLUSION_LIMIT {
            return Ok(across);
        }
    }
    Err(left)
}

/// The largest error found beside the plies' outlines, where light changes fastest, and inside of them.
fn largest_error(
    section: &CrossSection<'_>,
    chords: &ChordTable,
    extinction_per_mm: f64,
    across: u32,
) -> f64 {
    let error = |place: DVec2| {
        let read = interpolated(place, across, |texel| {
            baked_occlusion(section, chords, extinction_per_mm, texel, across)
        });
        (read - exact_occlusion(section, extinction_per_mm, place)).abs()
    };
    let all: Vec<DVec2> = tried(section.yarn, across).collect();
    all.into_par_iter().map(error).reduce(|| 0.0, f64::max)
}

/// Places in outer radii: every other one within a texel and a half of a ply's outline, the rest all over plies, the
/// denser the nearer to their axes.
fn tried(yarn: &YarnParams, across: u32) -> impl Iterator<Item = DVec2> {
    let Plies { count, offset, axes, .. } = Plies::new(yarn);
    let texel = 2.0 / f64::from(across - 1);
    (0..).zip(places(PLACES)).map(move |(index, (place, around))| {
        let in_ply = if index % 2 == 0 {
            let outward = (around / axes).normalize();
            around * axes + 1.5 * texel * place.x * outward
        } else {
            place.length_squared() * around * axes
        };
        let turn = DVec2::from_angle(TAU * f64::from(index / 2 % count) / f64::from(count));
        turn.rotate(DVec2::new(offset, 0.0) + in_ply).clamp_length_max(1.0)
    })
}

/// Linear interpolation between the four texels around a place.
fn interpolated(place: DVec2, across: u32, texel: impl Fn([u32; 2]) -> f64) -> f64 {
    let at = (0.5 * place + 0.5) * f64::from(across - 1);
    let low = at.floor().clamp(DVec2::ZERO, DVec2::splat(f64::from(across - 2)));
    let (share, [x, y]) = (at - low, [low.x as u32, low.y as u32]);
    let row = |y| (1.0 - share.x) * texel([x, y]) + share.x * texel([x + 1, y]);
    (1.0 - share.y) * row(y) + share.y * row(y + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::precompute::occlusion_table::{bake_occlusion_table, occlusion_place, texture_occlusion};
    use crate::yarn::density::extinction_per_mm;
    use crate::yarn::presets;

    fn wool() -> YarnParams {
        presets::yarn("worsted_3ply").unwrap()
    }

    #[test]
    fn presets_take_the_first_size_without_looking_and_would_with() {
        for name in presets::yarn_names() {
            let yarn = presets::yarn(name).unwrap();
            let extinction = extinction_per_mm(&yarn);
            assert_eq!(occlusion_across(&yarn, extinction), Ok(OCCLUSION_ACROSS), "{name}");
            assert!(extinction * yarn.outer_radius_mm() <= CLEAR, "{name}");
            let section = CrossSection::new(&yarn);
            let error =
                |by| largest_error(&section, &ChordTable::new(&section.density), by, OCCLUSION_ACROSS);
            assert!(error(CLEAR / yarn.outer_radius_mm()) <= 0.5 * OCCLUSION_LIMIT, "{name}");
        }
    }

    #[test]
    fn thin_and_dense_plies_take_more_texels_or_are_refused() {
        let thin = YarnParams { ellipse_short_mm: 0.04, migration_min: 1.0, ..wool() };
        let sizes = [1.0, 10.0, 30.0, 100.0, 1000.0].map(|extinction| occlusion_across(&thin, extinction));
        println!("{sizes:?}");
        assert!(sizes[0] == Ok(OCCLUSION_ACROSS) && sizes[0] < sizes[2], "{sizes:?}");
        assert!(sizes[4].is_err_and(|left| left > OCCLUSION_LIMIT), "{sizes:?}");
        assert_eq!(occlusion_across(&thin, 0.0), Ok(OCCLUSION_ACROSS), "nothing is hidden");
    }

    /// What is measured is what the baked table is off by.
    #[test]
    fn the_error_is_that_of_the_table() {
        let yarn = YarnParams { ellipse_short_mm: 0.1, ..wool() };
        let section = CrossSection::new(&yarn);
        let found = largest_error(&section, &ChordTable::new(&section.density), 12.0, 64);
        let table = bake_occlusion_table(&yarn, 12.0, 64);
        let error = |p: DVec2| {
            let read = texture_occlusion(&table, occlusion_place(p, 64));
            (read - exact_occlusion(&section, 12.0, p)).abs()
        };
        let baked = tried(&yarn, 64).map(error).fold(0.0, f64::max);
        assert!((found - baked).abs() < 5e-4 && found > 2e-3, "{found} and {baked}");
        let elsewhere = places(1000).map(|(p, _)| error(p)).fold(0.0, f64::max);
        assert!(elsewhere < found / SHARE, "{elsewhere} elsewhere, {found} where it was measured");
    }
}
