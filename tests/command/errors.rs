//! What the command refuses: one line that names the file or the option, an exit code, nothing written.

use super::process::{Workplace, assert_good, assert_one_line_error, swatch};

/// A BCC header that claims `curves` and `points`, then `body`.
fn bcc(curves: u64, points: u64, body: &[u8]) -> Vec<u8> {
    let mut file = b"BCC\x44C0\x03\x01".to_vec();
    file.extend(curves.to_le_bytes());
    file.extend(points.to_le_bytes());
    file.resize(64, 0);
    file.extend(body);
    file
}

/// One open curve's bytes.
fn curve(points: &[[f32; 3]]) -> Vec<u8> {
    let mut body = (points.len() as i32).to_le_bytes().to_vec();
    body.extend(points.iter().flatten().flat_map(|c| c.to_le_bytes()));
    body
}

fn good_bcc() -> Vec<u8> {
    bcc(1, 3, &curve(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 1.0, 0.0]]))
}

/// Name, bytes, and the place that the error must name.
fn hostile_files() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let good = good_bcc();
    let one = curve(&[[0.0; 3]]);
    vec![
        ("empty.bcc", Vec::new(), "byte 0"),
        ("empty.obj", Vec::new(), "expected at least one `l`"),
        ("header.bcc", good[..20].to_vec(), "byte 0"),
        ("cut.bcc", good[..good.len() - 5].to_vec(), "byte "),
        ("zero.bcc", bcc(0, 0, &[]), "byte 8"),
        ("lies.bcc", bcc(1, 7, &good[64..]), "byte 8: expected 88 bytes"),
        ("many.bcc", bcc(2, 3, &good[64..]), "byte "),
        ("huge.bcc", bcc(1, 1 << 63, &good[64..]), "byte 8"),
        ("curves.bcc", bcc(1 << 63, 3, &good[64..]), "byte 8"),
        ("most.bcc", bcc(1, 3, &[i32::MAX.to_le_bytes().as_slice(), &good[68..]].concat()), "byte 64"),
        ("least.bcc", bcc(1, 3, &[i32::MIN.to_le_bytes().as_slice(), &good[68..]].concat()), "byte 64"),
        ("nan.bcc", bcc(1, 2, &curve(&[[0.0; 3], [f32::NAN, 0.0, 0.0]])), "byte 80"),
        ("infinite.bcc", bcc(1, 2, &curve(&[[0.0; 3], [0.0, f32::INFINITY, 0.0]])), "byte "),
        ("point.bcc", bcc(1, 1, &one), "curve"),
        ("points.bcc", bcc(2, 2, &[one.clone(), one].concat()), "curve"),
        ("wide.bcc", [b"BCC\x88", &good[4..]].concat(), "byte 3"),
        ("numbers.obj", b"v 0 0 0\nv 1 x 0\nl 1 2\n".to_vec(), "line 2"),
        ("index.obj", b"v 0 0 0\nv 1 0 0\nl 1 9\n".to_vec(), "line 3"),
        ("index0.obj", b"v 0 0 0\nv 1 0 0\nl 0 1\n".to_vec(), "line 3"),
        ("nan.obj", b"v 0 0 0\nv nan 0 0\nl 1 2\n".to_vec(), "line 2"),
        ("picture.png", b"\x89PNG\r\n\x1a\n".to_vec(), "expected a BCC file"),
        ("syntax.toml", b"seed = 1\n[fabric\n".to_vec(), "line 2"),
        (
            "key.toml",
            b"[fabric]\nmodel = 'good.bcc'\n\n[camera]\nyaw = 3\n".to_vec(),
            "line 5: unknown field `yaw`",
        ),
        ("type.toml", b"[fabric]\nmodel = 3\n".to_vec(), "line 2"),
        ("preset.toml", b"[fabric]\nmodel = 'good.bcc'\n[yarn]\npreset = 'silk'\n".to_vec(), "yarn.preset"),
        ("yarn.toml", b"[fabric]\nmodel = 'good.bcc'\n[yarn]\nply_cuont = 3\n".to_vec(), "ply_cuont"),
        (
            "range.toml",
            b"[fabric]\nmodel = 'good.bcc'\n[camera]\nfov_y_deg = 0\n".to_vec(),
            "camera.fov_y_deg = 0",
        ),
        (
            "thin.toml",
            b"[fabric]\nmodel = 'good.bcc'\n[yarn]\nellipse_short_mm = 1e-4\n".to_vec(),
            "line 4: yarn.ellipse_short_mm = 0.0001: allowed is at least 1/1000 of the yarn's outer radius",
        ),
        ("nothing.toml", Vec::new(), "expected a [fabric]"),
        ("bytes.toml", b"\xff\xfe".to_vec(), "UTF-8"),
    ]
}

