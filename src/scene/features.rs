//! Scene to features: the only place that leaves things out.

use super::Fabric;
use super::file::{DebugView, FibersShown, OcclusionMode, QualityTable, SceneFile, ShadingModel};
use crate::math::curve::Basis;
use crate::yarn::flyaway::Flyaways;
use crate::yarn::inside::fits_table;
use crate::yarn::params::YarnParams;
use std::collections::BTreeMap;

/// What drawing one fabric needs. Pipelines are specialised by it, so that what is left out costs
/// neither memory nor shader code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Features {
    /// How control points are read.
    pub basis: Basis,
    /// Pieces of yarn outside the picture are dropped.
    pub culling: bool,
    /// Ambient light is dimmed inside the yarn.
    pub distance_occlusion: bool,
    /// The control stage counts what it draws.
    pub statistics: bool,
    /// Highlights exist.
    pub specular: bool,
    /// Diffuse reflection exists.
    pub diffuse: bool,
    /// Highlights are those of the physical model.
    pub physical: bool,
    /// Yarns shadow one another.
    pub shadow_map: bool,
    /// Some light spans an angle, so that shadows are soft.
    pub soft_shadows: bool,
    /// Light is dimmed inside the yarn.
    pub self_shadow: bool,
    /// And that ply by ply, not by place in the yarn: [`shadows_by_place`].
    pub chord_shadow: bool,
    /// Ambient light is dimmed by place inside the yarn, not by distance.
    pub texture_occlusion: bool,
    /// Other yarns hide parts of the sky.
    pub yarn_occlusion: bool,
    /// Ambient light exists.
    pub ambient: bool,
    /// Lights of which anything arrives.
    pub light_count: u32,
    /// Some of them are at a place: point or spot lights.
    pub local_lights: bool,
    /// Ambient light differs by direction.
    pub environment: bool,
    /// What fibers are coloured by.
    pub debug_view: DebugView,
    /// Loops or hairs exist.
    pub flyaways: bool,
    /// Some piece of yarn turns so fast that cuts must follow, or may come to.
    pub swift_turns: bool,
    /// Core fibers stand for some of the fibers.
    pub core_fibers: bool,
    /// And are drawn.
    pub core_fibers_drawn: bool,
    /// Fewer fibers are drawn where they are small in the picture.
    pub level_of_detail: bool,
    /// Fibers are drawn one by one.
    pub regular_fibers: bool,
    /// Fibers that are thin in the picture are shaded at their vertices.
    pub vertex_shading: bool,
    /// Pictures have a layer of how what is seen moves.
    pub motion_layer: bool,
    /// And one of which yarn it is.
    pub id_layer: bool,
    /// For the former: the fabric lies elsewhere in the frames before and after.
    pub neighbours: bool,
}

/// Specialization constants of `glsl/shared/features.glsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
#[expect(missing_docs, reason = "each is the constant of the same name")]
pub enum SpecializationId {
    Basis = 0,
    Culling = 1,
    DistanceOcclusion = 2,
    Statistics = 3,
    Specular = 4,
    Ambient = 5,
    LightCount = 6,
    DebugView = 7,
    Flyaways = 8,
    CoreFibers = 9,
    LevelOfDetail = 10,
    Samples = 11,
    RegularFibers = 12,
    LocalLights = 13,
    Environment = 14,
    Diffuse = 15,
    Physical = 16,
    ShadowMap = 17,
    SoftShadows = 18,
    SelfShadow = 19,
    TextureOcclusion = 20,
    YarnOcclusion = 21,
    VertexShading = 22,
    AtVertices = 23,
    ChordShadow = 24,
    SwiftTurns = 25,
    MotionLayer = 26,
    IdLayer = 27,
    Neighbours = 28,
}

/// Whether light is dimmed inside a yarn by the table over its whole cross-section, where it is: a scene that states that
/// table's size gets it.
pub fn shadows_by_place(quality: &QualityTable, yarn: &YarnParams) -> bool {
    quality.self_shadow_texels.is_some() || fits_table(yarn)
}

