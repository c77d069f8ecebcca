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
    let expected = [
        "environment",
        "id_layer",
        "local_lights",
        "motion_layer",
        "soft_shadows",
        "statistics",
        "swift_turns",
    ];
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
fn plies_that_no_table_shows_are_followed_one_by_one() {
    let flat = |fabric: &mut Fabric| fabric.yarn.ellipse_short_mm = 0.05;
    let usual = features(|file, _| file.shadow.inside = true);
    assert!(usual.self_shadow && !usual.chord_shadow);
    let thin = features(|file, fabric| (file.shadow.inside = true, flat(fabric)).1);
    assert!(thin.self_shadow && thin.chord_shadow);
    let stated = features(|file, fabric| {
        (file.shadow.inside, file.quality.self_shadow_texels) = (true, Some(128));
        flat(fabric);
    });
    assert!(stated.self_shadow && !stated.chord_shadow);
    let unlit = features(|file, fabric| (file.shadow.inside = false, flat(fabric)).1);
    assert!(!unlit.self_shadow && !unlit.chord_shadow);
}

#[test]
fn cuts_follow_turns_only_where_yarn_turns_fast_or_may_come_to() {
    let knitted = features(|_, _| {});
    assert!(!knitted.swift_turns && knitted.left_out().contains_key("swift_turns"));
    let hairpin = features(|_, fabric| fabric.turns_swiftly = true);
    assert!(hairpin.swift_turns && !hairpin.left_out().contains_key("swift_turns"));
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
    assert!(no_light.light_count == 0 && no_light.specular && no_light.ambient, "lobes gather ambient light");
    let dark = features(|file, _| {
        file.light = Some(Vec::new());
        file.ambient.radiance = Some([0.0; 3]);
    });
    assert!(!dark.specular && !dark.diffuse && !dark.physical);
    let lit =
        |lights: &str| features(|file, _| file.light = toml::from_str::<SceneFile>(lights).unwrap().light);
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
