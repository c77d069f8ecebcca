//! Pictures: linear radiance (OpenEXR) and display-referred bytes (PNG), read and written through `image`.

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

use exr::meta::BlockDescription;
use glam::DVec3;
use image::{DynamicImage, ExtendedColorType, ImageEncoder, ImageFormat, ImageReader, Limits};

use crate::io::error::{FileError, Place, plain};
use crate::io::whole::write_whole;
use crate::math::color::{linear_from_srgb, srgb_from_linear};
use crate::math::tone::Display;

/// The longest side of a picture that is read or written, in pixels.
pub const MAX_SIDE: u32 = 16_384;
/// The most pixels of a picture that is read or written: just above 7680 x 4320.
pub const MAX_PIXELS: u64 = 1 << 25;
/// The longest picture file that is read, in bytes: the largest picture as uncompressed 32-bit RGBA, and room.
const MAX_FILE_BYTES: u64 = MAX_PIXELS * 16 + (1 << 26);

/// Linear Rec. 709 radiance, one `[red, green, blue, alpha]` per pixel, row 0 on top, rows left to right.
///
/// Alpha is coverage in [0, 1]; a picture from a file without alpha is covered everywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearImage {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` pixels.
    pub pixels: Vec<[f32; 4]>,
}

/// sRGB-encoded `[red, green, blue, alpha]` bytes per pixel, row 0 on top; alpha is linear coverage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DisplayImage {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` pixels.
    pub pixels: Vec<[u8; 4]>,
}

/// A picture whose sides and number of pixels disagree, or that is empty or too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected 1 to {MAX_SIDE} pixels a side, {MAX_PIXELS} in all and width x height of them; \
     found {width} x {height} with {pixels}"
)]
pub struct BadShape {
    /// The stated width in pixels.
    pub width: u32,
    /// The stated height in pixels.
    pub height: u32,
    /// The pixels there are.
    pub pixels: u64,
}

impl BadShape {
    fn check(width: u32, height: u32, pixels: usize) -> Result<(), Self> {
        let sides_fit = (1..=MAX_SIDE).contains(&width) && (1..=MAX_SIDE).contains(&height);
        let wanted = u64::from(width) * u64::from(height);
        if sides_fit && wanted <= MAX_PIXELS && wanted == pixels as u64 {
            return Ok(());
        }
        Err(Self { width, height, pixels: pixels as u64 })
    }
}

/// The first pixel, in rows from the top, that holds a NaN or an infinity.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error(
    "pixel ({x}, {y}): expected finite values, found [{}, {}, {}, {}]",
    value[0], value[1], value[2], value[3]
)]
pub struct NotFinite {
    /// Column, from 0 on the left.
    pub x: u32,
    /// Row, from 0 on top.
    pub y: u32,
    /// What the pixel holds.
    pub value: [f32; 4],
}

