//! No shader function without a kernel and a case.

use crate::{cases, kernel};
use std::path::Path;
use worsted::shaders;

/// Functions that cannot run over free-standing arguments, each with what tests it instead.
const EXEMPT: &[(&str, &str)] = &[
    ("fetch_bezier", "reads the fabric's buffers: tests/fiber_positions.rs"),
    ("fetch_span", "reads the fabric's buffers: tests/fiber_positions.rs"),
    ("fetch_neighbour", "reads the fabric's buffers: tests/motion_layers"),
    ("fetch_neighbour_span", "reads the fabric's buffers: tests/motion_layers"),
    ("fetch_fiber_point", "reads the fabric's buffers: tests/fiber_positions.rs"),
    ("fetch_fiber_at", "reads the fabric's buffers: tests/fiber_positions.rs"),
    ("fetch_fiber_vertex", "reads the fabric's buffers; its parts are strand_vertex and fiber_point"),
    ("first_point_of", "reads the fabric's buffers; its part is packed_curve"),
    ("length_mm_of", "reads the fabric's buffers; its parts are packed_extent and packed_length_mm"),
    ("segment_at", "reads the fabric's buffers: tests/fiber_positions.rs; its part is unpacked_segment"),
    ("self_shadow_depth", "reads a texture: table_reads.rs"),
    ("chord_depth", "reads a texture: table_reads.rs"),
    ("texture_occlusion", "reads a texture: table_reads.rs"),
    ("mark", "private to strand_vertex, which gives all that it sets"),
    ("tip_vertex", "private to strand_vertex, which gives all that it sets where it meets a tip"),
];
const FOLDERS: &[&str] = &["lib", "yarn", "bsdf", "shading"];

/// Names of the functions that GLSL text defines: at the outermost level, `type name(...) {`.
fn functions_defined(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let (mut depth, mut outer) = (0_u32, String::new());
    let code = text.lines().filter(|line| !line.trim_start().starts_with('#'));
    for line in code.map(|line| line.split("//").next().unwrap_or_default()) {
        for c in line.chars().chain([' ']) {
            match c {
                '{' => {
                    if depth == 0 {
                        names.extend(name_of_head(&std::mem::take(&mut outer)));
                    }
                    depth += 1;
                }
                '}' => depth = depth.saturating_sub(1),
                ';' if depth == 0 => outer.clear(),
                _ if depth == 0 => outer.push(c),
                _ => {}
            }
        }
    }
    names
}

/// The name in `type name(...)`, if this is the head of a function.
fn name_of_head(head: &str) -> Option<String> {
    let (declared, rest) = head.split_once('(')?;
    let words: Vec<&str> = declared.split_whitespace().collect();
    (rest.trim_end().ends_with(')') && words.len() >= 2).then(|| words[words.len() - 1].to_owned())
}

fn all_functions() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl");
    let mut functions = Vec::new();
    for folder in FOLDERS {
        for entry in std::fs::read_dir(root.join(folder)).expect("a folder of shader functions") {
            let text = std::fs::read_to_string(entry.expect("a file").path()).expect("GLSL is text");
            functions.extend(functions_defined(&text));
        }
    }
    functions
}

#[test]
fn every_shader_function_has_a_kernel_and_a_case() {
    let functions = all_functions();
    assert!(functions.len() > 20, "found only {functions:?}");
    let cases: Vec<&str> = cases().iter().map(|case| case.function).collect();
    let exempt = |name: &str| EXEMPT.iter().any(|(exempt, _)| *exempt == name);
    for name in &functions {
        let tested = cases.contains(&name.as_str()) && shaders::get(&kernel::path(name)).is_some();
        assert!(tested != exempt(name), "{name}: needs a kernel and a case, or an exemption with its reason");
    }
    for name in cases.into_iter().chain(EXEMPT.iter().map(|(name, _)| *name)) {
        assert!(
            functions.iter().any(|function| function == name),
            "{name}: no such shader function any more"
        );
    }
}

#[test]
fn the_search_finds_definitions_and_nothing_else() {
    let text = "#define F(x) { x }\nconst float PI = f(3.0);\nvec3 later(vec3 v);\n\
                struct S { float f; };\nlayout(set = 0) buffer B { float b[]; };\n\
                // float commented(float x) { }\n\
                float one(float x) { if (x > 0.0) { return g(x); } return 0.0; }\n\
                vec3 two(vec3 a,\n         inout vec3 b[4])\n{\n    return a;\n}\n";
    assert_eq!(functions_defined(text), ["one", "two"]);
}
