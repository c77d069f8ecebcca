//! Constants that both sides hold: specialization constants and plain ones.

use crate::reflection::{self, Reflected};
use crate::text_of;
use worsted::gpu_types::{FIBERS_PER_PATCH, LENGTH_STRIPE, RADIANCE_MAX, TUBE_CORNERS};
use worsted::math::curve::Basis;
use worsted::math::{frame, tone};
use worsted::precompute::self_shadow::SELF_SHADOW_LEAST_SIN;
use worsted::scene::features::Features;
use worsted::scene::file::DebugView;
use worsted::scene::light::LIGHT_RADIUS;
use worsted::scene::shadow_light;
use worsted::yarn::detail::CORE_LEVELS;
use worsted::yarn::tube::{TUBE_CAP, TUBE_ROWS, TUBE_STEPS};

/// Features that need everything there is.
pub fn everything() -> Features {
    Features {
        basis: Basis::CatmullRom,
        culling: true,
        distance_occlusion: true,
        statistics: true,
        specular: true,
        diffuse: true,
        physical: true,
        shadow_map: true,
        soft_shadows: true,
        self_shadow: true,
        chord_shadow: true,
        texture_occlusion: true,
        yarn_occlusion: true,
        ambient: true,
        light_count: 1,
        local_lights: true,
        environment: true,
        debug_view: DebugView::Shaded,
        flyaways: true,
        swift_turns: true,
        core_fibers: true,
        core_fibers_drawn: true,
        level_of_detail: true,
        regular_fibers: true,
        vertex_shading: true,
        motion_layer: true,
        id_layer: true,
        neighbours: true,
    }
}

/// Identifier and name of each specialization constant as Rust has them: `DebugView` is `DEBUG_VIEW`.
fn rust_specialization() -> Vec<(u32, String)> {
    everything().specialization(1, false).map(|(id, _)| (id as u32, screaming(&format!("{id:?}")))).to_vec()
}

fn screaming(camel: &str) -> String {
    let mut name = String::new();
    for c in camel.chars() {
        if c.is_uppercase() && !name.is_empty() {
            name.push('_');
        }
        name.extend(c.to_uppercase());
    }
    name
}

/// Identifier and name of each `layout(constant_id = 3) const bool NAME = ...` of a text.
fn declared(text: &str) -> Vec<(u32, String)> {
    let parse = |line: &str| {
        let (id, rest) = line.strip_prefix("layout(constant_id = ")?.split_once(") const ")?;
        Some((id.parse().ok()?, rest.split_whitespace().nth(1)?.to_owned()))
    };
    text.lines().filter_map(parse).collect()
}

/// Constants of a compiled shader that Rust does not have by that identifier and name.
fn unknown(shader: &Reflected, known: &[(u32, String)]) -> Vec<String> {
    let pair = |(id, name, _): &(u32, String, String)| (*id, name.clone());
    let unknown = shader.constants.iter().map(pair).filter(|constant| !known.contains(constant));
    unknown.map(|(id, name)| format!("{}: constant {id} is {name}", shader.path)).collect()
}

/// The shaders that are specialised by [`Features`]; the tone curve has constants of its own.
fn by_features(shader: &Reflected) -> bool {
    shader.path.starts_with("passes/") && shader.path != "passes/tonemap.comp"
        || shader.path == "test/fiber_point.comp"
}

#[test]
fn specialization_constants_have_one_identifier_and_name() {
    let rust = rust_specialization();
    assert_eq!(declared(&text_of("glsl/shared/features.glsl")), rust);
    let mut used = 0;
    for shader in reflection::all().iter().filter(|shader| by_features(shader)) {
        assert_eq!(unknown(shader, &rust), Vec::<String>::new());
        used += shader.constants.len();
    }
    let tone = [(0, "TONE".to_owned()), (1, "TRANSPARENT".to_owned())];
    assert_eq!(declared(&text_of("glsl/passes/tonemap.comp")), tone, "src/passes/tonemap.rs sets these");
    assert!(used >= rust.len(), "reflection found only {used} constants");
}

#[test]
fn a_moved_or_renamed_specialization_constant_is_found() {
    let mut wrong = rust_specialization();
    let shaders = reflection::all();
    let control = shaders.iter().find(|shader| shader.path == "passes/fibers.tesc").expect("embedded");
    assert_eq!(unknown(control, &wrong), Vec::<String>::new());
    wrong[1].0 = 40;
    assert_eq!(unknown(control, &wrong), ["passes/fibers.tesc: constant 1 is CULLING"]);
    wrong[1] = (1, "CULL".to_owned());
    assert_eq!(unknown(control, &wrong), ["passes/fibers.tesc: constant 1 is CULLING"]);
    let text = "layout(constant_id = 2) const uint BASIS = 0;\nconst uint OTHER = 1;\n";
    assert_eq!(declared(text), [(2, "BASIS".to_owned())]);
}

/// Name and value of each `const type NAME = number;` of a text.
fn plain_constants(text: &str) -> Vec<(String, f64)> {
    let parse = |line: &str| {
        let (head, rest) = line.strip_prefix("const ")?.split_once(" = ")?;
        Some((head.split(' ').nth(1)?.to_owned(), rest.split(';').next()?.parse().ok()?))
    };
    text.lines().filter_map(parse).collect()
}