/// Why a linear picture cannot be shown.
#[derive(Clone, Copy, Debug, thiserror::Error)]
pub enum NotDisplayable {
    /// The picture has no sensible size.
    #[error(transparent)]
    Shape(#[from] BadShape),
    /// A NaN or an infinity, which as a byte would look like black or white.
    #[error(transparent)]
    Pixel(#[from] NotFinite),
    /// An exposure that would make every picture alike.
    #[error("expected a finite exposure factor above 0, found {0}")]
    Exposure(f64),
}

impl LinearImage {
    /// A picture of one value everywhere.
    pub fn filled(width: u32, height: u32, pixel: [f32; 4]) -> Self {
        Self { width, height, pixels: vec![pixel; width as usize * height as usize] }
    }

    /// Whether the sides are sensible and agree with the number of pixels.
    pub fn check_shape(&self) -> Result<(), BadShape> {
        BadShape::check(self.width, self.height, self.pixels.len())
    }

    /// Whether every value of every pixel, alpha included, is finite; else the first pixel that is not.
    pub fn check_finite(&self) -> Result<(), NotFinite> {
        let fault = self.pixels.iter().enumerate().find(|(_, pixel)| pixel.iter().any(|v| !v.is_finite()));
        let Some((index, &value)) = fault else { return Ok(()) };
        let row_length = self.width.max(1) as usize;
        Err(NotFinite { x: (index % row_length) as u32, y: (index / row_length) as u32, value })
    }

    /// The light in [0, 1] that a display gives of this radiance over black: exposed, then by the tone curve.
    /// Coverage stays.
    pub fn shown(&self, display: &Display) -> Result<Self, NotDisplayable> {
        self.check_shape()?;
        self.check_finite()?;
        if !(display.exposure.is_finite() && display.exposure > 0.0) {
            return Err(NotDisplayable::Exposure(display.exposure));
        }
        let pixel = |&[r, g, b, a]: &[f32; 4]| {
            let exposed = DVec3::new(r.into(), g.into(), b.into()) * display.exposure;
            let [r, g, b] = display.tone.apply(exposed).as_vec3().to_array();
            [r, g, b, a]
        };
        Ok(Self { width: self.width, height: self.height, pixels: self.pixels.iter().map(pixel).collect() })
    }
}

impl DisplayImage {
    /// A picture of one value everywhere.
    pub fn filled(width: u32, height: u32, pixel: [u8; 4]) -> Self {
        Self { width, height, pixels: vec![pixel; width as usize * height as usize] }
    }

    /// Whether the sides are sensible and agree with the number of pixels.
    pub fn check_shape(&self) -> Result<(), BadShape> {
        BadShape::check(self.width, self.height, self.pixels.len())
    }

    /// The picture as it is shown: [`LinearImage::shown`], sRGB-encoded and rounded to bytes. Coverage is rounded
    /// too, but never from above 0 down to 0.
    pub fn from_linear(image: &LinearImage, display: &Display) -> Result<Self, NotDisplayable> {
        let shown = image.shown(display)?;
        let byte = |linear: f32| (srgb_from_linear(f64::from(linear)) * 255.0).round() as u8;
        let coverage = |alpha: f32| {
            let rounded = (f64::from(alpha).clamp(0.0, 1.0) * 255.0).round() as u8;
            rounded.max(u8::from(alpha > 0.0))
        };
        let pixels = shown.pixels.iter().map(|&[r, g, b, a]| [byte(r), byte(g), byte(b), coverage(a)]);
        Ok(Self { width: image.width, height: image.height, pixels: pixels.collect() })
    }

    /// The light that it shows over black, linear in [0, 1]: alpha, which a PNG keeps apart, is multiplied in.
    pub fn light(&self) -> LinearImage {
        let light = |byte: u8, alpha: f64| (linear_from_srgb(f64::from(byte) / 255.0) * alpha) as f32;
        let pixel = |&[r, g, b, a]: &[u8; 4]| {
            let alpha = f64::from(a) / 255.0;
            [light(r, alpha), light(g, alpha), light(b, alpha), alpha as f32]
        };
        LinearImage {
            width: self.width,
            height: self.height,
            pixels: self.pixels.iter().map(pixel).collect(),
        }
    }
}

/// Writes 8-bit RGBA PNG. The same picture gives the same bytes; a failed write leaves no file behind and an
/// older one as it was.
pub fn write_png(path: &Path, image: &DisplayImage) -> Result<(), FileError> {
    image.check_shape().map_err(|e| refused(path, "write", &e))?;
    let mut bytes = Vec::new();
    image::codecs::png::PngEncoder::new(&mut bytes)
        .write_image(image.pixels.as_flattened(), image.width, image.height, ExtendedColorType::Rgba8)
        .map_err(|e| refused(path, "write", &e))?;
    write_whole(path, |out| out.write_all(&bytes))
}

/// Writes 32-bit float RGBA OpenEXR, losslessly compressed; NaN and infinity are kept as they are. The same
/// picture gives the same bytes; a failed write leaves no file behind and an older one as it was.
pub fn write_exr(path: &Path, image: &LinearImage) -> Result<(), FileError> {
    image.check_shape().map_err(|e| refused(path, "write", &e))?;
    let samples: Vec<u8> = image.pixels.as_flattened().iter().flat_map(|v| v.to_ne_bytes()).collect();
    let mut bytes = Cursor::new(Vec::new());
    image::codecs::openexr::OpenExrEncoder::new(&mut bytes)
        .write_image(&samples, image.width, image.height, ExtendedColorType::Rgba32F)
        .map_err(|e| refused(path, "write", &e))?;
    write_whole(path, |out| out.write_all(bytes.get_ref()))
}

/// Reads a PNG of any colour type as sRGB bytes: grey is spread to three channels, 16 bits are rounded to 8, a
/// missing alpha is 255. Of an animation, the first picture.
pub fn read_png(path: &Path) -> Result<DisplayImage, FileError> {
    let decoded = decode(path, &read_whole(path)?, ImageFormat::Png)?.into_rgba8();
    let (width, height) = decoded.dimensions();
    let image = DisplayImage { width, height, pixels: decoded.into_raw().as_chunks().0.to_vec() };
    image.check_shape().map_err(|e| refused(path, "read", &e))?;
    Ok(image)
}

/// Reads the first RGB or RGBA layer of an OpenEXR file as it stands: no conversion of primaries, a missing
/// alpha is 1, pixels of the display window without data are 0. NaN and infinity are kept.
pub fn read_exr(path: &Path) -> Result<LinearImage, FileError> {
    let bytes = read_whole(path)?;
    check_exr_header(path, &bytes)?;
    let decoded = decode(path, &bytes, ImageFormat::OpenExr)?.into_rgba32f();
    let (width, height) = decoded.dimensions();
    let image = LinearImage { width, height, pixels: decoded.into_raw().as_chunks().0.to_vec() };
    image.check_shape().map_err(|e| refused(path, "read", &e))?;
    Ok(image)
}

/// Reads a Radiance picture (RGBE) as it stands; alpha is 1.
pub fn read_hdr(path: &Path) -> Result<LinearImage, FileError> {
    let decoded = decode(path, &read_whole(path)?, ImageFormat::Hdr)?.into_rgba32f();
    let (width, height) = decoded.dimensions();
    let image = LinearImage { width, height, pixels: decoded.into_raw().as_chunks().0.to_vec() };
    image.check_shape().map_err(|e| refused(path, "read", &e))?;
    Ok(image)
}

/// Longest complaint of a decoder that is passed on, in characters: some repeat what they read.
const LONGEST_COMPLAINT: usize = 300;

/// A decoder's complaint as one line, without the file's own control characters that it may repeat.
pub(super) fn refused(path: &Path, doing: &str, error: &dyn std::fmt::Display) -> FileError {
    let words = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    let shown = words.chars().take(LONGEST_COMPLAINT);
    let message = plain(&shown.collect::<String>());
    FileError::new(path, Place::File, format!("cannot {doing} the picture: {message}"))
}

/// The whole file, whose length is checked while reading, since devices and pipes state none.
pub(super) fn read_whole(path: &Path) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(|e| FileError::io(path, "read", &e))?;
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(|e| FileError::io(path, "read", &e))?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let message = format!("expected a picture of at most {MAX_FILE_BYTES} bytes, found more");
        return Err(FileError::new(path, Place::File, message));
    }
    Ok(bytes)
}

