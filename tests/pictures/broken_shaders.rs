//! Shaders with one deliberate fault each, which the comparison must flag, and honest pictures, which it must not.
//!
//! Whatever picture is the judge is a parameter: see [`Judge`].

#[path = "../../src/shaders/glsl.rs"]
mod glsl;

use crate::device::shared;
use crate::draw::{scene, swatch};
use std::collections::BTreeMap;
use std::path::Path;
use worsted::frame::sampling::Sampling;
use worsted::frame::{Renderer, Request};
use worsted::io::picture::LinearImage;
use worsted::math::tone::Display;
use worsted::metrics::error::{RegionError, compare};
use worsted::shaders::ShaderSet;
use worsted::vulkan::DeviceChoice;

const SIZE: [u32; 2] = [112, 84];
const SAMPLES: u32 = 36;
const JUDGE_SAMPLES: u32 = 64;
/// Two stitches of a yarn that shadows itself and others, lit from the left and from behind.
const SETS: [&str; 9] = [
    "camera.yaw_deg=18",
    "camera.pitch_deg=12",
    "camera.distance_mm=22",
    "camera.target_mm=[0, 0, 0]",
    "shadow.map=true",
    "shadow.self=true",
    "yarn.hair_density_per_mm=0",
    "yarn.fibers_per_ply=30",
    "light=[{direction = [0.8, -0.5, -0.3]}, {direction = [-0.5, -0.4, 0.75], irradiance = [3, 3, 3]}]",
];

/// A text under `glsl/`, what stands there exactly once, and what is put in its place.
type Change = (&'static str, &'static str, &'static str);

/// Name and changes of each fault.
const FAULTS: &[(&str, &[Change])] = &[
    (
        "TT's azimuthal lobe without its normaliser I0",
        &[("bsdf/khungurn.glsl", "return n_tt * exp(", "return (1.0 / TWO_PI) * exp(")],
    ),
    (
        "longitudinal Gaussians without their normaliser",
        &[("bsdf/khungurn.glsl", "/ (deviation * gaussian_normaliser(cos_i, width) * ratio)", "")],
    ),
    (
        "no self-shadow",
        &[(
            "shading/self_shadow.glsl",
            "return seen * exp(-extinction * depth * self_shadow_stretch(sin_angle));",
            "return 1.0;",
        )],
    ),
    (
        "no shadow between yarns",
        &[("passes/surface.glsl", "share *= shadow_map_light(", "share *= 1.0 + 0.0 * shadow_map_light(")],
    ),
    (
        "the axes of the ply's ellipse swapped",
        &[
            (
                "yarn/fiber.glsl",
                "float x = shape.radius * cos_fiber * yarn.ellipse_short",
                "float x = shape.radius * cos_fiber * yarn.ellipse_long",
            ),
            (
                "yarn/fiber.glsl",
                "float y = shape.radius * sin_fiber * yarn.ellipse_long",
                "float y = shape.radius * sin_fiber * yarn.ellipse_short",
            ),
        ],
    ),
    (
        "the normal's axes swapped",
        &[(
            "passes/surface.glsl",
            "strand.normals, strand.side, strand.toward, to_light)",
            "strand.normals, strand.toward, strand.side, to_light)",
        )],
    ),
    (
        "the light's axes in the cross-section swapped",
        &[(
            "passes/surface.glsl",
            "vec2(dot(strand.ply_normal, direction), dot(strand.ply_binormal, direction))",
            "vec2(dot(strand.ply_binormal, direction), dot(strand.ply_normal, direction))",
        )],
    ),
    (
        "fibers twisted the other way",
        &[(
            "yarn/fiber.glsl",
            "TWO_PI * fract(segment.fiber_turns + t * segment.fiber_turns_delta)",
            "-TWO_PI * fract(segment.fiber_turns + t * segment.fiber_turns_delta)",
        )],
    ),
];

/// The shaders between yarn and radiance.
const STRANDS: [&str; 9] = [
    "passes/fibers.vert",
    "passes/fibers.tesc",
    "passes/fibers.tese",
    "passes/fibers.geom",
    "passes/fibers.frag",
    "passes/core.tesc",
    "passes/core.tese",
    "passes/core.geom",
    "passes/core.frag",
];

/// The text at `path` under `glsl/`, changed; an error where a change does not match exactly once.
fn text(path: &str, changes: &[Change]) -> Result<String, String> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("glsl").join(path);
    let mut text = std::fs::read_to_string(file).map_err(|e| format!("{path}: {e}"))?;
    for (_, from, to) in changes.iter().filter(|(changed, ..)| *changed == path) {
        let found = text.matches(from).count();
        if found != 1 {
            return Err(format!("{path}: expected `{from}` once, found it {found} times"));
        }
        text = text.replace(from, to);
    }
    Ok(text)
}