impl Features {
    /// What `fabric` needs in this scene; `statistics` when someone asked for them.
    pub fn new(file: &SceneFile, fabric: &Fabric, statistics: bool) -> Self {
        let shaded = file.debug.view == DebugView::Shaded;
        let shown = file.debug.fibers;
        let some = |rgb: [f64; 3]| rgb.iter().any(|&c| c > 0.0);
        let shading = &file.shading;
        let physical = shading.model == ShadingModel::Physical;
        let lights = file.light().into_iter().filter(|light| shaded && light.shines());
        let (light_count, local_lights) =
            lights.fold((0, false), |(count, local), light| (count + 1, local || light.is_local()));
        let fiber = &fabric.fiber;
        // Of uniform light only the physical lobes have an integral; those of a black fiber gleam as well, at
        // grazing angles.
        let lobes = shading.specular && physical;
        let diffuse = shading.diffuse && some(fiber.diffuse());
        let from_everywhere = shaded && shading.ambient && (lobes || diffuse);
        let environment = from_everywhere && file.ambient.picture().is_some();
        let ambient = environment || from_everywhere && some(file.ambient.radiance().to_array());
        let lit = light_count > 0;
        let specular =
            lobes && (lit || ambient) || lit && shading.specular && !physical && some(fiber.specular());
        let diffuse = diffuse && (lit || ambient);
        let soft = file.light().iter().any(|light| light.shines() && light.angular_size_deg > 0.0);
        let self_shadow = file.shadow.inside && (lit || ambient && lobes);
        let dimmed = ambient || file.debug.view == DebugView::Occlusion;
        Self {
            basis: fabric.strands.basis,
            culling: file.quality.culling,
            distance_occlusion: dimmed && file.occlusion.mode == OcclusionMode::Distance,
            texture_occlusion: dimmed && file.occlusion.mode == OcclusionMode::Texture,
            yarn_occlusion: ambient && file.occlusion.yarns && file.occlusion.mode != OcclusionMode::None,
            shadow_map: lit && file.shadow.map,
            soft_shadows: lit && file.shadow.map && soft,
            self_shadow,
            chord_shadow: self_shadow && !shadows_by_place(&file.quality, &fabric.yarn),
            statistics,
            specular,
            diffuse,
            physical: physical && specular,
            ambient,
            light_count,
            local_lights,
            environment,
            debug_view: file.debug.view,
            flyaways: Flyaways::new(&fabric.yarn).exist(),
            swift_turns: fabric.turns_swiftly,
            core_fibers: shown != FibersShown::Every,
            core_fibers_drawn: matches!(shown, FibersShown::Both | FibersShown::Core),
            level_of_detail: file.quality.level_of_detail && shown != FibersShown::Every,
            regular_fibers: shown != FibersShown::Core,
            vertex_shading: shaded
                && file.quality.level_of_detail
                && matches!(shown, FibersShown::Both | FibersShown::Regular)
                && file.quality.vertex_shaded_samples > 0.0,
            motion_layer: file.layers.motion,
            id_layer: file.layers.id,
            neighbours: file.layers.motion && fabric.motion.is_some(),
        }
    }

    /// What the same fabric needs where it is drawn into a picture, not its layers.
    #[must_use]
    pub fn of_picture(&self) -> Self {
        Self { motion_layer: false, id_layer: false, neighbours: false, ..*self }
    }

    /// What it needs where the same fibers are drawn into its layers: no light.
    #[must_use]
    pub fn of_layers(&self) -> Self {
        Self {
            basis: self.basis,
            culling: self.culling,
            distance_occlusion: false,
            statistics: false,
            specular: false,
            diffuse: false,
            physical: false,
            shadow_map: false,
            soft_shadows: false,
            self_shadow: false,
            chord_shadow: false,
            texture_occlusion: false,
            yarn_occlusion: false,
            ambient: false,
            light_count: 0,
            local_lights: false,
            environment: false,
            debug_view: DebugView::Shaded,
            flyaways: self.flyaways,
            swift_turns: self.swift_turns,
            core_fibers: self.core_fibers,
            core_fibers_drawn: self.core_fibers_drawn,
            level_of_detail: self.level_of_detail,
            regular_fibers: self.regular_fibers,
            vertex_shading: false,
            motion_layer: self.motion_layer,
            id_layer: self.id_layer,
            neighbours: self.neighbours,
        }
    }

    /// Whether pictures in which nothing is to be simplified are drawn without level of detail.
    pub fn may_be_whole(&self) -> bool {
        self.level_of_detail && self.core_fibers_drawn && self.regular_fibers
    }

