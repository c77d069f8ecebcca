//! A sheet of pictures with captions, and its file.

use color_quant::NeuQuant;
use embedded_graphics::geometry::OriginDimensions;
use embedded_graphics::mono_font::ascii::FONT_8X13;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle};
use embedded_graphics::text::{Alignment, Baseline, Text, TextStyleBuilder};
use std::path::Path;
use worsted::error::Error;
use worsted::frame::Picture;
use worsted::io::error::FileError;
use worsted::math::color::srgb_from_linear;

/// Captions.
const FONT: MonoFont<'_> = FONT_8X13;
/// Room for one line of caption, in pixels.
pub const CAPTION: u32 = 22;
/// Files stay below this: they lie in the repository.
const MOST_BYTES: usize = 650_000;
/// Palettes to try, finest first.
const COLORS: [usize; 3] = [256, 128, 64];

/// Paper to put pictures on: sRGB bytes, row 0 on top.
pub struct Sheet {
    size: Size,
    pixels: Vec<[u8; 3]>,
}

impl Sheet {
    /// A sheet of `width` x `height` pixels of the colour `paper`.
    pub fn new(width: u32, height: u32, paper: [u8; 3]) -> Self {
        Self { size: Size::new(width, height), pixels: vec![paper; width as usize * height as usize] }
    }

    /// Puts a picture with its upper left corner at `x`, `y`.
    pub fn place(&mut self, picture: &Picture, x: u32, y: u32) {
        let row = picture.size[0] as usize;
        for (j, pixels) in picture.display.chunks_exact(row).enumerate() {
            for (i, &[r, g, b, _]) in pixels.iter().enumerate() {
                self.set(Point::new(x as i32 + i as i32, y as i32 + j as i32), [r, g, b]);
            }
        }
    }

    /// Puts a picture over white, which its own background cannot be: the tone curve reaches white only at
    /// infinity.
    pub fn place_on_white(&mut self, picture: &Picture, x: u32, y: u32) {
        let row = picture.size[0] as usize;
        for (j, pixels) in picture.linear.chunks_exact(row).enumerate() {
            for (i, pixel) in pixels.iter().enumerate() {
                let byte = |c: usize| {
                    let over = f64::from(pixel[c]) + 1.0 - f64::from(pixel[3]);
                    (255.0 * srgb_from_linear(over.clamp(0.0, 1.0))).round() as u8
                };
                self.set(Point::new(x as i32 + i as i32, y as i32 + j as i32), [byte(0), byte(1), byte(2)]);
            }
        }
    }

    /// Writes one line of text whose middle is at height `y`: from `x` rightward, or up to `x`.
    pub fn write(&mut self, text: &str, x: u32, y: u32, ink: [u8; 3], alignment: Alignment) {
        let style = MonoTextStyle::new(&FONT, Rgb888::new(ink[0], ink[1], ink[2]));
        let layout = TextStyleBuilder::new().alignment(alignment).baseline(Baseline::Middle).build();
        let text = Text::with_text_style(text, Point::new(x as i32, y as i32), style, layout);
        // Drawing cannot fail: `Error` is `Infallible`.
        let Ok(_) = text.draw(self);
    }

    /// A bar of `length_mm` at `px_per_mm` up to `x`, with its length before it, at height `y`.
    pub fn scale_bar(&mut self, length_mm: f64, px_per_mm: f64, [x, y]: [u32; 2], ink: [u8; 3]) {
        let length = (length_mm * px_per_mm).round() as u32;
        let left = x.saturating_sub(length);
        let style = PrimitiveStyle::with_fill(Rgb888::new(ink[0], ink[1], ink[2]));
        let bar = Rectangle::new(Point::new(left as i32, y as i32 - 1), Size::new(x - left, 3));
        let Ok(()) = bar.into_styled(style).draw(self);
        self.write(&format!("{length_mm} mm"), left.saturating_sub(6), y, ink, Alignment::Right);
    }

    /// Writes `docs/figures/NAME.png`, in as many colours as fit into a file of [`MOST_BYTES`].
    ///
    /// # Errors
    /// What the file system says; a picture too large even in the fewest colours.
    pub fn save(&self, name: &str) -> Result<(), Error> {
        let mut bytes = encode(self.size, &self.pixels.concat(), None)?;
        for colors in COLORS {
            if bytes.len() > MOST_BYTES {
                let (indices, palette) = reduce(&self.pixels, colors);
                bytes = encode(self.size, &indices, Some(palette))?;
            }
        }
        if bytes.len() > MOST_BYTES {
            let message = format!("{name}: expected at most {MOST_BYTES} bytes, found {}", bytes.len());
            return Err(Error::Failed(message));
        }
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/figures/{name}.png"));
        write_whole(&path, &bytes)?;
        println!(
            "docs/figures/{name}.png: {} x {}, {} bytes",
            self.size.width,
            self.size.height,
            bytes.len()
        );
        Ok(())
    }

    fn set(&mut self, at: Point, color: [u8; 3]) {
        let (x, y) = (at.x as usize, at.y as usize);
        if at.x >= 0 && at.y >= 0 && x < self.size.width as usize && y < self.size.height as usize {
            self.pixels[y * self.size.width as usize + x] = color;
        }
    }
}

impl OriginDimensions for Sheet {
    fn size(&self) -> Size {
        self.size
    }
}

impl DrawTarget for Sheet {
    type Color = Rgb888;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(at, color) in pixels {
            self.set(at, [color.r(), color.g(), color.b()]);
        }
        Ok(())
    }
}

/// The picture in few colours: an index for each pixel, and the palette as RGB bytes.
fn reduce(pixels: &[[u8; 3]], colors: usize) -> (Vec<u8>, Vec<u8>) {
    let rgba: Vec<u8> = pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
    // 1 in 3 pixels trains the palette.
    let network = NeuQuant::new(3, colors, &rgba);
    let indices = rgba.chunks_exact(4).map(|pixel| network.index_of(pixel) as u8).collect();
    (indices, network.color_map_rgb())
}

fn encode(size: Size, data: &[u8], palette: Option<Vec<u8>>) -> Result<Vec<u8>, Error> {
    let failed = |e: png::EncodingError| Error::Failed(format!("PNG: {e}"));
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width, size.height);
    encoder.set_depth(png::BitDepth::Eight);
    match palette {
        Some(palette) => {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(palette);
            // Neighbouring indices mean nothing to each other.
            encoder.set_filter(png::Filter::NoFilter);
        }
        None => {
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_filter(png::Filter::Adaptive);
        }
    }
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(data).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// Writes a file, all of it or nothing.
fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let failed = |e: std::io::Error| FileError::io(path, "write", &e);
    std::fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).map_err(failed)?;
    let unfinished = path.with_extension("png.part");
    std::fs::write(&unfinished, bytes).map_err(failed)?;
    std::fs::rename(&unfinished, path).map_err(failed)?;
    Ok(())
}
