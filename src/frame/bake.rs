//! What is worked out on the CPU for a fabric before it is uploaded: only what its features ask for.

use super::stats::Stats;
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
use crate::vulkan::VulkanError;
use crate::yarn::density::extinction_per_mm;
use crate::yarn::table::Fiber;
use half::f16;
use std::cell::LazyCell;
use std::time::Instant;

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
}

impl Bakes {
    /// Bakes what `features` need of a fabric with these fibers, and tells `stats` how long each took.
    ///
    /// # Errors
    /// What [`check_tables`] refuses.
    pub fn new(
        scene: &Scene,
        fabric: &Fabric,
        features: &Features,
        cross_section: &[Fiber],
        stats: &mut Stats,
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
        let texture = || {
            let texels = occlusion_texels(scene, fabric).map_err(VulkanError::misuse)?;
            Ok(bake_occlusion_table(yarn, extinction_per_mm, texels))
        };
        let size = SelfShadowSize::of(quality.self_shadow_texels);
        let shadow = || shadow_radius_mm(&section, extinction_per_mm);
        let hides = features.shadow_map || features.yarn_occlusion;
        let depth = || bake_self_shadow(yarn, size);
        let by_place = features.self_shadow && !features.chord_shadow;
        let chords = || bake_chord_shadow(yarn);
        Ok(Self {
            occlusion: by_distance.then(|| timed(stats, "distance_occlusion", distance)),
            occlusion_texture: features
                .texture_occlusion
                .then(|| timed(stats, "occlusion_texture", texture))
                .transpose()?,
            self_shadow: by_place.then(|| timed(stats, "self_shadow", depth)),
            chord_shadow: features.chord_shadow.then(|| timed(stats, "self_shadow", chords)),
            shadow_radius_mm: if hides { shadow() } else { yarn.outer_radius_mm() },
            extinction: extinction_per_mm * yarn.outer_radius_mm(),
            core: features.core_fibers.then(|| timed(stats, "core_texture", core)),
            scattering: features.physical.then(|| timed(stats, "scattering_table", scattering)),
        })
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
    stats: &mut Stats,
) -> Option<Vec<Vec<[f16; 4]>>> {
    features.iter().any(|features| features.yarn_occlusion).then(|| {
        let yarns: Vec<SkyYarns<'_>> = scene.fabrics.iter().zip(bakes).map(sky_yarns).collect();
        timed(stats, "sky", || bake_skies(&yarns))
    })
}

fn sky_yarns<'a>((fabric, bakes): (&'a Fabric, &Bakes)) -> SkyYarns<'a> {
    SkyYarns {
        strands: &fabric.strands,
        hiding_radius_mm: bakes.shadow_radius_mm,
        outer_radius_mm: fabric.yarn.outer_radius_mm(),
    }
}

fn timed<T>(stats: &mut Stats, name: &str, bake: impl FnOnce() -> T) -> T {
    let started = Instant::now();
    let baked = bake();
    stats.add_precompute(name, started.elapsed());
    baked
}