#[test]
fn hostile_files_are_refused_in_one_line_that_names_file_and_place() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    for (name, bytes, at) in hostile_files() {
        place.write(name, bytes);
        place.refuses(&["render", name, "-o", "x.png", "--size", "16x16"], 2, &[name, at]);
        if !name.ends_with(".toml") {
            place.refuses(&["info", name], 2, &[name, at]);
        }
    }
}

#[test]
fn the_good_file_beside_the_hostile_ones_is_drawn() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    let output = place.run(&["render", "good.bcc", "-q", "-o", "x.png", "--size", "16x16"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(place.path("x.png").is_file());
}

#[test]
fn files_that_are_not_there_and_folders_are_refused() {
    let place = Workplace::new();
    std::fs::create_dir(place.path("folder.bcc")).expect("the temporary folder is ours to use");
    place.write("away.toml", "[fabric]\nmodel = 'away.bcc'\n");
    for name in ["missing.bcc", "missing.obj", "missing.toml", "folder.bcc", "no/such.bcc"] {
        place.refuses(&["render", name, "-o", "x.png"], 2, &[name]);
        place.refuses(&["info", name], 2, &[name]);
    }
    place.refuses(&["render", "away.toml", "-o", "x.png"], 2, &["away.bcc", "cannot read"]);
}

/// Where no texture of ambient light is good enough, unless the scene says how large it is or does without.
#[test]
fn plies_that_no_texture_shows_are_refused() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    let render =
        ["render", "good.bcc", "-o", "x.png", "--size", "16x16", "--set", "yarn.ellipse_short_mm=0.005"];
    let textured = [&render[..], &["--set", "occlusion.mode=texture"]].concat();
    place.refuses(&textured, 2, &["good.bcc: occlusion.mode = texture: expected plies that a texture shows"]);
    for drawn in [render.to_vec(), [&textured[..], &["--set", "quality.occlusion_texels=64"]].concat()] {
        let output = place.run(&drawn);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn bad_options_are_refused_by_name() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    for (option, value, expected) in [
        ("--size", "0x4", "WxH"),
        ("--size", "4", "WxH"),
        ("--size", "16385x4", "16384"),
        ("--camera", "roll=3", "`roll`"),
        ("--camera", "yaw=east", "`east`"),
        ("--camera", "target=1:2", "X:Y:Z"),
        ("--camera", "pitch=100", "camera.pitch_deg = 100"),
        ("--camera", "distance=0", "camera.distance_mm = 0"),
        ("--set", "seed", "--set seed"),
        ("--set", "=3", "--set =3"),
        ("--set", "camera.yaw=3", "`yaw`"),
        ("--set", "seed.x.y=3", "expected u64"),
        ("--set", "seed=-1", "-1"),
        ("--set", "yarn.ply_count=9", "yarn.ply_count = 9"),
        ("--set", "yarn.preset=wool", "worsted_3ply"),
        ("--set", "light.3.kind=point", "expected a sequence"),
        ("--set", "fabric.mm_per_unit=nan", "mm_per_unit"),
        ("-o", "x", "-o x"),
        ("-o", "x.jpg", "-o x.jpg"),
        ("-o", ".png", "-o .png"),
    ] {
        let arguments = ["render", "good.bcc", "-o", "x.png", option, value];
        place.refuses(&arguments, 2, &[expected]);
    }
}

#[test]
fn arguments_that_cannot_be_parsed_name_the_option() {
    let place = Workplace::new();
    for (arguments, expected) in [
        (&["render", "a.bcc", "-o", "x.png", "--samples", "3"][..], "--samples"),
        (&["render", "a.bcc", "-o", "x.png", "--samples", "many"], "--samples"),
        (&["render", "a.bcc", "-o", "x.png", "--seed", "1.5"], "--seed"),
        (&["render", "a.bcc", "-o", "x.png", "--repeat", "0"], "--repeat"),
        (&["render", "a.bcc", "-o", "x.png", "--nosuch"], "--nosuch"),
        (&["render", "a.bcc"], "--output"),
        (&["nosuch"], "nosuch"),
        (&["knit", "cable", "-o", "x.bcc"], "cable"),
        (&["knit", "stockinette", "--courses=-1", "-o", "x.bcc"], "--courses"),
    ] {
        place.refuses(arguments, 2, &[expected]);
        assert!(place.contents().is_empty());
    }
}

#[test]
fn pictures_and_fabric_go_to_no_folder_that_is_not_there() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    for name in ["away/x.png", "away/x.exr"] {
        place.refuses(
            &["render", "good.bcc", "-q", "-o", name, "--size", "16x16"],
            2,
            &[name, "cannot write"],
        );
    }
    place.refuses(
        &["knit", "stockinette", "--wales", "3", "-o", "away/x.bcc"],
        2,
        &["away/x.bcc", "cannot write"],
    );
}

