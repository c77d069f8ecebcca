//! Tests of reading and writing pictures.

use std::path::PathBuf;

use super::*;
use crate::math::rng::Rng;
use crate::math::tone::Tone;

fn noise(width: u32, height: u32, seed: u64) -> LinearImage {
    let mut rng = Rng::new(seed, &[]);
    let pixels = (0..width * height).map(|_| std::array::from_fn(|_| rng.uniform() as f32)).collect();
    LinearImage { width, height, pixels }
}

fn byte_noise(width: u32, height: u32, seed: u64) -> DisplayImage {
    DisplayImage::from_linear(&noise(width, height, seed), &Display::PLAIN).unwrap()
}

fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("picture");
    (folder, file)
}

/// The names in a folder, to show that no temporary file is left.
fn names(folder: &tempfile::TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path()).unwrap();
    entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn exr_keeps_every_bit_also_of_what_is_not_finite() {
    let (folder, file) = folder();
    let mut image = noise(67, 70, 1);
    image.pixels[3] = [f32::NAN, f32::INFINITY, -0.0, 1e-42];
    write_exr(&file, &image).unwrap();
    let back = read_exr(&file).unwrap();
    let bits = |i: &LinearImage| i.pixels.as_flattened().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!((back.width, back.height), (67, 70));
    assert_eq!(bits(&back), bits(&image));
    assert_eq!(names(&folder), ["picture"]);
}

#[test]
fn png_keeps_every_byte_and_row_0_is_on_top() {
    let (folder, file) = folder();
    let mut image = byte_noise(31, 17, 2);
    image.pixels[..31].fill([1, 2, 3, 0]);
    write_png(&file, &image).unwrap();
    assert_eq!(read_png(&file).unwrap(), image);
    // The first row of the file itself, as another reader sees it.
    let other =
        ImageReader::open(&file).unwrap().with_guessed_format().unwrap().decode().unwrap().into_rgba8();
    assert_eq!(other.get_pixel(30, 0).0, [1, 2, 3, 0]);
    assert_ne!(other.get_pixel(30, 16).0, [1, 2, 3, 0]);
    assert_eq!(names(&folder), ["picture"]);
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    let (_folder, file) = folder();
    let mut written = Vec::new();
    for _ in 0..2 {
        write_exr(&file, &noise(130, 70, 3)).unwrap();
        written.push(std::fs::read(&file).unwrap());
        write_png(&file, &byte_noise(130, 70, 3)).unwrap();
        written.push(std::fs::read(&file).unwrap());
    }
    assert_eq!(written[..2], written[2..]);
}

#[test]
fn refuses_to_write_a_wrong_shape_and_leaves_the_old_file() {
    let (folder, file) = folder();
    write_png(&file, &byte_noise(4, 4, 4)).unwrap();
    let before = std::fs::read(&file).unwrap();
    let short = LinearImage { width: 4, height: 4, pixels: vec![[0.0; 4]; 15] };
    let empty = DisplayImage { width: 0, height: 4, pixels: Vec::new() };
    let overflowing = DisplayImage { width: u32::MAX, height: u32::MAX, pixels: vec![[0; 4]] };
    assert!(write_exr(&file, &short).unwrap_err().to_string().contains("found 4 x 4 with 15"));
    assert!(write_png(&file, &empty).is_err());
    assert!(write_png(&file, &overflowing).is_err());
    assert!(write_png(&folder.path().join("missing/a.png"), &byte_noise(4, 4, 4)).is_err());
    assert_eq!(std::fs::read(&file).unwrap(), before);
    assert_eq!(names(&folder), ["picture"]);
}

fn exposed(exposure: f64) -> Display {
    Display { exposure, ..Display::PLAIN }
}

#[test]
fn what_cannot_be_shown_is_refused_and_named() {
    let mut image = noise(5, 4, 5);
    assert!(DisplayImage::from_linear(&image, &exposed(f64::NAN)).is_err());
    assert!(DisplayImage::from_linear(&image, &exposed(0.0)).is_err());
    image.pixels[13][2] = f32::NEG_INFINITY;
    let message = DisplayImage::from_linear(&image, &Display::PLAIN).unwrap_err().to_string();
    assert!(message.starts_with("pixel (3, 2):") && message.contains("-inf"), "{message}");
}

#[test]
fn the_display_transform_clamps_rounds_and_keeps_faint_coverage() {
    let image = LinearImage {
        width: 3,
        height: 1,
        pixels: vec![[-1.0, 0.214_041_14, 7.0, 1e-6], [0.0, 0.09, 0.5, 0.0], [1.0, 0.0, 0.0, 2.0]],
    };
    let shown = DisplayImage::from_linear(&image, &Display::PLAIN).unwrap();
    assert_eq!(shown.pixels, [[0, 128, 255, 1], [0, 85, 188, 0], [255, 0, 0, 255]]);
    let brighter = DisplayImage::from_linear(&image, &exposed(2.0)).unwrap();
    assert_eq!(brighter.pixels[1], [0, 118, 255, 0]);
}

