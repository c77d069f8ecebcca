//! Files that commands write.

use crate::error::Error;
use crate::frame::Picture;
use crate::io::error::FileError;
use crate::io::picture::{DisplayImage, LinearImage, write_exr, write_png};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What a picture file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// 8-bit sRGB over the scene's background.
    Png,
    /// Linear radiance, f32, alpha = the yarn's coverage.
    Exr,
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
    /// Checks the extension before anything is drawn.
    ///
    /// # Errors
    /// An extension that is neither `.png` nor `.exr`.
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
                let pixels = picture.linear.clone();
                write_exr(&self.path, &LinearImage { width, height, pixels })?;
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
    let failed = |e: std::io::Error| FileError::io(path, "write", &e);
    if path == Path::new("-") {
        println!("{text}");
        return Ok(());
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::NamedTempFile::new_in(folder).map_err(failed)?;
    file.write_all(text.as_bytes()).and_then(|()| file.write_all(b"\n")).map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    Ok(())
}
