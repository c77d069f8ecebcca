//! What is worked out on the CPU for a fabric before it is uploaded: only what its features ask for.

use super::keeping::Bakery;
use super::textures::{DeviceTables, Uploaded};
use crate::io::kept::Key;
use crate::precompute::chord_shadow::{ChordShadow, bake_chord_shadow};
use crate::precompute::core_texture::{CoreTexture, bake_core};
use crate::precompute::occlusion_fit::{OcclusionFit, fit_occlusion};
use crate::precompute::occlusion_size::occlusion_across;
use crate::precompute::occlusion_table::{OCCLUSION_LIMIT, OcclusionTable, bake_occlusion_table};
use crate::precompute::optical_depth::CrossSection;
use crate::precompute::scattering_table::{self, ScatteringTable};
use crate::precompute::self_shadow::{SelfShadowSize, SelfShadowTable, bake_self_shadow};
use crate::precompute::shadow_radius::shadow_radius_mm;
use crate::precompute::sky::{SkyYarns, bake_skies};
use crate::scene::features::Features;
use crate::scene::file::OcclusionMode;
use crate::scene::{Fabric, Scene, SceneError};
use crate::vulkan::{Device, VulkanError};
use crate::yarn::density::extinction_per_mm;
use crate::yarn::table::Fiber;
use half::f16;
use std::cell::LazyCell;
use std::sync::Arc;

/// A fabric's tables; absent where nothing reads them.
pub struct Bakes {
    /// Ambient light by the distance from the yarn's centre.
    pub occlusion: Option<OcclusionFit>,
    /// What core fibers show.
    pub core: Option<CoreTexture>,
    /// Factors of the physical model's lobes.
    pub scattering: Option<ScatteringTable>,
    /// Optical depth inside the yarn.
    pub self_shadow: Option<SelfShadowTable>,
    /// The same ply by ply, where plies do not fit that.
    pub chord_shadow: Option<ChordShadow>,
    /// Ambient light inside the yarn, by place.
    pub occlusion_texture: Option<OcclusionTable>,
    /// Radius of the opaque tube that takes as much light from other yarns; the outer radius where nothing reads it.
    pub shadow_radius_mm: f64,
    /// Extinction per outer radius of the yarn.
    pub extinction: f64,
    uploaded: Uploaded,
}

impl Bakes {
    /// Bakes what `features` need of a fabric with these fibers.
    ///
    /// # Errors
    /// What [`check_tables`] refuses.
    pub fn new(
        scene: &Scene,
        fabric: &Fabric,
        features: &Features,
        cross_section: &[Fiber],
        bakery: &mut Bakery<'_>,
    ) -> Result<Self, VulkanError> {
        let quality = &scene.file.quality;
        let core =
            || bake_core(&fabric.yarn, cross_section, quality.core_texture_rows, quality.core_visible_share);
        let scattering = || scattering_table::bake(&fabric.fiber.scattering(), quality.scattering_entries);
        let yarn = &fabric.yarn;
        let extinction_per_mm = extinction(scene, fabric);
        let section = LazyCell::new(|| CrossSection::new(yarn));
        let distance = || fit_occlusion(&section, extinction_per_mm);
        // What leans outward is by distance in either mode, but nothing shows it without ambient light.
        let by_distance = features.distance_occlusion || features.texture_occlusion && features.ambient;
        let texels = features.texture_occlusion.then(|| occlusion_texels(scene, fabric));
        let texels = texels.transpose().map_err(VulkanError::misuse)?;
        let size = SelfShadowSize::of(quality.self_shadow_texels);
        let shadow = || shadow_radius_mm(&section, extinction_per_mm);
        let hides = features.shadow_map || features.yarn_occlusion;
        let depth = || bake_self_shadow(yarn, size);
        let by_place = features.self_shadow && !features.chord_shadow;
        let chords = || bake_chord_shadow(yarn);
        let of_yarn = |key: Key| key.shown(&(yarn, extinction_per_mm));
        let of_core = |key: Key| {
            key.shown(&(yarn, cross_section)).shown(&(quality.core_texture_rows, quality.core_visible_share))
        };
        let of_fiber = |key: Key| key.shown(&(fabric.fiber.scattering(), quality.scattering_entries));
        Ok(Self {
            occlusion: by_distance.then(|| bakery.table("distance_occlusion", of_yarn, distance)),
            occlusion_texture: texels.map(|texels| {
                let texture = || bake_occlusion_table(yarn, extinction_per_mm, texels);
                bakery.table("occlusion_texture", |key| of_yarn(key).shown(&texels), texture)
            }),
            self_shadow: by_place.then(|| bakery.table("self_shadow", |key| key.shown(&(yarn, size)), depth)),
            chord_shadow: features
                .chord_shadow
                .then(|| bakery.table("chord_shadow", |key| key.shown(yarn), chords)),
            shadow_radius_mm: match hides {
                true => bakery.table("shadow_radius", of_yarn, shadow),
                false => yarn.outer_radius_mm(),
            },
            extinction: extinction_per_mm * yarn.outer_radius_mm(),
            core: features.core_fibers.then(|| bakery.table("core_texture", of_core, core)),
            scattering: features.physical.then(|| bakery.table("scattering_table", of_fiber, scattering)),
            uploaded: Uploaded::default(),
        })
    }

