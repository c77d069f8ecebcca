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
}

impl Need {
    /// Every one.
    pub const ALL: [Self; 8] = [
        Self::Statistics,
        Self::Lights,
        Self::ShadowMap,
        Self::CoreTexture,
        Self::ScatteringTable,
        Self::SelfShadowTable,
        Self::OcclusionTexture,
        Self::Skies,
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
        }
    }
}

/// Whether any of a scene's fabrics reads it.
pub fn any_needs(features: &[Features], need: Need) -> bool {
    features.iter().any(|features| features.needs(need))
}