/// The shaders that `changes` alter; an error where none is altered.
fn broken(changes: &[Change]) -> Result<ShaderSet, String> {
    for (path, ..) in changes {
        text(path, changes)?;
    }
    let mut replaced = BTreeMap::new();
    for path in STRANDS {
        let stage = glsl::stage_of(path).expect("a stage's extension");
        let words = glsl::compile(path, stage, &|path| text(path, changes))?;
        if worsted::shaders::get(path) != Some(&words) {
            replaced.insert(path.to_owned(), words);
        }
    }
    if replaced.is_empty() {
        Err("no shader is altered".to_owned())
    } else {
        Ok(ShaderSet::replacing(replaced))
    }
}

fn draw(shaders: ShaderSet, samples: u32, more: &[&str]) -> LinearImage {
    let device = shared(DeviceChoice::Software);
    let sampling = Sampling::new(samples).unwrap();
    let request = Request { size: SIZE, sampling, statistics: false, profile: false };
    let scene = scene(&swatch(), &[&SETS, more].concat());
    let mut renderer = Renderer::with_shaders(device, scene, request, shaders).unwrap();
    let picture = renderer.render(&|_| ()).unwrap();
    device.check_validation().unwrap();
    LinearImage { width: SIZE[0], height: SIZE[1], pixels: picture.linear }
}

/// The picture that others are held to, and how far from it they may be, as means over the covered pixels.
struct Judge {
    picture: LinearImage,
    max_flip: f64,
    max_mse: f64,
}

impl Judge {
    /// The intact shaders at another number of samples than the pictures to be judged, so that none is compared
    /// with itself. Measured: honest pictures reach FLIP 0.048 and MSE 2.3e-4, which is sampling alone; the mildest
    /// faults 0.085 (the ellipse's axes) and 1.05e-3 (the same).
    fn intact() -> Self {
        let picture = draw(ShaderSet::default(), JUDGE_SAMPLES, &[]);
        Self { picture, max_flip: 0.065, max_mse: 5e-4 }
    }

    /// The error of a picture, and whether FLIP and the squared error each pass it.
    fn judges(&self, picture: &LinearImage) -> (RegionError, [bool; 2]) {
        let error = compare(picture, &self.picture, &Display::default()).unwrap().error.covered;
        (error, [error.flip_mean <= self.max_flip, error.mse <= self.max_mse])
    }
}

#[test]
fn every_fault_is_flagged_and_honest_pictures_are_not() {
    let judge = Judge::intact();
    let honest: [(&str, u32, &[&str]); 4] = [
        ("other samples", SAMPLES, &[]),
        ("no level of detail", SAMPLES, &["quality.level_of_detail=false"]),
        ("finer level of detail", SAMPLES, &["quality.lod_threshold_samples=0.75"]),
        ("finer tables", SAMPLES, &["quality.self_shadow_texels=192", "quality.scattering_entries=256"]),
    ];
    let mut wrong = Vec::new();
    let mut check = |name: &str, picture: &LinearImage, may_pass: bool| {
        let (error, passes) = judge.judges(picture);
        let line = format!("{name}: FLIP {:.4}, MSE {:.2e}", error.flip_mean, error.mse);
        println!("{line}");
        if passes != [may_pass; 2] {
            wrong.push(line);
        }
    };
    for (name, samples, sets) in honest {
        check(name, &draw(ShaderSet::default(), samples, sets), true);
    }
    for (name, changes) in FAULTS {
        let shaders = broken(changes).unwrap_or_else(|error| panic!("{name}: {error}"));
        check(name, &draw(shaders, SAMPLES, &[]), false);
    }
    assert!(wrong.is_empty(), "judged wrongly: {wrong:#?}");
}

#[test]
fn a_change_that_does_not_match_once_is_an_error() {
    let change = |from| broken(&[("bsdf/khungurn.glsl", from, "")]).unwrap_err();
    assert!(change("no such text").contains("found it 0 times"));
    assert!(change("table").contains("expected `table` once"));
    let unseen: Change = ("passes/resolve.comp", "#version 460", "#version 460\n// no fault");
    assert_eq!(broken(&[unseen]).unwrap_err(), "no shader is altered");
}