/// What a decoder of others makes of a file. The OpenEXR one asserts what a spoiled file can break: levels of tiles that
/// the file says it does not have.
pub(super) fn guarded<T>(path: &Path, decode: impl FnOnce() -> Result<T, FileError>) -> Result<T, FileError> {
    let decoded = std::panic::catch_unwind(std::panic::AssertUnwindSafe(decode));
    decoded.unwrap_or_else(|_| Err(refused(path, "read", &"its parts contradict one another")))
}

fn decode(path: &Path, bytes: &[u8], format: ImageFormat) -> Result<DynamicImage, FileError> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(MAX_FILE_BYTES);
    reader.limits(limits);
    guarded(path, || reader.decode().map_err(|e| refused(path, "read", &e)))
}

/// Bytes of pixels for each of a file: deflate makes at most 1032 of one, and this is twice that, for room.
const MOST_COMPRESSED: u64 = 2048;
/// Bytes that a picture of any file may take, so that tiles may be larger than a small picture.
const ANY_FILES_BYTES: u64 = 1 << 22;
/// How many times its data an OpenEXR picture's display window may be; and its pixels where that is less.
const MOST_EMPTY: u64 = 64;
const ANY_FILES_PIXELS: u64 = 1 << 20;

/// Bounds what the decoder will allocate: `image` limits the display window alone, while blocks are as large as the
/// data window, the tiles and the number of channels make them, whether the file is long enough for that or not.
pub(super) fn check_exr_header(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let meta =
        exr::meta::MetaData::read_from_buffered(bytes, false).map_err(|e| refused(path, "read", &e))?;
    let most_bytes = (bytes.len() as u64).saturating_mul(MOST_COMPRESSED).max(ANY_FILES_BYTES);
    for (layer, header) in meta.headers.iter().enumerate() {
        let wrong = |message: String| {
            let message = format!("layer {layer}: expected {message}");
            Err(FileError::new(path, Place::File, message))
        };
        let window = header.shared_attributes.display_window;
        let corner = header.own_attributes.layer_position;
        let offsets = [corner.x(), corner.y(), window.position.x(), window.position.y()];
        let sizes = [header.layer_size, window.size];
        let sides_fit = sizes.iter().all(|s| s.x().max(s.y()) <= MAX_SIDE as usize);
        // Below this the decoder's difference of two offsets cannot overflow an i32.
        let offsets_fit = offsets.iter().all(|o| o.unsigned_abs() < 1 << 24);
        let pixels = |size: exr::math::Vec2<usize>| (size.x() as u64).saturating_mul(size.y() as u64);
        let channels = header.channels.list.len() as u64;
        let [data, display] = sizes.map(pixels);
        let samples_fit = data.saturating_mul(channels) <= 4 * MAX_PIXELS && display <= MAX_PIXELS;
        if !(sides_fit && offsets_fit && samples_fit) {
            return wrong(format!(
                "windows of at most {MAX_SIDE} pixels a side and {MAX_PIXELS} RGBA pixels, found data {:?}, \
                 display {:?} and {channels} channels",
                header.layer_size, window.size,
            ));
        }
        let tile = match header.blocks {
            BlockDescription::Tiles(tiles) => pixels(tiles.tile_size),
            BlockDescription::ScanLines => 0,
        };
        let stored = data.max(tile).saturating_mul(header.channels.bytes_per_pixel as u64);
        if stored > most_bytes {
            return wrong(format!("at most {most_bytes} bytes of pixels in so short a file, found {stored}"));
        }
        if display > data.saturating_mul(MOST_EMPTY).max(ANY_FILES_PIXELS) {
            return wrong(format!(
                "a display window of at most {MOST_EMPTY} times the data, found {display} of {data}"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
#[path = "picture_tests.rs"]
mod tests;
