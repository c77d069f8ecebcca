//! Pictures that say how sure they are: mean radiance and the variance of that mean, in one OpenEXR file.
//!
//! One layer with the channels `R`, `G`, `B`, `A` and, where the variance is known, `variance.R`, `variance.G`,
//! `variance.B`, all 32-bit floats: any viewer shows the mean.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels, ReadLayers,
    SmallVec, WritableImage, read,
};

use crate::io::error::{FileError, Place};
use crate::io::picture::{LinearImage, check_exr_header, guarded, read_exr, read_whole, refused};
use crate::io::whole::write_whole;

/// Names of the variance's channels.
const VARIANCE: [&str; 3] = ["variance.R", "variance.G", "variance.B"];
/// Names of the mean's channels.
const MEAN: [&str; 4] = ["R", "G", "B", "A"];

/// A picture with what is known of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredImage {
    /// Mean linear radiance and coverage.
    pub mean: LinearImage,
    /// Variance of the mean of red, green and blue of every pixel, in the mean's order and its unit squared;
    /// `None` where nobody knows.
    pub variance: Option<Vec<[f32; 3]>>,
}

impl MeasuredImage {
    /// Writes it. The same picture gives the same bytes; a failed write leaves no file behind and an older one as
    /// it was.
    ///
    /// # Errors
    /// Sides and number of pixels that disagree; what the file system says.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        self.mean.check_shape().map_err(|e| refused(path, "write", &e))?;
        let pixels = &self.mean.pixels;
        let channel = |name: &str, samples: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(samples));
        let mut channels: SmallVec<_> =
            (0..4).map(|c| channel(MEAN[c], pixels.iter().map(|pixel| pixel[c]).collect())).collect();
        if let Some(variance) = &self.variance {
            if variance.len() != pixels.len() {
                let message = format!(
                    "expected a variance of every pixel, found {} of {}",
                    variance.len(),
                    pixels.len()
                );
                return Err(FileError::new(path, Place::File, message));
            }
            channels.extend(
                (0..3).map(|c| channel(VARIANCE[c], variance.iter().map(|pixel| pixel[c]).collect())),
            );
        }
        let size = (self.mean.width as usize, self.mean.height as usize);
        let encoding = Encoding::SMALL_LOSSLESS;
        let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
        let mut bytes = Cursor::new(Vec::new());
        let image = Image::from_layer(layer);
        image.write().non_parallel().to_buffered(&mut bytes).map_err(|e| refused(path, "write", &e))?;
        write_whole(path, |out| out.write_all(bytes.get_ref()))
    }

    /// Reads what [`MeasuredImage::write`] wrote, or any other OpenEXR picture, whose variance is then not known.
    ///
    /// # Errors
    /// What cannot be read as a picture; a variance of some colours only, of another window than the mean's, below
    /// 0 or not finite.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let mean = read_exr(path)?;
        let variance = read_variance(path, &mean)?;
        Ok(Self { mean, variance })
    }
}