/// What a shader file says that the host does not, or the other way round.
fn unequal(text: &str, rust: &[(&str, f64)]) -> Vec<String> {
    let shader = plain_constants(text);
    // The device reads a constant as f32 (or a whole number, which f32 holds).
    let equal = |(name, value): &(String, f64)| {
        rust.iter().any(|(ours, expected)| ours == name && *value as f32 == *expected as f32)
    };
    let unknown =
        shader.iter().filter(|c| !equal(c)).map(|(name, value)| format!("{name} = {value} in GLSL"));
    let missing = rust.iter().filter(|(ours, _)| !shader.iter().any(|(name, _)| name == ours));
    unknown.chain(missing.map(|(name, _)| format!("{name} is not in GLSL"))).collect()
}

#[test]
fn plain_constants_are_equal() {
    use std::f64::consts::{PI, TAU};
    let bases = [
        ("BASIS_CATMULL_ROM", Basis::CatmullRom),
        ("BASIS_B_SPLINE", Basis::BSpline),
        ("BASIS_BEZIER", Basis::Bezier),
        ("BASIS_POLYLINE", Basis::Polyline),
    ]
    .map(|(name, basis)| (name, f64::from(basis as u32)));
    let views = [
        ("VIEW_SHADED", DebugView::Shaded),
        ("VIEW_NORMAL", DebugView::Normal),
        ("VIEW_TANGENT", DebugView::Tangent),
        ("VIEW_OCCLUSION", DebugView::Occlusion),
        ("VIEW_PLY", DebugView::Ply),
        ("VIEW_KIND", DebugView::Kind),
        ("VIEW_FRAME", DebugView::Frame),
        ("VIEW_LENGTH", DebugView::Length),
        ("VIEW_LEVEL_OF_DETAIL", DebugView::LevelOfDetail),
    ]
    .map(|(name, view)| (name, f64::from(view as u32)));
    let files: [(&str, &[(&str, f64)]); 8] = [
        (
            "glsl/shared/constants.glsl",
            &[
                ("PI", PI),
                ("TWO_PI", TAU),
                ("FIBERS_PER_PATCH", f64::from(FIBERS_PER_PATCH)),
                ("CORE_LEVELS", f64::from(CORE_LEVELS)),
                ("LENGTH_STRIPE", f64::from(LENGTH_STRIPE)),
                ("LIGHT_RADIUS", LIGHT_RADIUS),
                ("RADIANCE_MAX", f64::from(RADIANCE_MAX)),
                ("TUBE_STEPS", f64::from(TUBE_STEPS)),
                ("TUBE_CORNERS", f64::from(TUBE_CORNERS)),
            ],
        ),
        ("glsl/shared/debug_views.glsl", &views),
        ("glsl/lib/curve.glsl", &bases),
        ("glsl/lib/frame.glsl", &[("NO_DIRECTION", frame::NO_DIRECTION)]),
        ("glsl/shading/self_shadow.glsl", &[("SELF_SHADOW_LEAST_SIN", SELF_SHADOW_LEAST_SIN)]),
        ("glsl/yarn/tube.glsl", &[("TUBE_CAP", TUBE_CAP)]),
        (
            "glsl/shading/shadow_map.glsl",
            &[
                ("SHADOW_STEEPEST", shadow_light::SHADOW_STEEPEST),
                ("SHADOW_MARGIN", shadow_light::SHADOW_MARGIN),
                ("SHADOW_BIAS", shadow_light::SHADOW_BIAS),
                ("SHADOW_WIDEST", shadow_light::SHADOW_WIDEST),
                ("SHADOW_TAPS", f64::from(shadow_light::SHADOW_TAPS)),
                ("GOLDEN_ANGLE", shadow_light::GOLDEN_ANGLE),
            ],
        ),
        ("glsl/lib/tone.glsl", &[("TONE_KNEE", tone::TONE_KNEE), ("FILMIC_END", tone::FILMIC_END)]),
    ];
    for (file, rust) in files {
        assert_eq!(unequal(&text_of(file), rust), Vec::<String>::new(), "{file}");
    }
    assert_eq!(TUBE_CORNERS, 2 * TUBE_ROWS);
}

#[test]
fn an_unequal_missing_or_unknown_plain_constant_is_found() {
    let text = "const float PI = 3.14159265358979;\nconst uint FIBERS_PER_PATCH = 64;\n";
    let right = [("PI", std::f64::consts::PI), ("FIBERS_PER_PATCH", 64.0)];
    assert_eq!(unequal(text, &right), Vec::<String>::new());
    assert_eq!(unequal(text, &[right[0], ("FIBERS_PER_PATCH", 32.0)]), ["FIBERS_PER_PATCH = 64 in GLSL"]);
    assert_eq!(unequal(text, &right[..1]), ["FIBERS_PER_PATCH = 64 in GLSL"]);
    assert_eq!(unequal(text, &[right[0], right[1], ("KNEE", 0.8)]), ["KNEE is not in GLSL"]);
}
