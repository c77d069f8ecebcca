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
const CORE_PIECES: u32 = 4;
/// Few vertices come of each patch, so that many fit into a draw.
const PATCHES: u32 = 256;

/// How much a draft shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Fibers, for edits that change them.
    Fibers,
    /// Plies as a whole, for a look from elsewhere or in other light.
    Cores,
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