/// The variance that goes with `mean`, if the file has one.
fn read_variance(path: &Path, mean: &LinearImage) -> Result<Option<Vec<[f32; 3]>>, FileError> {
    let wrong = |message: String| FileError::new(path, Place::File, message);
    let bytes = read_whole(path)?;
    check_exr_header(path, &bytes)?;
    let decode = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel();
    let image =
        guarded(path, || decode.from_buffered(Cursor::new(&bytes)).map_err(|e| refused(path, "read", &e)))?;
    let layer = &image.layer_data;
    let find = |name: &str| layer.channel_data.list.iter().find(|channel| channel.name.eq(name));
    let found = VARIANCE.map(find);
    if found.iter().all(Option::is_none) {
        return Ok(None);
    }
    let [Some(r), Some(g), Some(b)] = found else {
        return Err(wrong(format!("expected all of {}, found some", VARIANCE.join(", "))));
    };
    let size = (mean.width as usize, mean.height as usize);
    if (layer.size.x(), layer.size.y()) != size {
        let (width, height) = size;
        return Err(wrong(format!(
            "expected a variance of {width} x {height} pixels, found {} x {}",
            layer.size.x(),
            layer.size.y()
        )));
    }
    let value = |channel: &AnyChannel<FlatSamples>, index: usize| match &channel.sample_data {
        FlatSamples::F16(samples) => samples.get(index).map_or(f32::NAN, |v| v.to_f32()),
        FlatSamples::F32(samples) => samples.get(index).copied().unwrap_or(f32::NAN),
        FlatSamples::U32(samples) => samples.get(index).map_or(f32::NAN, |v| *v as f32),
    };
    let variance: Vec<[f32; 3]> =
        (0..mean.pixels.len()).map(|index| [r, g, b].map(|channel| value(channel, index))).collect();
    let bad = |pixel: &[f32; 3]| !pixel.iter().all(|v| (0.0..=f32::MAX).contains(v));
    match variance.iter().position(bad) {
        Some(index) => Err(wrong(format!(
            "pixel ({}, {}): expected a variance from 0 up, found {:?}",
            index % size.0,
            index / size.0,
            variance[index]
        ))),
        None => Ok(Some(variance)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::picture::write_exr;

    fn picture() -> MeasuredImage {
        let value = |i: u32| i as f32 * 0.37 + 1e-9;
        let pixels = (0..15).map(|i| [value(i), 1e6, -0.0, 0.5]).collect();
        let variance = (0..15).map(|i| [value(i) * 1e-12, 0.0, 7.0]).collect();
        MeasuredImage { mean: LinearImage { width: 5, height: 3, pixels }, variance: Some(variance) }
    }

    #[test]
    fn what_was_written_is_read_and_is_the_same_bytes_each_time() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a.exr", "b.exr"].map(|name| folder.path().join(name));
        picture().write(&a).unwrap();
        picture().write(&b).unwrap();
        assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(&b).unwrap());
        assert_eq!(MeasuredImage::read(&a).unwrap(), picture());
        assert_eq!(read_exr(&a).unwrap(), picture().mean, "other readers see the mean");
        let plain = MeasuredImage { variance: None, ..picture() };
        plain.write(&a).unwrap();
        assert_eq!(MeasuredImage::read(&a).unwrap(), plain);
        write_exr(&b, &picture().mean).unwrap();
        assert_eq!(MeasuredImage::read(&b).unwrap(), plain);
    }

    #[test]
    fn what_is_no_variance_is_refused_in_one_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            let mut image = picture();
            image.variance.as_mut().unwrap()[7][1] = bad;
            image.write(&path).unwrap();
            let error = MeasuredImage::read(&path).unwrap_err().to_string();
            assert!(error.contains("pixel (2, 1): expected a variance from 0 up"), "{error}");
        }
        let mut image = picture();
        image.variance.as_mut().unwrap().pop();
        assert!(image.write(&path).unwrap_err().to_string().contains("found 14 of 15"));
        std::fs::write(&path, &std::fs::read(&path).unwrap()[..200]).unwrap();
        let error = MeasuredImage::read(&path).unwrap_err().to_string();
        assert!(error.contains("cannot read the picture") && !error.contains('\n'), "{error}");
        assert!(MeasuredImage::read(&folder.path().join("none.exr")).is_err());
    }

    /// The shortest files there are for their pixels, by both writers.
    #[test]
    fn a_blank_picture_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mean = LinearImage::filled(2048, 1024, [0.0; 4]);
        write_exr(&path, &mean).unwrap();
        assert_eq!(read_exr(&path).unwrap(), mean);
        let variance = Some(vec![[0.0; 3]; mean.pixels.len()]);
        let blank = MeasuredImage { mean, variance };
        blank.write(&path).unwrap();
        println!("{} bytes", std::fs::metadata(&path).unwrap().len());
        assert_eq!(MeasuredImage::read(&path).unwrap(), blank);
    }

    #[test]
    fn a_variance_of_one_color_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let names = ["R", "G", "B", "variance.G"];
        let channels = names.map(|name| AnyChannel::new(name, FlatSamples::F32(vec![1.0; 4]))).into_iter();
        let channels = AnyChannels::sort(channels.collect());
        let layer = Layer::new((2, 2), LayerAttributes::default(), Encoding::UNCOMPRESSED, channels);
        Image::from_layer(layer).write().to_file(&path).unwrap();
        let error = MeasuredImage::read(&path).unwrap_err().to_string();
        assert!(error.contains("expected all of variance.R, variance.G, variance.B, found some"), "{error}");
    }
}
