//! What the device must hold for a scene's features: the list that buffers, images, tables and descriptors follow.

use super::features::Features;

/// Something on the device that only some scenes read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Need {
    /// What the control stage counts into.
    Statistics,
    /// The lights that shine.
    Lights,
    /// What each light sees, and the shadow map of it.
    ShadowMap,
    /// What core fibers show.
    CoreTexture,
    /// Factors of the physical model's lobes.
    ScatteringTable,
    /// Optical depth inside the yarn.
    SelfShadowTable,
    /// Ambient light inside the yarn, by place.
    OcclusionTexture,
    /// What other yarns leave open of the sky.
    Skies,
    /// The layer of how what is seen moves.
    MotionLayer,
    /// The layer of which yarn it is.
    IdLayer,
    /// Where the frames before and after have the control points.
    Neighbours,
}

impl Need {
    /// Every one.
    pub const ALL: [Self; 11] = [
        Self::Statistics,
        Self::Lights,
        Self::ShadowMap,
        Self::CoreTexture,
        Self::ScatteringTable,
        Self::SelfShadowTable,
        Self::OcclusionTexture,
        Self::Skies,
        Self::MotionLayer,
        Self::IdLayer,
        Self::Neighbours,
    ];

    /// Names of its buffers and images on the device, without those it shares with others.
    pub const fn resources(self) -> &'static [&'static str] {
        match self {
            Self::Statistics => &["statistics"],
            Self::Lights => &["lights"],
            Self::ShadowMap => &["shadow views", "shadow map", "shadow depth"],
            Self::CoreTexture => &["core normals", "core shape", "core spread"],
            Self::ScatteringTable => &["scattering table"],
            Self::SelfShadowTable => &["self-shadow table"],
            Self::OcclusionTexture => &["occlusion texture"],
            Self::Skies => &["skies"],
            Self::MotionLayer => &["motion layer"],
            Self::IdLayer => &["id layer"],
            Self::Neighbours => &["control points before", "control points after"],
        }
    }
}

impl Features {
    /// Whether drawing the fabric reads it.
    pub fn needs(&self, need: Need) -> bool {
        match need {
            Need::Statistics => self.statistics,
            Need::Lights => self.light_count > 0,
            Need::ShadowMap => self.shadow_map,
            Need::CoreTexture => self.core_fibers,
            Need::ScatteringTable => self.physical,
            Need::SelfShadowTable => self.self_shadow,
            Need::OcclusionTexture => self.texture_occlusion,
            Need::Skies => self.yarn_occlusion,
            Need::MotionLayer => self.motion_layer,
            Need::IdLayer => self.id_layer,
            Need::Neighbours => self.neighbours,
        }
    }
}

/// Whether any of a scene's fabrics reads it.
pub fn any_needs(features: &[Features], need: Need) -> bool {
    features.iter().any(|features| features.needs(need))
}
