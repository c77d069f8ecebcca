//! Device memory that what is left out would take with the scene's own settings.

use super::lighting::LightRoom;
use crate::gpu_types::{ShadowView, Statistics};
use crate::precompute::chord_shadow::ChordShadow;
use crate::precompute::core_texture::core_texels;
use crate::precompute::self_shadow::SelfShadowSize;
use crate::scene::features::shadows_by_place;
use crate::scene::{Fabric, Scene};

/// Bytes of a texel or an entry.
const HALF: u64 = 2;
const FOUR_HALVES: u64 = 8;
const FOUR_FLOATS: u64 = 16;
const MAP_TEXEL: u64 = 8;
const DEPTH_TEXEL: u64 = 4;
/// Images of a core texture.
const CORE_IMAGES: u64 = 3;
/// Lobes with a scattering table.
const LOBES: u64 = 2;

/// The tables that would be baked with what [`crate::scene::features::Features`] calls `what`, by their names in
/// `precompute_ms`.
pub fn saved_bakes(what: &str) -> &'static [&'static str] {
    match what {
        "self_shadow" => &["self_shadow"],
        "scattering_tables" => &["scattering_table"],
        "yarn_occlusion" => &["sky"],
        "occlusion" => &["distance_occlusion"],
        "core_fibers" => &["core_texture"],
        _ => &[],
    }
}

/// Bytes of the buffers and images that a fabric would have besides with what [`crate::scene::features::Features`]
/// calls `what`; none where it is code alone. Drivers may round up each.
pub fn saved_bytes(scene: &Scene, fabric: &Fabric, what: &str) -> Option<u64> {
    let quality = &scene.file.quality;
    Some(match what {
        "shadow_map" => {
            let views = u64::from(LightRoom::needed(&scene.file.light(), true).views);
            let texels = u64::from(scene.file.shadow.resolution).pow(2);
            // A view of layers has two at least.
            texels * (views.max(2) * MAP_TEXEL + DEPTH_TEXEL) + views * size_of::<ShadowView>() as u64
        }
        "self_shadow" => {
            let size = SelfShadowSize::of(quality.self_shadow_texels);
            let extent =
                if shadows_by_place(quality, &fabric.yarn) { size.extent() } else { ChordShadow::EXTENT };
            extent.iter().map(|&side| u64::from(side)).product::<u64>() * HALF
        }
        "scattering_tables" => LOBES * FOUR_FLOATS * u64::from(quality.scattering_entries),
        "yarn_occlusion" => FOUR_HALVES * fabric.strands.points.len() as u64,
        "core_fibers" => {
            CORE_IMAGES * FOUR_HALVES * core_texels(quality.core_texture_rows, fabric.yarn.ply_count)
        }
        "statistics" => size_of::<Statistics>() as u64,
        _ => return None,
    })
}