    /// What is on the device of these; uploaded where nothing is yet.
    ///
    /// # Errors
    /// Those of the device.
    pub fn on_device(&self, device: &Arc<Device>) -> Result<DeviceTables, VulkanError> {
        self.uploaded.get(device, self)
    }
}

/// Extinction per mm and density of a fabric's fibers.
fn extinction(scene: &Scene, fabric: &Fabric) -> f64 {
    scene.file.shading.extinction_scale * extinction_per_mm(&fabric.yarn)
}

/// Texels across a fabric's table of ambient occlusion: what the scene states, or as many as are needed.
fn occlusion_texels(scene: &Scene, fabric: &Fabric) -> Result<u32, String> {
    let needed = || {
        occlusion_across(&fabric.yarn, extinction(scene, fabric)).map_err(|left| {
            format!(
                "occlusion.mode = texture: expected plies that a texture shows to {OCCLUSION_LIMIT} of the light, \
                 found an error of {left:.3} with the largest: take occlusion.mode = distance"
            )
        })
    };
    scene.file.quality.occlusion_texels.map_or_else(needed, Ok)
}

/// Whether tables show the insides of a scene's yarns as well as they promise.
///
/// # Errors
/// A fabric whose plies are too thin or too dense for a texture of ambient occlusion that the scene asks for without
/// saying how large it is.
pub fn check_tables(scene: &Scene) -> Result<(), SceneError> {
    if scene.file.occlusion.mode != OcclusionMode::Texture {
        return Ok(());
    }
    for fabric in &scene.fabrics {
        let refused = |message| SceneError::Value { scene: fabric.name.clone(), message };
        occlusion_texels(scene, fabric).map_err(refused)?;
    }
    Ok(())
}

/// What is open of the sky above every control point of every fabric, where any of them asks for it.
pub fn skies(
    scene: &Scene,
    bakes: &[Bakes],
    features: &[Features],
    bakery: &mut Bakery<'_>,
) -> Option<Vec<Vec<[f16; 4]>>> {
    features.iter().any(|features| features.yarn_occlusion).then(|| {
        let yarns: Vec<SkyYarns<'_>> = scene.fabrics.iter().zip(bakes).map(sky_yarns).collect();
        let of_yarns = |key: Key| yarns.iter().fold(key, of_sky_yarns);
        bakery.table("sky", of_yarns, || bake_skies(&yarns))
    })
}

fn sky_yarns<'a>((fabric, bakes): (&'a Fabric, &Bakes)) -> SkyYarns<'a> {
    SkyYarns {
        strands: &fabric.strands,
        hiding_radius_mm: bakes.shadow_radius_mm,
        outer_radius_mm: fabric.yarn.outer_radius_mm(),
    }
}

/// A key with all that decides what one fabric hides and sees of the sky.
fn of_sky_yarns(key: Key, yarns: &SkyYarns<'_>) -> Key {
    let strands = yarns.strands;
    let key = key
        .shown(&(strands.basis, yarns.hiding_radius_mm, yarns.outer_radius_mm, &strands.closed))
        .bytes(bytemuck::cast_slice(&strands.points));
    strands.pieces.iter().fold(key, |key, piece| {
        let words = [piece.first_point as u64, piece.curve as u64];
        let lengths = [piece.length_start_mm, piece.length_mm].map(f64::to_bits);
        key.bytes(bytemuck::cast_slice(&[words, lengths]))
    })
}