#[test]
fn fabric_that_cannot_be_knit_is_refused() {
    let place = Workplace::new();
    for (option, value, expected) in [
        ("--courses", "0", "courses"),
        ("--wales", "0", "wales"),
        ("--wales", "4294967295", "wales"),
        ("--wale-spacing", "0.5", "wale_spacing_mm"),
        ("--course-spacing", "0.5", "course_spacing_mm"),
        ("--course-spacing", "nan", "course_spacing_mm"),
        ("--wale-spacing", "1000", "wale_spacing_mm"),
        ("--yarn-radius", "0", "yarn_radius_mm"),
        ("--yarn-radius", "inf", "yarn_radius_mm"),
        ("--points-per-loop", "17", "points_per_loop"),
    ] {
        place.refuses(&["knit", "stockinette", option, value, "-o", "x.bcc"], 2, &[expected, "expected"]);
    }
    for (option, value, expected) in [
        ("--courses", "0", "courses: expected at least 1, found 0"),
        ("--wales", "9", "wales: expected at least 10, found 9"),
        ("--wales", "4294967295", "wales: expected a tube of at most"),
        ("--wale-spacing", "0.5", "wale_spacing_mm: expected at least"),
        ("--yarn-radius", "nan", "yarn_radius_mm: expected"),
        ("--points-per-loop", "17", "points_per_loop: expected"),
    ] {
        place.refuses(&["knit", "tube", option, value, "-o", "x.bcc"], 2, &[expected]);
    }
    place.refuses(&["knit", "tube", "--courses=-1", "-o", "x.bcc"], 2, &["--courses"]);
    place.refuses(&["knit", "tube", "-o", "x.png"], 2, &["x.png", ".bcc"]);
    assert!(place.contents().is_empty());
}

#[test]
fn devices_that_are_not_there_end_with_3_and_what_to_do() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    for device in ["99", "nosuch"] {
        let arguments = ["render", "good.bcc", "-q", "-o", "x.png", "--device", device];
        place.refuses(&arguments, 3, &[device, "available are 0:", "--device"]);
    }
    let nothing = [("VK_DRIVER_FILES", "/nonexistent.json"), ("VK_ICD_FILENAMES", "/nonexistent.json")];
    let arguments = ["render", "good.bcc", "-q", "-o", "x.png"];
    place.refuses_with(&arguments, &nothing, 3, &["apt-get install", "mesa-vulkan-drivers"]);
}

