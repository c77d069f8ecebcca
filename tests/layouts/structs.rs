//! Structs of `glsl/shared/layouts.glsl` against `src/gpu_types.rs`.

use crate::reflection::{self, Layout};
use crate::{rust_side, text_of};

/// What differs between two layouts of one struct, a line each.
pub fn differences(rust: &Layout, shader: &Layout) -> Vec<String> {
    let mut found = Vec::new();
    let name = &rust.name;
    for (index, (ours, theirs)) in rust.members.iter().zip(&shader.members).enumerate() {
        if ours.name != theirs.name {
            found.push(format!("{name}, member {index}: `{}` in Rust, `{}` in GLSL", ours.name, theirs.name));
        }
        if ours.offset != theirs.offset {
            let (here, there) = (ours.offset, theirs.offset);
            found.push(format!("{name}.{}: at byte {here} in Rust, {there} in GLSL", ours.name));
        }
        if ours.kind != theirs.kind {
            found.push(format!("{name}.{}: {} in Rust, {} in GLSL", ours.name, ours.kind, theirs.kind));
        }
    }
    let (ours, theirs) = (rust.members.len(), shader.members.len());
    if ours != theirs {
        found.push(format!("{name}: {ours} members in Rust, {theirs} in GLSL"));
    }
    if rust.stride != shader.stride {
        found.push(format!("{name}: {} bytes in Rust, {} in GLSL", rust.stride, shader.stride));
    }
    found
}

/// Names of the structs that GLSL text defines.
fn structs_defined(text: &str) -> Vec<&str> {
    text.lines().filter_map(|line| line.strip_prefix("struct ")?.split([' ', '{']).next()).collect()
}

#[test]
fn every_struct_lies_the_same_on_both_sides() {
    let shaders = reflection::all();
    let rust = rust_side::layouts();
    let mut seen = Vec::new();
    for shader in &shaders {
        for found in &shader.structs {
            let Some(ours) = rust.iter().find(|layout| layout.name == found.name) else { continue };
            let wrong = differences(ours, found);
            assert!(wrong.is_empty(), "{}:\n{}", shader.path, wrong.join("\n"));
            seen.push(ours.name.as_str());
        }
    }
    let text = text_of("glsl/shared/layouts.glsl");
    let defined = structs_defined(&text);
    assert!(defined.len() >= 8, "{defined:?}");
    for name in defined {
        assert!(rust.iter().any(|layout| layout.name == name), "{name}: add it to rust_side.rs");
        assert!(seen.contains(&name), "{name}: no shader uses it, so that nothing holds it equal");
    }
}

#[test]
fn any_difference_of_layouts_is_named() {
    let right = rust_side::layouts().into_iter().find(|layout| layout.name == "Curve").expect("listed");
    assert_eq!(differences(&right, &right), Vec::<String>::new());
    type Edit = fn(&mut Layout);
    let edits: [(Edit, &str); 6] = [
        (|l| l.members[5].offset += 4, "Curve.migration_phase: at byte 20 in Rust, 24 in GLSL"),
        (|l| l.members[1].name = "strand".into(), "`curve` in Rust, `strand` in GLSL"),
        (|l| l.members[2].kind = "int".into(), "Curve.migration_period_count: uint in Rust, int in GLSL"),
        (|l| l.stride = 48, "Curve: 64 bytes in Rust, 48 in GLSL"),
        (|l| l.members.truncate(11), "12 members in Rust, 11 in GLSL"),
        (|l| l.members.swap(4, 5), "`fiber_phase` in Rust, `migration_phase` in GLSL"),
    ];
    for (edit, expected) in edits {
        let mut wrong = right.clone();
        edit(&mut wrong);
        let found = differences(&right, &wrong).join("\n");
        assert!(found.contains(expected), "expected {expected:?} in {found:?}");
    }
    assert_eq!(structs_defined("// struct A {\nstruct B {\n    struct C c;\n};\nstruct D{"), ["B", "D"]);
}
