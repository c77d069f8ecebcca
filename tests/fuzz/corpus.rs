//! Small valid files of every kind, to be spoiled.

use glam::DVec3;
use std::path::Path;
use worsted::io::bcc::write_bcc;
use worsted::io::curves::{Basis, Curve, CurveSet, UpAxis};
use worsted::io::gltf_write::write_gltf;
use worsted::io::measured::MeasuredImage;
use worsted::io::picture::{DisplayImage, LinearImage, write_exr, write_png};
use worsted::knit::motion::{self, Dance};
use worsted::probe::FUNCTIONS;
use worsted::reference::checkpoint;
use worsted::reference::rendering::Rendering;
use worsted::stress::queries;

use crate::target::readers::{PART_KEY, PART_SIZE};

/// What goes into `path`'s file, by one of the library's own writers.
fn written(write: impl FnOnce(&Path)) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    write(&path);
    std::fs::read(path).unwrap()
}

fn curves(basis: Basis) -> CurveSet {
    let at = |i: usize| DVec3::new(i as f64, (i * i) as f64 * 0.25, -1.0);
    let curve = |n, closed| Curve { points: (0..n).map(at).collect(), closed };
    CurveSet { basis, up_axis: Some(UpAxis::Z), curves: vec![curve(4, false), curve(6, true)] }
}

fn linear(width: u32, height: u32) -> LinearImage {
    let mut image = LinearImage::filled(width, height, [0.25, 0.5, 1.0, 1.0]);
    for (i, pixel) in image.pixels.iter_mut().enumerate() {
        pixel[i % 3] += 0.01 * i as f32;
    }
    image
}

fn shown(width: u32, height: u32) -> DisplayImage {
    let mut image = DisplayImage::filled(width, height, [10, 90, 200, 255]);
    for (i, pixel) in image.pixels.iter_mut().enumerate() {
        pixel[i % 3] = i as u8;
    }
    image
}

fn measured() -> MeasuredImage {
    let mean = linear(9, 7);
    let variance = Some(vec![[0.1, 0.2, 0.3]; mean.pixels.len()]);
    MeasuredImage { mean, variance }
}

const OBJ: &str = "# two strands\nv 0 0 0\nv 1 0.5 0\nv 2 0 -1e0\nv 3 1 1\nl 1 2\nl 2 3\nl -1 -4\nf 1 2 3\nl 1/2 3/4 \\\n 2\n";
const SCENE: &str = "seed = 3\n[fabric]\nmodel = \"yarn.bcc\"\nmm_per_unit = 1\n[yarn]\npreset = \"cotton1\"\nply_count = 3\n\
    ply_pitch_mm = \"untwisted\"\nloop_radius_mm = [1, 0.5]\n[fiber]\npreset = \"fleece\"\ncolor = [0.2, 0.4, 0.6]\n[[light]]\n\
    kind = \"spot\"\nposition_mm = [0, 300, 400]\ndirection = [0, -0.6, -0.8]\nintensity = [0.5, 0.45, 0.4]\nouter_angle_deg = 45\n\
    [ambient]\nradiance = [0.2, 0.22, 0.26]\n[camera]\nyaw_deg = 10\npitch_deg = 20\ndistance_mm = 200\ntarget_mm = [0, 0, 0]\n\
    [shading]\nmodel = \"physical\"\nextinction_scale = 1\n[shadow]\nmap = true\n[occlusion]\nmode = \"texture\"\n[quality]\n\
    self_shadow_texels = 64\nscattering_entries = 32\n[display]\ntone = \"filmic\"\nbackground = [0, 0, 0]\n[debug]\nview = \"ply\"\n";

/// An indexed triangle whose edges are taken, in a scene of two nodes.
const TRIANGLE: &str = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],"rotation":[0,0,1,0]},
    {"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "buffers":[{"byteLength":42,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}],
    "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]}"#;

/// A glTF that moves.
fn gltf(dance: Dance) -> Vec<u8> {
    let mut set = curves(Basis::CatmullRom);
    set.up_axis = None;
    written(|path| write_gltf(path, &set, Some(&motion::written(&set, dance))).unwrap())
}

/// The triangle as a binary file.
fn glb() -> Vec<u8> {
    let chunk = TRIANGLE.len().next_multiple_of(4);
    let length = |bytes: usize| (bytes as u32).to_le_bytes();
    let head =
        [b"glTF".as_slice(), &2u32.to_le_bytes(), &length(20 + chunk), &length(chunk), b"JSON"].concat();
    let mut file = [&head, TRIANGLE.as_bytes()].concat();
    file.resize(20 + chunk, b' ');
    file
}

/// Files of a reader.
pub fn of(reader: &str) -> Vec<Vec<u8>> {
    let hdr = |width: usize, height: usize| {
        let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
        [head.into_bytes(), [128, 64, 3, 130].repeat(width * height)].concat()
    };
    match reader {
        "bcc" => [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline]
            .map(|basis| written(|path| write_bcc(path, &curves(basis)).unwrap()))
            .into(),
        "obj" => vec![OBJ.into(), b"v 0 0 0\nv 1e3 -2.5e-1 0\nv 0 0 1\nl 1 2 3 1\n".into()],
        "gltf" => vec![gltf(Dance::Wave), gltf(Dance::Bend), glb(), TRIANGLE.into()],
        "frames" => {
            let point = |i: u32| (0..3).flat_map(move |axis| (0.25 * (i + axis) as f32).to_le_bytes());
            vec![(0..20).flat_map(point).collect(), (0..10).flat_map(point).collect()]
        }
        "exr" => vec![
            written(|path| measured().write(path).unwrap()),
            written(|path| write_exr(path, &linear(9, 7)).unwrap()),
        ],
        "png" => vec![written(|path| write_png(path, &shown(9, 7)).unwrap())],
        "environment_exr" => vec![written(|path| write_exr(path, &linear(8, 4)).unwrap())],
        "environment_hdr" => vec![hdr(8, 4), hdr(2, 1)],
        "environment_png" => vec![written(|path| write_png(path, &shown(8, 4)).unwrap())],
        "checkpoint" => {
            vec![written(|path| checkpoint::save(path, PART_KEY, &Rendering::new(PART_SIZE)).unwrap())]
        }
        "scene" => vec![SCENE.into(), b"[fabric]\nmodel = \"yarn.bcc\"\n".into()],
        _ => FUNCTIONS
            .iter()
            .enumerate()
            .map(|(which, function)| {
                let lines: String =
                    queries::random(function.name, 2).iter().map(|query| format!("{query}\n")).collect();
                [&[which as u8], lines.as_bytes()].concat()
            })
            .collect(),
    }
}
