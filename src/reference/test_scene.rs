//! Small scenes for the tests of this module.

use crate::bsdf::presets as fiber_presets;
use crate::math::bounds::bounds;
use crate::math::curve::{Basis, Curve};
use crate::scene::fabric::LoadTimes;
use crate::scene::{Fabric, Scene, SceneFile};
use crate::yarn::params::YarnParams;
use crate::yarn::presets;
use crate::yarn::strand::strands;
use glam::DVec3;

/// The scene that `text`, in TOML, speaks of, with `curves` (in mm) in place of its model.
pub fn scene_of(text: &str, curves: &[Curve], yarn: &YarnParams) -> Scene {
    let file: SceneFile = toml::from_str(text).unwrap();
    let strands = strands(curves, Basis::CatmullRom, yarn, file.seed);
    let fiber = fiber_presets::fiber(fiber_presets::DEFAULT_FIBER).unwrap();
    let name = "test".to_owned();
    let (notes, load) = (Vec::new(), LoadTimes::default());
    let fabric = Fabric {
        name,
        yarn: yarn.clone(),
        fiber,
        strands,
        mm_per_unit: 1.0,
        motion: None,
        turns_swiftly: false,
        notes,
        load,
    };
    let (low, high) = bounds(fabric.hull_points());
    Scene { file, fabrics: vec![fabric], origin_mm: 0.5 * (low + high), environment: None }
}

/// A straight yarn along X from `from` to `to` mm at height y.
pub fn straight(from: f64, to: f64, y: f64) -> Curve {
    let at = |k: u32| DVec3::new(from + (to - from) * f64::from(k) / 8.0, y, 0.0);
    Curve { points: (0..=8).map(at).collect(), closed: false }
}

/// The preset with so many fibers in each ply.
pub fn yarn(preset: &str, fibers_per_ply: u32) -> YarnParams {
    YarnParams { fibers_per_ply, ..presets::yarn(preset).unwrap() }
}
