//! Scene to features: the only place that leaves things out.

use super::Fabric;
use super::file::{DebugView, FibersShown, OcclusionMode, SceneFile, ShadingModel};
use crate::math::curve::Basis;
use crate::yarn::flyaway::Flyaways;
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
        let dimmed = ambient || file.debug.view == DebugView::Occlusion;
        Self {
            basis: fabric.strands.basis,
            culling: file.quality.culling,
            distance_occlusion: dimmed && file.occlusion.mode == OcclusionMode::Distance,
            texture_occlusion: dimmed && file.occlusion.mode == OcclusionMode::Texture,
            yarn_occlusion: ambient && file.occlusion.yarns && file.occlusion.mode != OcclusionMode::None,
            shadow_map: lit && file.shadow.map,
            soft_shadows: lit && file.shadow.map && soft,
            self_shadow: file.shadow.inside && (lit || ambient && lobes),
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
            core_fibers: shown != FibersShown::Every,
            core_fibers_drawn: matches!(shown, FibersShown::Both | FibersShown::Core),
            level_of_detail: file.quality.level_of_detail && shown != FibersShown::Every,
            regular_fibers: shown != FibersShown::Core,
            vertex_shading: shaded
                && file.quality.level_of_detail
                && matches!(shown, FibersShown::Both | FibersShown::Regular)
                && file.quality.vertex_shaded_samples > 0.0,
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
    pub fn specialization(&self, samples: u32, at_vertices: bool) -> [(SpecializationId, u32); 24] {
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
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::light::LightTable;

    fn features(edit: impl FnOnce(&mut SceneFile, &mut Fabric)) -> Features {
        let mut file = SceneFile::default();
        let mut fabric = Fabric::for_tests();
        edit(&mut file, &mut fabric);
        Features::new(&file, &fabric, false)
    }

    #[test]
    fn a_default_scene_leaves_out_only_what_it_lacks() {
        let out = features(|_, _| {}).left_out();
        let expected = ["environment", "local_lights", "soft_shadows", "statistics"];
        assert_eq!(out.keys().copied().collect::<Vec<_>>(), expected);
    }

    #[test]
    fn shadows_and_occlusion_are_there_only_where_they_dim_something() {
        let shadowed = |edit: fn(&mut SceneFile)| {
            features(|file, _| {
                (file.shadow.map, file.shadow.inside) = (true, true);
                edit(file);
            })
        };
        let all = shadowed(|_| {});
        assert!(all.shadow_map && all.self_shadow && all.distance_occlusion && !all.texture_occlusion);
        let out = |edit: fn(&mut SceneFile)| {
            let features = shadowed(edit);
            (features, features.left_out())
        };
        let (bare, why) = out(|file| (file.shadow.map, file.shadow.inside) = (false, false));
        assert!(!bare.shadow_map && !bare.self_shadow);
        assert_eq!((why["shadow_map"], why["self_shadow"]), ("shadow.map is false", "shadow.self is false"));
        assert!(!why.contains_key("soft_shadows"), "what is not there cannot be soft");
        let sized: fn(&mut SceneFile) = |file| {
            file.light = Some(vec![LightTable { angular_size_deg: 1.0, ..Default::default() }]);
        };
        let (soft, why) = out(sized);
        assert!(soft.soft_shadows && !why.contains_key("soft_shadows"));
        let dark = shadowed(|file| {
            let none = LightTable { angular_size_deg: 1.0, irradiance: Some([0.0; 3]), ..Default::default() };
            file.light = Some(vec![none]);
        });
        assert!(!dark.shadow_map && !dark.soft_shadows && dark.self_shadow, "it dims what passes the yarn");
        let matte = shadowed(|file| {
            file.light = Some(Vec::new());
            file.shading.model = ShadingModel::Simple;
        });
        assert!(matte.ambient && !matte.self_shadow, "uniform light has no direction to dim");
        let (texture, why) = out(|file| file.occlusion.mode = OcclusionMode::Texture);
        assert!(texture.texture_occlusion && !texture.distance_occlusion && !why.contains_key("occlusion"));
        let (none, why) = out(|file| file.occlusion.mode = OcclusionMode::None);
        assert!(!none.texture_occlusion && !none.distance_occlusion);
        assert_eq!(why["occlusion"], "occlusion.mode is none");
        let (view, _) = out(|file| file.debug.view = DebugView::Normal);
        assert!(!view.shadow_map && !view.self_shadow && !view.distance_occlusion);
    }

    #[test]
    fn a_yarn_without_loops_and_hairs_has_no_branch_for_them() {
        let smooth = features(|_, fabric| {
            fabric.yarn.hair_density_per_mm = 0.0;
            fabric.yarn.loop_density_per_mm = 0.0;
        });
        assert!(!smooth.flyaways && smooth.left_out().contains_key("flyaways"));
    }

    #[test]
    fn what_a_scene_lacks_is_left_out_with_its_reason() {
        let no_ambient = features(|file, _| file.ambient.radiance = Some([0.0; 3]));
        assert!(!no_ambient.ambient && !no_ambient.distance_occlusion);
        assert_eq!(no_ambient.left_out()["occlusion"], "no ambient light to dim");
        let no_light = features(|file, _| file.light = Some(Vec::new()));
        assert!(
            no_light.light_count == 0 && no_light.specular && no_light.ambient,
            "lobes gather ambient light"
        );
        let dark = features(|file, _| {
            file.light = Some(Vec::new());
            file.ambient.radiance = Some([0.0; 3]);
        });
        assert!(!dark.specular && !dark.diffuse && !dark.physical);
        let lit = |lights: &str| {
            features(|file, _| file.light = toml::from_str::<SceneFile>(lights).unwrap().light)
        };
        let point = "kind = 'point', position_mm = [0, 0, 9]";
        let two = lit(&format!("light = [{{}}, {{{point}, intensity = [0, 0, 0]}}, {{}}]"));
        assert!(two.light_count == 2 && !two.local_lights && two.left_out().contains_key("local_lights"));
        let local = lit(&format!("light = [{{irradiance = [0, 0, 0]}}, {{{point}}}]"));
        assert!(local.light_count == 1 && local.local_lights);
        let sky = features(|file, _| file.ambient.environment = Some("sky.exr".into()));
        assert!(sky.environment && sky.ambient && sky.distance_occlusion);
        let matte = features(|file, fabric| {
            file.shading.model = ShadingModel::Simple;
            fabric.fiber.specular = Some([0.0; 3]);
        });
        assert!(!matte.specular && !matte.physical && matte.light_count == 1);
        let simple = features(|file, _| file.shading.model = ShadingModel::Simple);
        assert!(simple.specular && simple.left_out().contains_key("scattering_tables"));
        let glossy = features(|file, _| file.shading.diffuse = false);
        assert!(!glossy.diffuse && glossy.physical && glossy.ambient);
        let diffuse = features(|file, _| file.shading.specular = false);
        assert!(diffuse.diffuse && !diffuse.specular && !diffuse.physical && diffuse.ambient);
        let only_simple = features(|file, _| {
            file.shading.model = ShadingModel::Simple;
            file.shading.diffuse = false;
        });
        assert!(only_simple.specular && !only_simple.ambient, "the simple lobe has no integral");
        assert!(!features(|file, _| file.shading.ambient = false).ambient);
        let every = features(|file, _| file.debug.fibers = FibersShown::Every);
        assert!(!every.core_fibers && !every.level_of_detail && every.regular_fibers);
        assert!(every.left_out().contains_key("core_fibers"));
        let core = features(|file, _| file.debug.fibers = FibersShown::Core);
        assert!(core.core_fibers && !core.regular_fibers && core.left_out().contains_key("regular_fibers"));
        let whole = features(|file, _| file.quality.level_of_detail = false);
        assert!(!whole.level_of_detail && whole.core_fibers);
        let view = features(|file, _| file.debug.view = DebugView::Normal);
        assert!(view.light_count == 0 && !view.ambient && view.left_out().contains_key("shading"));
    }
}