    /// What the same fabric needs where every fiber is drawn, at full detail.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self {
            core_fibers: false,
            core_fibers_drawn: false,
            level_of_detail: false,
            vertex_shading: false,
            ..*self
        }
    }

    /// Identifier and value of every specialization constant, booleans as 0 and 1, for frames of `samples`
    /// samples a pixel; `at_vertices` for the pipelines that shade there.
    pub fn specialization(&self, samples: u32, at_vertices: bool) -> [(SpecializationId, u32); 29] {
        use SpecializationId as Id;
        [
            (Id::Basis, self.basis as u32),
            (Id::Culling, self.culling.into()),
            (Id::DistanceOcclusion, self.distance_occlusion.into()),
            (Id::Statistics, self.statistics.into()),
            (Id::Specular, self.specular.into()),
            (Id::Ambient, self.ambient.into()),
            (Id::LightCount, self.light_count),
            (Id::DebugView, self.debug_view as u32),
            (Id::Flyaways, self.flyaways.into()),
            (Id::CoreFibers, self.core_fibers.into()),
            (Id::LevelOfDetail, self.level_of_detail.into()),
            (Id::Samples, samples),
            (Id::RegularFibers, self.regular_fibers.into()),
            (Id::LocalLights, self.local_lights.into()),
            (Id::Environment, self.environment.into()),
            (Id::Diffuse, self.diffuse.into()),
            (Id::Physical, self.physical.into()),
            (Id::ShadowMap, self.shadow_map.into()),
            (Id::SoftShadows, self.soft_shadows.into()),
            (Id::SelfShadow, self.self_shadow.into()),
            (Id::TextureOcclusion, self.texture_occlusion.into()),
            (Id::YarnOcclusion, self.yarn_occlusion.into()),
            (Id::VertexShading, self.vertex_shading.into()),
            (Id::AtVertices, at_vertices.into()),
            (Id::ChordShadow, self.chord_shadow.into()),
            (Id::SwiftTurns, self.swift_turns.into()),
            (Id::MotionLayer, self.motion_layer.into()),
            (Id::IdLayer, self.id_layer.into()),
            (Id::Neighbours, self.neighbours.into()),
        ]
    }

    /// What is left out of this fabric's pipeline, each with its reason.
    pub fn left_out(&self) -> BTreeMap<&'static str, &'static str> {
        let mut out = BTreeMap::new();
        let mut leave = |absent: bool, what, why| {
            if absent {
                out.insert(what, why);
            }
        };
        let shaded = self.debug_view == DebugView::Shaded;
        leave(!shaded, "shading", "a debug view colours the fibers");
        let light = self.light_count > 0;
        leave(shaded && !light, "light", "no light with irradiance or intensity above 0");
        leave(shaded && light && !self.local_lights, "local_lights", "no point or spot light");
        leave(shaded && self.ambient && !self.environment, "environment", "no ambient.environment");
        leave(
            shaded && light && !self.specular,
            "specular",
            "fiber.specular is 0, or shading.specular false",
        );
        leave(shaded && !self.diffuse, "diffuse", "fiber.diffuse is 0, or shading.diffuse false");
        leave(shaded && self.specular && !self.physical, "scattering_tables", "shading.model is simple");
        leave(
            shaded && !self.ambient,
            "ambient",
            "ambient.radiance or environment_scale is 0, or shading.ambient false",
        );
        leave(
            shaded && !self.distance_occlusion && !self.texture_occlusion,
            "occlusion",
            if self.ambient { "occlusion.mode is none" } else { "no ambient light to dim" },
        );
        leave(
            self.ambient && !self.yarn_occlusion,
            "yarn_occlusion",
            "occlusion.yarns is false, or occlusion.mode none",
        );
        leave(shaded && light && !self.shadow_map, "shadow_map", "shadow.map is false");
        leave(self.shadow_map && !self.soft_shadows, "soft_shadows", "no light has an angular_size_deg");
        leave(shaded && (light || self.ambient) && !self.self_shadow, "self_shadow", "shadow.self is false");
        leave(!self.flyaways, "flyaways", "the yarn has neither loops nor hairs");
        leave(
            !self.swift_turns,
            "swift_turns",
            "no piece of the yarn turns a quarter within an eighth of itself",
        );
        leave(!self.core_fibers, "core_fibers", "debug.fibers is every: no fiber is left to stand for");
        leave(!self.regular_fibers, "regular_fibers", "debug.fibers is core");
        leave(
            !self.level_of_detail,
            "level_of_detail",
            if self.core_fibers { "quality.level_of_detail is false" } else { "debug.fibers is every" },
        );
        leave(
            shaded && self.level_of_detail && self.regular_fibers && !self.vertex_shading,
            "vertex_shading",
            "quality.vertex_shaded_samples is 0",
        );
        leave(!self.culling, "culling", "quality.culling is false");
        leave(!self.statistics, "statistics", "no one asked for them");
        leave(!self.motion_layer, "motion_layer", "layers.motion is false");
        leave(!self.id_layer, "id_layer", "layers.id is false");
        out
    }
}

#[cfg(test)]
#[path = "features_tests.rs"]
mod tests;
