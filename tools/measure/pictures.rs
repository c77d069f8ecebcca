//! Pictures, how far one is from another, and their files.

use std::path::Path;
use worsted::error::Error;
use worsted::frame::Picture;
use worsted::frame::stats::Stats;
use worsted::io::error::FileError;
use worsted::io::picture::{DisplayImage, LinearImage, write_png};
use worsted::metrics::MetricError;
use worsted::metrics::coverage::Coverage;
use worsted::metrics::error::Comparison;
use worsted::metrics::flip::FlipMap;

/// A picture and what was counted as it was drawn.
pub struct Shot {
    /// Radiance and coverage.
    pub linear: LinearImage,
    /// As displayed.
    pub display: DisplayImage,
    /// What was counted.
    pub stats: Stats,
}

impl Shot {
    /// The picture in the types that comparisons take.
    pub fn new(picture: Picture, stats: Stats) -> Self {
        let [width, height] = picture.size;
        let linear = LinearImage { width, height, pixels: picture.linear };
        let display = DisplayImage { width, height, pixels: picture.display };
        Self { linear, display, stats }
    }

    /// The errors that the design quotes: on radiance at exposure 1, without a tone curve.
    ///
    /// # Errors
    /// Pictures that cannot be compared.
    pub fn against(&self, reference: &Self) -> Result<Comparison, Error> {
        worsted::bench::against(&self.linear, &reference.linear)
    }

    /// Mean FLIP of the pictures as displayed, over the pixels that yarn covers in either.
    ///
    /// # Errors
    /// Pictures that cannot be compared.
    pub fn displayed_flip(&self, reference: &Self) -> Result<f64, Error> {
        let covered = Coverage::of_linear(&self.linear, &reference.linear).map_err(failed)?;
        let map = FlipMap::new(&self.display, &reference.display).map_err(failed)?;
        Ok(map.mean_and_max(&covered).map_err(failed)?.0)
    }

    /// Radiance of the yarn itself: the mean over all pixels, each by its coverage.
    ///
    /// # Errors
    /// A picture without yarn.
    pub fn mean_radiance(&self) -> Result<[f64; 3], Error> {
        let mut sum = [0.0; 4];
        for pixel in &self.linear.pixels {
            for (total, value) in sum.iter_mut().zip(pixel) {
                *total += f64::from(*value);
            }
        }
        if sum[3] > 0.0 {
            return Ok([sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]]);
        }
        Err(Error::Failed("expected yarn in the picture, found none".into()))
    }

    /// Writes the picture as displayed to `folder`/`name`.png, if a folder is given.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn save(&self, folder: Option<&Path>, name: &str) -> Result<(), Error> {
        save(&self.display, folder, name)
    }
}

/// Writes a picture to `folder`/`name`.png, if a folder is given.
///
/// # Errors
/// Files that cannot be written.
pub fn save(image: &DisplayImage, folder: Option<&Path>, name: &str) -> Result<(), Error> {
    let Some(folder) = folder else { return Ok(()) };
    std::fs::create_dir_all(folder).map_err(|e| FileError::io(folder, "write", &e))?;
    Ok(write_png(&folder.join(format!("{name}.png")), image)?)
}

fn failed(error: MetricError) -> Error {
    Error::Failed(error.to_string())
}
