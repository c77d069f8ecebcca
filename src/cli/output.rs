//! Files that commands write.

use crate::cli::say::say;
use crate::error::Error;
use crate::frame::Picture;
use crate::io::layers::write_layers;
use crate::io::picture::{DisplayImage, LinearImage, write_exr, write_png};
use crate::io::whole::{check_target, write_whole};
use crate::scene::file::LayersTable;
use std::path::{Path, PathBuf};

/// What a picture file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// 8-bit sRGB over the scene's background, or with the yarn's coverage as straight alpha.
    Png,
    /// Linear radiance, f32, alpha = the yarn's coverage.
    Exr,
}

/// That a scene's layers have a file to go to.
///
/// # Errors
/// Layers, and none but `.png` pictures.
pub fn check_layers(
    layers: &LayersTable,
    formats: impl IntoIterator<Item = PictureFormat>,
) -> Result<(), Error> {
    if layers.any() && formats.into_iter().all(|format| format != PictureFormat::Exr) {
        let message = "--layers: expected an .exr picture to hold them, found none but .png";
        return Err(Error::Arguments(message.to_owned()));
    }
    Ok(())
}

/// One picture file to write.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its path.
    pub path: PathBuf,
    /// Its format, by its extension.
    pub format: PictureFormat,
}

impl Output {
    /// Checks the extension and the folder before anything is drawn.
    ///
    /// # Errors
    /// An extension that is neither `.png` nor `.exr`; a folder that does not exist.
    pub fn new(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        let format = match extension.as_deref() {
            Some("png") => PictureFormat::Png,
            Some("exr") => PictureFormat::Exr,
            _ => {
                let message = format!("-o {}: expected a name ending in .png or .exr", path.display());
                return Err(Error::Arguments(message));
            }
        };
        check_target(path)?;
        Ok(Self { path: path.to_owned(), format })
    }

    /// Writes the picture.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&self, picture: &Picture) -> Result<(), Error> {
        let [width, height] = picture.size;
        match self.format {
            PictureFormat::Png => {
                let pixels = picture.display.clone();
                write_png(&self.path, &DisplayImage { width, height, pixels })?;
            }
            PictureFormat::Exr => {
                let image = LinearImage { width, height, pixels: picture.linear.clone() };
                match &picture.layers {
                    None => write_exr(&self.path, &image)?,
                    Some(layers) => write_layers(&self.path, &image, layers)?,
                }
            }
        }
        Ok(())
    }
}

/// Writes text to a file, all of it or nothing; `-` is standard output.
///
/// # Errors
/// What the file system says.
pub fn write_text(path: &Path, text: &str) -> Result<(), Error> {
    if path == Path::new("-") {
        say!("{text}");
        return Ok(());
    }
    write_whole(path, |out| writeln!(out, "{text}"))?;
    Ok(())
}