#[test]
fn doctor_without_a_driver_says_what_to_install() {
    let nothing = [("VK_DRIVER_FILES", "/nonexistent.json"), ("VK_ICD_FILENAMES", "/nonexistent.json")];
    let output = Workplace::new().run_with(&["doctor", "-q"], &nothing);
    assert_eq!(output.status.code(), Some(3));
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("problem: no Vulkan driver") && said.contains("fix: apt-get install"), "{said}");
    // The report is not part of the error.
    let error = std::process::Output { stdout: Vec::new(), ..output.clone() };
    assert_one_line_error(&error, 3, &["no Vulkan driver", "apt-get install"]);
}

#[test]
fn a_picture_too_large_for_memory_ends_with_4_and_leaves_nothing() {
    let place = Workplace::new();
    let swatch = swatch();
    let huge = ["render", &swatch, "-q", "-o", "x.png", "--size", "8191x4095", "--samples", "64"];
    // The CPU device's heap ends before this picture's images do, so that they are refused unmade.
    place.refuses(&[&huge[..], &["--device", "software"]].concat(), 4, &["out of memory", "lower the size"]);
}

#[test]
fn arguments_that_cannot_be_parsed_are_one_line() {
    let place = Workplace::new();
    place.refuses(&["render", "a.bcc", "-o", "x.png", "--samples", "3"], 2, &["--samples", "4 n^2"]);
    place.refuses(&["render", "a.bcc"], 2, &["--output"]);
    place.refuses(&["render", "", "-o", "x.png"], 2, &["SCENE"]);
    place.refuses(&["nosuch"], 2, &["nosuch"]);
}

#[test]
fn a_value_of_the_wrong_type_is_refused_by_its_key() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    for assignment in ["camera.yaw_deg=east", "seed.x.y=3", "light.3.kind=point", "quality.culling=3"] {
        let key = assignment.split(['.', '=']).next().unwrap_or_default();
        place.refuses(&["render", "good.bcc", "-o", "x.png", "--set", assignment], 2, &[key]);
    }
}

#[test]
fn every_seed_that_parses_is_drawn() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    let seed = i64::MAX.to_string();
    assert_good(&place.run(&["render", "good.bcc", "-q", "-o", "x.png", "--size", "8x8", "--seed", &seed]));
}

#[test]
fn statistics_go_to_no_folder_that_is_not_there() {
    let place = Workplace::new();
    place.write("good.bcc", good_bcc());
    let arguments = ["render", "good.bcc", "-q", "-o", "x.png", "--size", "8x8", "--stats", "away/s.json"];
    place.refuses(&arguments, 2, &["away/s.json"]);
}

#[test]
fn a_file_that_cannot_be_written_is_named_once_and_as_it_was_typed() {
    let place = Workplace::new();
    let output = place.run(&["knit", "stockinette", "-o", "away/x.bcc"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_one_line_error(&output, 2, &["away/x.bcc: cannot write"]);
    assert!(!said.contains(".part") && !said.contains("/tmp"), "{said}");
}

#[test]
fn fabric_goes_to_a_name_that_the_readers_know() {
    let place = Workplace::new();
    place.refuses(&["knit", "stockinette", "--wales", "3", "-o", "x.png"], 2, &["x.png", ".bcc"]);
}

#[test]
fn log_lines_in_a_file_are_plain() {
    let nothing = [("VK_DRIVER_FILES", "/nonexistent.json"), ("VK_ICD_FILENAMES", "/nonexistent.json")];
    let output = Workplace::new().run_with(&["doctor"], &nothing);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("WARN") && !said.contains('\x1b'), "{said:?}");
}
