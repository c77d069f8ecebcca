//! What is worked out on the CPU for a scene before it is uploaded, apart from the device: on another thread, if need be.

use super::Request;
use super::bake::{Bakes, skies};
use super::keeping::{Baked, Bakery};
use crate::io::kept::Kept;
use crate::scene::features::Features;
use crate::scene::file::SceneFile;
use crate::scene::{Fabric, Scene};
use crate::vulkan::VulkanError;
use crate::yarn::table::fiber_table;
use half::f16;
use std::sync::Arc;

/// What is open of the sky above the control points of every fabric.
pub type Skies = Arc<Vec<Vec<[f16; 4]>>>;

/// A scene's tables, and what was uploaded of them: renderers of one device that draw with the same ones share it there,
/// and it goes with the last of them and the last clone. Clones share them.
#[derive(Clone)]
pub struct Tables {
    pub(super) bakes: Arc<Vec<Bakes>>,
    pub(super) skies: Option<Skies>,
    /// What getting them took.
    pub baked: Vec<Baked>,
    shape: Vec<Shape>,
}

/// What of a fabric decides how large its tables are, and where they are looked up.
#[derive(Clone, Debug, PartialEq)]
struct Shape {
    ply_count: u32,
    points: usize,
    scattering_entries: u32,
    self_shadow_texels: Option<u32>,
    core: (u32, f64),
    chord_shadow: bool,
}

impl Tables {
    /// Bakes what pictures of a scene need, or reads what `kept` has of it.
    ///
    /// # Errors
    /// What [`super::check_tables`] refuses.
    pub fn bake(scene: &Scene, request: &Request, kept: &Kept) -> Result<Self, VulkanError> {
        let features = features(scene, request);
        let mut bakery = Bakery::new(kept);
        let of_fabrics = scene.fabrics.iter().zip(&features);
        let bakes: Vec<Bakes> = of_fabrics
            .map(|(fabric, features)| {
                let fibers = fiber_table(&fabric.yarn, scene.file.seed);
                Bakes::new(scene, fabric, features, &fibers, &mut bakery)
            })
            .collect::<Result<_, _>>()?;
        let skies = skies(scene, &bakes, &features, &mut bakery).map(Arc::new);
        Ok(Self { bakes: Arc::new(bakes), skies, baked: bakery.baked, shape: shape(scene, &features) })
    }

    /// Whether a picture of this scene can be drawn with these tables though they are of another one: nothing that it
    /// needs is missing or of another size. It is then not right, but near while a value is dragged.
    pub fn may_stand_for(&self, scene: &Scene, request: &Request) -> bool {
        let features = features(scene, request);
        let has = |(bakes, (fabric, features)): (&Bakes, (&Fabric, &Features))| {
            (!features.physical || bakes.scattering.is_some())
                && (!features.self_shadow || bakes.self_shadow.is_some() || bakes.chord_shadow.is_some())
                && (!features.texture_occlusion || bakes.occlusion_texture.is_some())
                && (!features.distance_occlusion || bakes.occlusion.is_some())
                && (!features.core_fibers
                    || bakes.core.as_ref().is_some_and(|core| core.ranks <= fabric.yarn.fibers_per_ply))
                && (!features.yarn_occlusion || self.skies.is_some())
        };
        shape(scene, &features) == self.shape
            && self.bakes.iter().zip(scene.fabrics.iter().zip(&features)).all(has)
    }
}

/// What each fabric of a scene needs.
pub fn features(scene: &Scene, request: &Request) -> Vec<Features> {
    features_by(&scene.file, scene, request)
}

/// What each fabric of a scene would need if its file said this.
pub fn features_by(file: &SceneFile, scene: &Scene, request: &Request) -> Vec<Features> {
    scene.fabrics.iter().map(|fabric| Features::new(file, fabric, request.statistics)).collect()
}

fn shape(scene: &Scene, features: &[Features]) -> Vec<Shape> {
    let quality = &scene.file.quality;
    let of_fabric = |(fabric, features): (&Fabric, &Features)| Shape {
        ply_count: fabric.yarn.ply_count,
        points: fabric.strands.points.len(),
        scattering_entries: quality.scattering_entries,
        self_shadow_texels: quality.self_shadow_texels,
        core: (quality.core_texture_rows, quality.core_visible_share),
        chord_shadow: features.chord_shadow,
    };
    scene.fabrics.iter().zip(features).map(of_fabric).collect()
}
