//! Pictures of the light from everywhere.

use std::path::Path;

use crate::io::error::{FileError, Place};
use crate::io::picture::{LinearImage, read_exr, read_hdr, read_png};
use crate::math::color::linear_from_srgb;

/// The largest radiance of an environment.
const MAX_RADIANCE: f32 = 1e9;

/// Reads a latitude-longitude picture of linear Rec. 709 radiance: EXR or HDR as they stand, PNG from sRGB. Row 0
/// is up, the middle of a row toward -Z, columns grow toward +X. Alpha says nothing.
///
/// # Errors
/// A file that cannot be read or is none of these; one that is not twice as wide as high, or that holds a
/// radiance below 0, above 1e9 or not finite.
pub fn read_environment(path: &Path) -> Result<LinearImage, FileError> {
    let wrong = |message: String| FileError::new(path, Place::File, message);
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let image = match extension.as_deref() {
        Some("exr") => read_exr(path)?,
        Some("hdr") => read_hdr(path)?,
        Some("png") => {
            let shown = read_png(path)?;
            let linear = |byte: u8| linear_from_srgb(f64::from(byte) / 255.0) as f32;
            let pixels = shown.pixels.iter().map(|&[r, g, b, _]| [linear(r), linear(g), linear(b), 1.0]);
            LinearImage { width: shown.width, height: shown.height, pixels: pixels.collect() }
        }
        _ => return Err(wrong("expected an environment whose name ends in .exr, .hdr or .png".into())),
    };
    let (width, height) = (image.width, image.height);
    if width != 2 * height {
        let message = format!("expected an environment twice as wide as high, found {width} x {height}");
        return Err(wrong(message));
    }
    let bad = |pixel: &[f32; 4]| !pixel[..3].iter().all(|c| (0.0..=MAX_RADIANCE).contains(c));
    if let Some(index) = image.pixels.iter().position(bad) {
        let ([r, g, b, _], row) = (image.pixels[index], width as usize);
        return Err(wrong(format!(
            "pixel ({}, {}): expected radiance from 0 to {MAX_RADIANCE}, found [{r}, {g}, {b}]",
            index % row,
            index / row
        )));
    }
    Ok(image)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::picture::{DisplayImage, write_exr, write_png};

    fn refused(name: &str, write: impl FnOnce(&Path)) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        write(&path);
        let error = read_environment(&path).unwrap_err().to_string();
        assert!(error.starts_with(&path.display().to_string()) && !error.contains('\n'), "{error}");
        error
    }

    fn exr(image: &LinearImage) -> String {
        refused("a.exr", |path| write_exr(path, image).unwrap())
    }

    /// `height` rows of one RGBE colour, not compressed.
    fn hdr(width: usize, height: usize, rgbe: [u8; 4]) -> Vec<u8> {
        let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
        [head.into_bytes(), rgbe.repeat(width * height)].concat()
    }

    #[test]
    fn every_format_gives_linear_radiance() {
        let folder = tempfile::tempdir().unwrap();
        let [exr, radiance, png] = ["a.EXR", "a.hdr", "a.png"].map(|name| folder.path().join(name));
        write_exr(&exr, &LinearImage::filled(4, 2, [0.25, 70.0, 0.0, 0.5])).unwrap();
        assert_eq!(read_environment(&exr).unwrap().pixels[7], [0.25, 70.0, 0.0, 0.5]);
        std::fs::write(&radiance, hdr(4, 2, [128, 64, 0, 130])).unwrap();
        assert_eq!(read_environment(&radiance).unwrap().pixels[5], [2.0, 1.0, 0.0, 1.0]);
        write_png(&png, &DisplayImage::filled(4, 2, [255, 188, 0, 0])).unwrap();
        let [r, g, b, _] = read_environment(&png).unwrap().pixels[0];
        assert!(r == 1.0 && (g - 0.503).abs() < 1e-3 && b == 0.0, "{r} {g} {b}");
    }

    #[test]
    fn what_is_no_environment_is_refused_in_one_line() {
        assert!(exr(&LinearImage::filled(4, 4, [1.0; 4])).contains("twice as wide as high, found 4 x 4"));
        assert!(exr(&LinearImage::filled(1, 2, [1.0; 4])).contains("found 1 x 2"));
        for bad in [-0.5, f32::NAN, f32::INFINITY, 1e10] {
            let mut image = LinearImage::filled(8, 4, [1.0; 4]);
            image.pixels[13][1] = bad;
            assert!(exr(&image).contains("pixel (5, 1): expected radiance from 0 to 1000000000, found [1, "));
        }
        assert!(refused("a.jpg", |_| ()).contains(".exr, .hdr or .png"));
        assert!(refused("none.exr", |_| ()).contains("cannot read"));
        for name in ["a.exr", "a.hdr", "a.png"] {
            let message = refused(name, |path| std::fs::write(path, b"#?RADIANCE no picture").unwrap());
            assert!(message.contains("cannot read the picture"), "{message}");
        }
        let cut = refused("a.hdr", |path| std::fs::write(path, &hdr(64, 32, [1; 4])[..99]).unwrap());
        assert!(cut.contains("cannot read the picture"), "{cut}");
        let huge = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 80000\n";
        let message = refused("a.hdr", |path| std::fs::write(path, huge).unwrap());
        assert!(message.contains("cannot read the picture"), "{message}");
    }
}
