use super::*;
use std::fs;

const TONEMAP: &str = "passes/tonemap.comp";
const SHADED: &str = "passes/fibers.frag";

/// A copy of all that is only included, and of these shaders; the others are not there.
struct Edited {
    home: tempfile::TempDir,
}

impl Edited {
    fn of(shaders: &[&str]) -> Self {
        let edited = Self { home: tempfile::tempdir().unwrap() };
        edited.copy(&Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl"), "", shaders);
        edited
    }

    fn copy(&self, from: &Path, below: &str, shaders: &[&str]) {
        fs::create_dir_all(self.home.path().join(below)).unwrap();
        for entry in fs::read_dir(from.join(below)).unwrap() {
            let name = format!("{below}{}", entry.unwrap().file_name().into_string().unwrap());
            if from.join(&name).is_dir() {
                self.copy(from, &format!("{name}/"), shaders);
            } else if glsl::stage_of(&name).is_none()
                || shaders.is_empty()
                || shaders.contains(&name.as_str())
            {
                fs::copy(from.join(&name), self.home.path().join(&name)).unwrap();
            }
        }
    }

    fn write(&self, path: &str, text: impl AsRef<[u8]>) {
        fs::write(self.home.path().join(path), text).unwrap();
    }

    fn text(&self, path: &str) -> String {
        fs::read_to_string(self.home.path().join(path)).unwrap()
    }

    /// Replaces what stands in a file exactly once.
    fn replace(&self, path: &str, from: &str, to: &str) {
        let text = self.text(path);
        assert_eq!(text.matches(from).count(), 1, "{path}: {from}");
        self.write(path, text.replace(from, to));
    }

    fn folder(&self) -> Folder {
        Folder::new(self.home.path().to_owned())
    }

    fn found(&self) -> Result<ShaderSet, String> {
        self.folder().shaders(&|| true).unwrap()
    }

    /// What is said of it; that it is refused is a matter of course.
    fn refused(&self) -> String {
        self.found().expect_err("it is refused")
    }
}

#[test]
fn what_nobody_edits_is_what_is_embedded_and_is_compiled_once() {
    let edited = Edited::of(&[]);
    let mut folder = edited.folder();
    assert!(folder.shaders(&|| false).is_none(), "it is given up where somebody says so");
    assert!(folder.shaders(&|| true).unwrap().unwrap().is_embedded());
    assert_eq!(folder.compiled.len(), all().count());
    let place = |folder: &Folder, name: &str| folder.compiled[name].words.as_ref().unwrap().as_ptr();
    let before = [TONEMAP, SHADED].map(|name| place(&folder, name));
    edited.replace("lib/tone.glsl", "const float TONE_KNEE = 0.8;", "const float TONE_KNEE = 0.7;");
    let set = folder.shaders(&|| true).unwrap().unwrap();
    let replaced: Vec<_> = set.replaced().collect();
    assert!(
        replaced.contains(&TONEMAP) && replaced.iter().all(|path| edited.text(path).contains("tone.glsl"))
    );
    assert!(
        set.get(TONEMAP) != crate::shaders::get(TONEMAP) && set.get(SHADED) == crate::shaders::get(SHADED)
    );
    let after = [TONEMAP, SHADED].map(|name| place(&folder, name));
    assert!(after[0] != before[0] && after[1] == before[1]);
}

#[test]
fn a_file_that_is_not_there_is_the_embedded_one_and_a_folder_that_is_not_is_an_error() {
    let edited = Edited::of(&[TONEMAP]);
    assert!(edited.found().unwrap().is_embedded());
    edited.replace(TONEMAP, "vec4(encoded, alpha)", "vec4(encoded.bgr, alpha)");
    assert_eq!(edited.found().unwrap().replaced().collect::<Vec<_>>(), [TONEMAP]);
    fs::remove_file(edited.home.path().join(TONEMAP)).unwrap();
    assert!(edited.found().unwrap().is_embedded());
    let found = |root: PathBuf| Folder::new(root).shaders(&|| true).unwrap().unwrap_err();
    assert!(found(edited.home.path().join("nowhere")).ends_with("expected a folder of shaders, found none"));
    assert!(found(edited.home.path().join("lib/tone.glsl")).ends_with("found something else"));
}

#[test]
fn what_the_compiler_says_names_file_and_line_once_until_it_is_mended() {
    let edited = Edited::of(&[TONEMAP, SHADED, "passes/core.frag"]);
    let mut folder = edited.folder();
    let mut found = || folder.shaders(&|| true).unwrap();
    edited.replace(TONEMAP, "    linear *= exposure_scale;", "    linear *= exposure_scales;");
    let line = 1 + edited.text(TONEMAP).lines().position(|line| line.contains("exposure_scales")).unwrap();
    let said = found().unwrap_err();
    assert!(
        said.starts_with(&format!("{TONEMAP}:{line}: 'exposure_scales' : undeclared identifier")),
        "{said}"
    );
    // Of a file that three shaders include, two by way of another.
    edited.write("shading/light.glsl", "vec3 light = ;\n");
    let said = found().unwrap_err();
    assert_eq!(said.lines().filter(|line| line.starts_with("shading/light.glsl:")).count(), 1, "{said}");
    assert!(said.contains(&format!("{TONEMAP}:{line}: ")), "{said}");
    let glsl = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl");
    for path in [TONEMAP, "shading/light.glsl"] {
        edited.write(path, fs::read(glsl.join(path)).unwrap());
    }
    assert!(found().unwrap().is_embedded());
}

#[test]
fn files_that_are_no_shaders_are_refused_in_words() {
    let including = |what: &str| {
        let text = "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"WHAT\"\nvoid main() {}\n";
        text.replace("WHAT", what).into_bytes()
    };
    let nested =
        format!("#version 460\nvoid main() {{ int x = {}1{}; }}\n", "(".repeat(200_000), ")".repeat(200_000));
    let files: [(&[u8], &str); 13] = [
        (b"", "#version"),
        (b"\n\n", "#version"),
        (b"void main() {}\n", "#version"),
        (b"#version 460\nlayout(local_size_x = 8) in;\n", "Missing entry point"),
        (b"#version 460\nvoid main() { \xff }\n", "expected UTF-8, found other bytes in line 2"),
        (b"#version 460\0\nvoid main() {}\n", "expected text, found a zero byte"),
        ("#version 46\u{e9}\n".as_bytes(), "expected ASCII in the first line"),
        ("#version 460\nvoid main() { float \u{e9} = 1.0; }\n".as_bytes(), TONEMAP),
        (b"#version 99\nvoid main() {}\n", "version not supported"),
        (&vec![b' '; 1 << 21], "expected at most 1048576 bytes, found more"),
        (nested.as_bytes(), TONEMAP),
        (
            &including("../lib/nowhere.glsl"),
            "`#include \"../lib/nowhere.glsl\"`: expected a file, found none",
        ),
        (&including("/etc/passwd"), "expected a path relative to the including file"),
    ];
    let edited = Edited::of(&[TONEMAP]);
    // As the thread that does it has: what is nested is gone down into.
    let check = move || {
        for (text, said) in files {
            edited.write(TONEMAP, text);
            let found = edited.refused();
            assert!(found.contains(said) && found.contains(TONEMAP), "expected {said:?} in {found:?}");
        }
        fs::remove_file(edited.home.path().join(TONEMAP)).unwrap();
        fs::create_dir(edited.home.path().join(TONEMAP)).unwrap();
        assert!(edited.refused().ends_with("expected a file, found something else"));
    };
    std::thread::scope(|scope| {
        std::thread::Builder::new().stack_size(64 << 20).spawn_scoped(scope, check).unwrap().join().unwrap();
    });
}

#[test]
fn includes_that_go_round_end() {
    let edited = Edited::of(&[TONEMAP]);
    for text in [
        "#include \"tone.glsl\"\n",
        // As often as there are ways down, if nobody stopped.
        "#include \"tone.glsl\"\n#include \"tone.glsl\"\n",
        "#include \"other.glsl\"\n",
    ] {
        edited.write("lib/tone.glsl", text);
        edited.write("lib/other.glsl", "#include \"tone.glsl\"\n");
        let said = edited.refused();
        assert!(said.contains("lib/") && said.contains("does a file include itself?"), "{said}");
    }
    // Not round, but too many: each level twice the one below.
    for level in 0..20 {
        let next = format!("#include \"{}.glsl\"\n", level + 1);
        edited.write(&format!("lib/{level}.glsl"), next.repeat(2));
    }
    edited.write("lib/20.glsl", "");
    edited.write("lib/tone.glsl", "#include \"0.glsl\"\n");
    assert!(edited.refused().contains("at most 2000, found more"));
}

/// Shader, file, what stands there, what is put in its place, and what is said of that.
type Other = (&'static str, &'static str, &'static str, &'static str, &'static str);

const SHADOW_VERTEX: &str = "passes/shadow_map.vert";
const SHADOW_FRAGMENT: &str = "passes/shadow_map.frag";

/// A difference of each kind.
const OTHERS: [Other; 18] = [
    (
        TONEMAP,
        TONEMAP,
        "binding = 1, rgba8",
        "binding = 2, rgba8",
        "set 0, binding 2: expected none, found UniformConstant",
    ),
    (
        TONEMAP,
        TONEMAP,
        "set = 0, binding = 1, rgba8",
        "set = 1, binding = 1, rgba8",
        "set 0, binding 1: expected UniformConstant",
    ),
    (
        TONEMAP,
        TONEMAP,
        "rgba8) uniform",
        "rgba16f) uniform",
        "Rgba8), found UniformConstant writeonly image of float",
    ),
    (
        TONEMAP,
        TONEMAP,
        "readonly image2D",
        "image2D",
        "set 0, binding 0: expected UniformConstant readonly image",
    ),
    (
        SHADED,
        "shared/layouts.glsl",
        "float radius;           // R_i",
        "float radius, more;     // R_i",
        "set 1, binding 2: expected StorageBuffer",
    ),
    (
        SHADED,
        "shared/layouts.glsl",
        "// of the whole curve at rest\n    uint padding;",
        "\n    uint more;",
        "set 1, binding 11: expected StorageBuffer",
    ),
    (
        TONEMAP,
        TONEMAP,
        "float exposure_scale; };",
        "float exposure_scale; float more; };",
        "push constants: expected { vec3 background at 0; float exposure_scale at 12; }, found {",
    ),
    (
        SHADED,
        SHADED,
        "layout(location = 8) centroid in",
        "layout(location = 9) centroid in",
        "input at location 8: expected vec3, found none",
    ),
    (
        SHADOW_FRAGMENT,
        SHADOW_FRAGMENT,
        "flat in uint piece",
        "flat in int piece",
        "input at location 1: expected uint, found int",
    ),
    (
        SHADOW_VERTEX,
        SHADOW_VERTEX,
        "layout(location = 0) out float",
        "layout(location = 2) out float",
        "output at location 0: expected float, found none",
    ),
    (
        TONEMAP,
        TONEMAP,
        "local_size_x = 8,",
        "local_size_x = 16,",
        "mode LocalSize: expected (8, 8, 1), found (16, 8, 1)",
    ),
    (
        TONEMAP,
        TONEMAP,
        "const uint TONE = 0;",
        "const float TONE = 0.0;",
        "specialization constant 0: expected uint, found float",
    ),
    (
        TONEMAP,
        TONEMAP,
        "const bool TRANSPARENT",
        "const bool MORE = true;\nlayout(constant_id = 2) const bool TRANSPARENT",
        "specialization constant 2: expected none, found bool",
    ),
    (
        TONEMAP,
        TONEMAP,
        "    linear *= exposure_scale;",
        "    double more = double(exposure_scale);\n    linear *= float(more);",
        "capability Float64: not in this build's shader",
    ),
    (
        SHADOW_FRAGMENT,
        SHADOW_FRAGMENT,
        "piece + 1u",
        "piece + uint(gl_PrimitiveID)",
        "built-in input PrimitiveId: not in this build's shader",
    ),
    (
        SHADED,
        SHADED,
        "    if (AT_VERTICES) {",
        "    atomicAdd(statistics.patches_drawn, 1u);\n    if (AT_VERTICES) {",
        "set 0, binding 1, to be written: not in this build's shader",
    ),
    (
        SHADOW_FRAGMENT,
        SHADOW_FRAGMENT,
        "out uvec2 texel;",
        "out uvec2 texel;\nlayout(early_fragment_tests) in;",
        "mode EarlyFragmentTests: expected none, found ()",
    ),
    (
        TONEMAP,
        TONEMAP,
        "void main() {",
        "shared float more[64];\nvoid main() {\n    more[gl_LocalInvocationIndex] = 1.0;",
        "shared memory: expected none, found float[64]",
    ),
];

#[test]
fn a_shader_with_another_interface_is_refused_and_the_difference_named() {
    for (shader, file, from, to, said) in OTHERS {
        let edited = Edited::of(&[shader]);
        edited.replace(file, from, to);
        let found = edited.refused();
        assert!(found.starts_with(shader) && found.contains(said), "{to}: expected {said:?} in {found:?}");
    }
    let of = |path| crate::shaders::get(path).unwrap();
    let found = differences(of(SHADOW_VERTEX), of(SHADOW_FRAGMENT)).unwrap();
    assert!(found.iter().any(|line| line.starts_with("stage: expected Vertex")), "{found:?}");
    assert!(differences(of(TONEMAP), &[1, 2, 3]).is_err());
}

#[test]
fn values_that_are_used_before_they_are_there_are_refused() {
    let uses = [
        "for (int i = 0; i < 4; ++i) { if (READS_PLACE) { continue; } radiance.x += 1.0; }",
        "radiance.x = AT_VERTICES ? 2.0 : (READS_PLACE ? 3.0 : 1.0);",
        "if (!AT_VERTICES || READS_PLACE) { radiance.x = 1.0; }",
    ];
    for uses in uses {
        let edited = Edited::of(&[SHADED]);
        edited.replace(SHADED, "void main() {", &format!("void main() {{\n    {uses}"));
        let said = edited.refused();
        assert!(said.starts_with("passes/fibers.frag: `READS_PLACE` is used where it is not"), "{said}");
    }
    for (path, words) in all() {
        assert_eq!(used_too_early(words), Ok(None), "{path}");
    }
}

#[test]
fn what_changes_no_interface_is_drawn_with() {
    let edits = [
        (SHADED, "    if (AT_VERTICES) {", "    if (gl_FragCoord.x < 0.0) {"),
        (
            SHADED,
            "    radiance = strand_color(strand);",
            "    radiance = vec4(1.0, dFdx(fragment_across), 0.0, 1.0);",
        ),
        (TONEMAP, "const uint TONE = 0;", "const uint TONE = 1;"),
        (
            TONEMAP,
            "vec4 radiance = imageLoad",
            "for (int i = 0; i < 3; ++i) { if (TRANSPARENT) { break; } }\n    vec4 radiance = imageLoad",
        ),
        (SHADOW_VERTEX, "    depth_mm = dot", "    depth_mm = 1.0 + dot"),
    ];
    for (shader, from, to) in edits {
        let edited = Edited::of(&[shader]);
        edited.replace(shader, from, to);
        assert_eq!(edited.found().map(|set| set.replaced().count()), Ok(1), "{to}");
    }
}
