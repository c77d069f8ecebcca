//! Pictures for while something moves on a device that is slow: coarser, not only smaller.

use crate::scene::SceneFile;
use crate::scene::file::FibersShown;

/// Texels of a draft's shadow map along a side: more than its picture has.
const SHADOW_TEXELS: u32 = 256;
/// Narrowest fibers, in distances between samples, and the width below which detail goes.
const THIN_SAMPLES: f64 = 1.0;
const DETAIL_SAMPLES: f64 = 4.0;
/// Most straight pieces of a fiber, and of a core, over one piece of yarn.
const FIBER_PIECES: u32 = 6;
const CORE_PIECES: u32 = 2;
/// Few vertices come of each patch, so that many fit into a draw.
const PATCHES: u32 = 256;

/// How keys of a yarn begin that say how fibers leave their ply.
const FLYAWAY_KEYS: [&str; 2] = ["hair_", "loop_"];

/// How much a draft shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Fibers.
    Fibers,
    /// Plies as a whole, in half of the time.
    Cores,
}

/// What an edit changes of what is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edit {
    /// From where it is looked at, in what light: all that changes in place.
    View,
    /// Fibers that leave their ply, and nothing else: plies as a whole do not show it.
    Flyaways,
    /// More than that.
    Cloth,
}

impl Edit {
    /// From one scene to one that is made anew.
    pub fn between(before: &SceneFile, after: &SceneFile) -> Self {
        let without = |file: &SceneFile| {
            let mut file = file.clone();
            let tables = file.fabric.iter_mut().map(|fabric| &mut fabric.yarn);
            for yarn in tables.chain([&mut file.yarn]) {
                yarn.retain(|key, _| !FLYAWAY_KEYS.iter().any(|part| key.starts_with(part)));
            }
            file
        };
        if without(before) == without(after) { Self::Flyaways } else { Self::Cloth }
    }
}

/// The scene as a draft draws it.
pub fn drafted(file: &SceneFile, detail: Detail) -> SceneFile {
    let mut draft = file.clone();
    draft.shadow.resolution = draft.shadow.resolution.min(SHADOW_TEXELS);
    let quality = &mut draft.quality;
    quality.thin_fiber_samples = quality.thin_fiber_samples.max(THIN_SAMPLES);
    quality.lod_threshold_samples = quality.lod_threshold_samples.max(DETAIL_SAMPLES);
    quality.max_subdivisions = quality.max_subdivisions.min(FIBER_PIECES);
    quality.patches_per_draw = quality.patches_per_draw.or(Some(PATCHES));
    if detail == Detail::Cores && draft.debug.fibers == FibersShown::Both {
        draft.debug.fibers = FibersShown::Core;
        draft.quality.max_subdivisions = draft.quality.max_subdivisions.min(CORE_PIECES);
    }
    draft
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::overrides::apply;

    #[test]
    fn edits_are_told_apart_by_whether_plies_show_them() {
        let with = |set: &str| -> SceneFile {
            let text = "[[fabric]]\nmodel = 'a'\n[fabric.yarn]\npreset = 'mohair'\n";
            let mut table = toml::from_str(text).unwrap();
            apply(&mut table, set).unwrap();
            table.try_into().unwrap()
        };
        let between = |set: &str| Edit::between(&with("seed=0"), &with(set));
        for set in ["yarn.hair_density_per_mm=3", "fabric.0.yarn.loop_radius_mm=[1, 0.1]"] {
            assert_eq!(between(set), Edit::Flyaways, "{set}");
        }
        for set in ["yarn.ply_pitch_mm=3", "fabric.0.yarn.ply_count=2", "fiber.preset=silk", "seed=3"] {
            assert_eq!(between(set), Edit::Cloth, "{set}");
        }
    }

    #[test]
    fn a_draft_is_never_finer_than_the_scene() {
        let mut file = SceneFile::default();
        (file.shadow.resolution, file.quality.max_subdivisions) = (64, 2);
        (file.quality.thin_fiber_samples, file.quality.lod_threshold_samples) = (3.0, 9.0);
        file.debug.fibers = FibersShown::Every;
        for detail in [Detail::Fibers, Detail::Cores] {
            let draft = drafted(&file, detail);
            assert_eq!((draft.shadow.resolution, draft.quality.max_subdivisions), (64, 2));
            assert_eq!((draft.quality.thin_fiber_samples, draft.quality.lod_threshold_samples), (3.0, 9.0));
            assert_eq!(draft.debug.fibers, FibersShown::Every, "what was asked for stays");
        }
        let usual = drafted(&SceneFile::default(), Detail::Cores);
        assert_eq!(usual.debug.fibers, FibersShown::Core);
        assert_eq!(drafted(&SceneFile::default(), Detail::Fibers).debug.fibers, FibersShown::Both);
    }
}
