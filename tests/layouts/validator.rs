//! Every embedded shader through Khronos' validator.

use crate::constants::everything;
use std::io::Write;
use std::process::{Command, Stdio};
use worsted::passes::strand_pipeline::{Manner, specialization};
use worsted::scene::features::Features;
use worsted::scene::file::DebugView;
use worsted::shaders;
use worsted::vulkan::{trimmed, vk};

/// What `spirv-val` says of a module; `Ok` if it is valid.
pub fn validate(words: &[u32]) -> Result<(), String> {
    let mut child = Command::new("spirv-val")
        .args(["--target-env", "vulkan1.3", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("spirv-val runs (Debian package spirv-tools; tools/test installs it)");
    // A validator that gives up early closes its end; what it says then is the answer.
    let _ = child.stdin.take().expect("piped").write_all(bytemuck::cast_slice(words));
    let output = child.wait_with_output().expect("spirv-val ends");
    let said =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    output.status.success().then_some(()).ok_or(said)
}

#[test]
fn every_embedded_shader_is_valid() {
    for (path, words) in shaders::all() {
        assert_eq!(validate(words), Ok(()), "{path}");
    }
}

/// Everything, nothing, and everything but one thing.
pub fn variants() -> Vec<Features> {
    let edits: [fn(&mut Features); 19] = [
        |_| (),
        |f| f.statistics = false,
        |f| f.light_count = 0,
        |f| f.shadow_map = false,
        |f| f.soft_shadows = false,
        |f| (f.self_shadow, f.chord_shadow) = (false, false),
        |f| f.chord_shadow = false,
        |f| (f.texture_occlusion, f.distance_occlusion) = (false, false),
        |f| f.yarn_occlusion = false,
        |f| f.ambient = false,
        |f| f.physical = false,
        |f| (f.specular, f.physical) = (false, false),
        |f| f.diffuse = false,
        |f| f.flyaways = false,
        |f| f.swift_turns = false,
        |f| (f.core_fibers, f.level_of_detail) = (false, false),
        |f| f.culling = false,
        |f| f.debug_view = DebugView::Occlusion,
        |f| {
            *f = Features {
                culling: false,
                statistics: false,
                light_count: 0,
                shadow_map: false,
                soft_shadows: false,
                self_shadow: false,
                chord_shadow: false,
                texture_occlusion: false,
                distance_occlusion: false,
                yarn_occlusion: false,
                ambient: false,
                physical: false,
                specular: false,
                diffuse: false,
                flyaways: false,
                swift_turns: false,
                core_fibers: false,
                level_of_detail: false,
                ..*f
            }
        },
    ];
    edits
        .map(|edit| {
            let mut features = everything();
            edit(&mut features);
            features
        })
        .to_vec()
}

/// As the layers are drawn: both, one of them, of cloth that stands still, of every fiber.
fn layered() -> Vec<Features> {
    let edits: [fn(&mut Features); 5] = [
        |_| (),
        |f| f.id_layer = false,
        |f| (f.motion_layer, f.neighbours) = (false, false),
        |f| f.neighbours = false,
        |f| (*f = f.whole(), f.flyaways = false).1,
    ];
    edits
        .map(|edit| {
            let mut features = everything().of_layers();
            edit(&mut features);
            features
        })
        .to_vec()
}

#[test]
fn shaders_without_what_features_leave_out_are_valid_and_shorter() {
    let passes = ["passes/fibers.", "passes/core.", "passes/layers.", "passes/shadow_map."];
    let strands = || shaders::all().filter(|(path, _)| passes.iter().any(|pass| path.starts_with(pass)));
    for (path, words) in strands() {
        let manners = |features| [Manner::AtPixels, Manner::AtVertices].map(|manner| (features, manner));
        let of_layers = layered().into_iter().map(|features| (features, Manner::AtPixels));
        let of_pictures = variants().into_iter().map(|features| features.of_picture());
        for (features, manner) in of_pictures.flat_map(manners).chain(of_layers) {
            let constants = specialization(&features, vk::SampleCountFlags::TYPE_1, manner);
            let trimmed = trimmed(words, &constants).expect("SPIR-V");
            assert_eq!(validate(&trimmed), Ok(()), "{path} for {features:?}, {manner:?}");
            assert!(trimmed.len() <= words.len(), "{path}");
        }
    }
    let (_, whole) = strands().find(|(path, _)| *path == "passes/fibers.frag").expect("embedded");
    let least = variants().pop().expect("variants").of_picture();
    let constants = specialization(&least, vk::SampleCountFlags::TYPE_1, Manner::AtPixels);
    let trimmed = trimmed(whole, &constants).expect("SPIR-V");
    assert!(trimmed.len() * 3 < whole.len(), "{} of {} words are left", trimmed.len(), whole.len());
}

#[test]
fn broken_modules_are_refused() {
    let words = shaders::get("passes/tonemap.comp").expect("embedded");
    let cut_short = &words[..words.len() - 3];
    let mut wrong_bound = words.to_vec();
    wrong_bound[3] = 1;
    for broken in [cut_short, &wrong_bound, &[], &[1, 2, 3]] {
        assert!(validate(broken).is_err(), "a broken module of {} words passed", broken.len());
    }
}
