//! Shaders that somebody edits, without what features leave out: whatever way they go, they stay valid.

use crate::text_of;
use crate::validator::{validate, variants};
use worsted::passes::strand_pipeline::{Manner, specialization};
use worsted::shaders;
use worsted::vulkan::{trimmed, vk};

#[path = "../../src/shaders/glsl.rs"]
mod glsl;

const SHADED: &str = "passes/fibers.frag";

/// Ways through a shader that specialization constants decide, wholly or in part, at its start.
const WAYS: [&str; 9] = [
    "for (int i = 0; i < 4; ++i) { if (SPECULAR) { continue; } if (AT_VERTICES) { break; } radiance.x += 1.0; }",
    "while (DIFFUSE) { radiance.x += 1.0; if (radiance.x > 3.0) { break; } }",
    "switch (DEBUG_VIEW) { case 1u: radiance.x = 1.0; case 2u: radiance.y = 1.0; break; default: if (AT_VERTICES) { return; } }",
    "radiance.x = AT_VERTICES ? dFdx(fragment_across) : (SPECULAR ? 2.0 : 1.0);",
    "do { if (AT_VERTICES) { return; } radiance.x += 1.0; } while (radiance.x < 2.0 && SPECULAR);",
    "if (AT_VERTICES && fragment_across > 0.0) { discard; } else if (!AT_VERTICES || SPECULAR) { radiance.x = 1.0; }",
    "for (int i = 0; i < 3; ++i) { for (int j = i; j < 3; ++j) { if (AMBIENT) { return; } if (j == 2) { break; } } }",
    "for (;;) { if (AT_VERTICES) { break; } if (SPECULAR) { return; } break; }",
    "bool way = SPECULAR || fragment_across > 0.0; while (way) { way = AT_VERTICES && AMBIENT; }",
];

#[test]
fn edited_shaders_without_what_features_leave_out_are_valid() {
    let main = "void main() {\n";
    for way in WAYS {
        let read = |path: &str| {
            let text = text_of(&format!("glsl/{path}"));
            Ok(if path == SHADED { text.replace(main, &format!("{main}    {way}\n")) } else { text })
        };
        let stage = glsl::stage_of(SHADED).expect("a fragment shader");
        let words = glsl::compile(SHADED, stage, &read).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(validate(&words), Ok(()), "{way}");
        assert_ne!(Some(&words[..]), shaders::get(SHADED), "{way}");
        for features in variants() {
            for manner in [Manner::AtPixels, Manner::AtVertices] {
                let constants = specialization(&features.of_picture(), vk::SampleCountFlags::TYPE_1, manner);
                let trimmed = trimmed(&words, &constants).expect("SPIR-V");
                assert_eq!(validate(&trimmed), Ok(()), "{way}\nfor {features:?}, {manner:?}");
            }
        }
    }
}