#[test]
fn the_tone_curve_is_the_one_asked_for() {
    let image = LinearImage::filled(1, 1, [2.0, 0.18, 0.5, 0.5]);
    let shown = |tone| image.shown(&Display { exposure: 1.0, tone }).unwrap().pixels[0];
    assert_eq!(shown(Tone::Clamp), [1.0, 0.18, 0.5, 0.5]);
    // The largest component bends and takes the others with it.
    let neutral = shown(Tone::Neutral);
    assert!(neutral[0] < 0.98 && (neutral[1] / neutral[0] - 0.09).abs() < 1e-6, "{neutral:?}");
    assert!((shown(Tone::Filmic)[1] - 0.267).abs() < 1e-3);
}

#[test]
fn the_light_of_bytes_is_what_they_show_over_black() {
    let bytes: Vec<[u8; 4]> = (0..=255).map(|v| [v, 255 - v, 7, 255]).collect();
    let image = DisplayImage { width: 256, height: 1, pixels: bytes };
    assert_eq!(DisplayImage::from_linear(&image.light(), &Display::PLAIN).unwrap(), image);
    let half = DisplayImage::filled(1, 1, [188, 0, 255, 128]).light().pixels[0];
    assert!((half[0] - 0.2515).abs() < 1e-3 && half[1] == 0.0 && half[2] == half[3], "{half:?}");
}

/// Reads bytes as a picture of either kind; what matters is that it comes back, with a one-line error or a
/// picture of a sound shape.
fn read_hostile(file: &PathBuf, bytes: &[u8], exr: bool) -> bool {
    std::fs::write(file, bytes).unwrap();
    let result = if exr {
        read_exr(file).map(|i| i.check_shape().unwrap())
    } else {
        read_png(file).map(|i| i.check_shape().unwrap())
    };
    if let Err(error) = &result {
        let line = error.to_string();
        assert!(line.starts_with(&file.display().to_string()) && !line.contains('\n'), "{line}");
    }
    result.is_ok()
}

#[test]
fn truncated_and_corrupted_files_are_errors_not_panics() {
    let (_folder, file) = folder();
    for exr in [true, false] {
        if exr {
            write_exr(&file, &noise(70, 9, 6)).unwrap();
        } else {
            write_png(&file, &byte_noise(70, 9, 6)).unwrap();
        }
        let good = std::fs::read(&file).unwrap();
        for length in (0..good.len()).step_by(if good.len() > 2_000 { 97 } else { 11 }) {
            assert!(!read_hostile(&file, &good[..length], exr), "{length} bytes read as a picture");
        }
        let mut rng = Rng::new(7, &[]);
        // Headers matter most: half of the damage goes to the first 400 bytes.
        for round in 0..4_000 {
            let mut bad = good.clone();
            for _ in 0..1 + round % 3 {
                let reach = if rng.uniform() < 0.5 { good.len().min(400) } else { good.len() };
                let at = (rng.uniform() * reach as f64) as usize;
                bad[at] = rng.next_u64() as u8;
            }
            read_hostile(&file, &bad, exr);
        }
    }
}

/// A copy of `bytes` in which the 16 bytes of the named box attribute are `corners`.
fn with_window(bytes: &[u8], name: &str, corners: [i32; 4]) -> Vec<u8> {
    let key = format!("{name}\0box2i\0\u{10}\0\0\0");
    let at = bytes.windows(key.len()).position(|w| w == key.as_bytes()).unwrap() + key.len();
    let mut bytes = bytes.to_vec();
    bytes[at..at + 16].copy_from_slice(corners.map(i32::to_le_bytes).as_flattened());
    bytes
}

#[test]
fn an_exr_that_claims_huge_windows_is_refused_before_allocation() {
    let (_folder, file) = folder();
    write_exr(&file, &noise(8, 8, 8)).unwrap();
    let good = std::fs::read(&file).unwrap();
    assert!(read_hostile(&file, &with_window(&good, "dataWindow", [0, 0, 7, 7]), true));
    let huge = [[0, 0, 1 << 29, 7], [0, 0, 16_383, 16_383], [1 << 29, 0, (1 << 29) + 7, 7]];
    for corners in huge {
        for name in ["dataWindow", "displayWindow"] {
            assert!(!read_hostile(&file, &with_window(&good, name, corners), true), "{name} {corners:?}");
        }
    }
}

#[test]
fn a_png_that_claims_to_be_huge_is_refused() {
    let (_folder, file) = folder();
    let header = |width: u32, height: u32| {
        let mut chunk = b"IHDR".to_vec();
        chunk.extend(width.to_be_bytes().into_iter().chain(height.to_be_bytes()).chain([8, 6, 0, 0, 0]));
        let mut crc = u32::MAX;
        for byte in &chunk {
            crc ^= u32::from(*byte);
            for _ in 0..8 {
                crc = (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg());
            }
        }
        let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\r".to_vec();
        bytes.extend(chunk.into_iter().chain((!crc).to_be_bytes()));
        bytes.extend(b"\0\0\0\0IDAT\x35\xaf\x06\x1e\0\0\0\0IEND\xae\x42\x60\x82");
        bytes
    };
    for (width, height) in [(u32::MAX >> 1, u32::MAX >> 1), (16_384, 16_384), (1 << 20, 1), (0, 1)] {
        assert!(!read_hostile(&file, &header(width, height), false), "{width} x {height}");
    }
}

#[test]
fn a_missing_file_and_another_format_are_errors() {
    assert!(read_exr(Path::new("no/such/file.exr")).unwrap_err().to_string().contains("cannot read"));
    let (_folder, file) = folder();
    assert!(!read_hostile(&file, b"P6 not what it says", false));
    assert!(!read_hostile(&file, b"", true));
}
