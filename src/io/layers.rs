//! Pictures with layers: light, and of what is seen at each pixel's centre how it moves and which yarn it is, in one
//! OpenEXR file.
//!
//! One part with the channels `R`, `G`, `B`, `A`; `forward.u`, `forward.v`, `backward.u`, `backward.v` (32-bit floats), the
//! names and meanings that Nuke has for motion vectors; `id.fabric`, `id.curve` (32-bit unsigned integers, for which f32
//! would lose digits above 2^24).

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, WritableImage,
};

use crate::io::error::{FileError, Place};
use crate::io::picture::{LinearImage, refused};
use crate::io::whole::write_whole;

/// Names of the light's channels.
const LIGHT: [&str; 4] = ["R", "G", "B", "A"];
/// Names of the motion's channels, in the order of its values.
const MOTION: [&str; 4] = ["backward.u", "backward.v", "forward.u", "forward.v"];
/// Names of the ids' channels.
const IDS: [&str; 2] = ["id.fabric", "id.curve"];

/// What a picture holds besides its light: values of one sample at each pixel's centre, row 0 on top, never blended.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// From where what is seen is to where it was one picture before (x, y) and will be one picture later (x, y), in
    /// pixels, x to the right and y up; 0 where there is no yarn.
    pub motion: Option<Vec<[f32; 4]>>,
    /// Which fabric it is of, and which of the fabric's curves, in the order of the scene and of the yarn file, counted
    /// from 1; 0 where there is no yarn.
    pub ids: Option<Vec<[u32; 2]>>,
}

/// Writes a picture with its layers, losslessly compressed. The same picture gives the same bytes; a failed write leaves no
/// file behind and an older one as it was.
///
/// # Errors
/// Sides and numbers of pixels that disagree; what the file system says.
pub fn write_layers(path: &Path, picture: &LinearImage, layers: &Layers) -> Result<(), FileError> {
    picture.check_shape().map_err(|e| refused(path, "write", &e))?;
    let pixels = picture.pixels.len();
    let lengths = [layers.motion.as_ref().map(Vec::len), layers.ids.as_ref().map(Vec::len)];
    if let Some(found) = lengths.into_iter().flatten().find(|length| *length != pixels) {
        let message = format!("expected layers of every pixel, found {found} of {pixels}");
        return Err(FileError::new(path, Place::File, message));
    }
    let float = |name: &str, values: &[[f32; 4]], place: usize| {
        AnyChannel::new(name, FlatSamples::F32(values.iter().map(|pixel| pixel[place]).collect()))
    };
    let mut channels: SmallVec<_> = (0..4).map(|c| float(LIGHT[c], &picture.pixels, c)).collect();
    if let Some(motion) = &layers.motion {
        channels.extend((0..4).map(|c| float(MOTION[c], motion, c)));
    }
    if let Some(ids) = &layers.ids {
        let id = |c: usize| FlatSamples::U32(ids.iter().map(|pixel| pixel[c]).collect());
        channels.extend((0..2).map(|c| AnyChannel::new(IDS[c], id(c))));
    }
    let size = (picture.width as usize, picture.height as usize);
    let encoding = Encoding::SMALL_LOSSLESS;
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    let image = Image::from_layer(layer);
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|e| refused(path, "write", &e))?;
    write_whole(path, |out| out.write_all(bytes.get_ref()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::measured::MeasuredImage;
    use crate::io::picture::read_exr;
    use exr::prelude::{ReadChannels, ReadLayers, read};

    fn picture() -> LinearImage {
        let pixels = (0..15).map(|i| [i as f32 * 0.37, 1e6, -0.0, 0.5]).collect();
        LinearImage { width: 5, height: 3, pixels }
    }

    fn layers() -> Layers {
        let motion = (0..15).map(|i| [i as f32, -1.5, 1e-20, 16_384.0 - i as f32]).collect();
        // What f32 has no room for.
        let ids = (0..15).map(|i| [i, (1 << 24) + 1 + i]).collect();
        Layers { motion: Some(motion), ids: Some(ids) }
    }

    /// Names of a file's channels, in its order, with their values.
    fn channels(path: &Path) -> Vec<(String, FlatSamples)> {
        let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        let image = reader.all_attributes().non_parallel().from_file(path).unwrap();
        let list = image.layer_data.channel_data.list;
        list.into_iter().map(|channel| (channel.name.to_string(), channel.sample_data)).collect()
    }

    #[test]
    fn every_layer_is_there_as_it_was_and_others_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        write_layers(&path, &picture(), &layers()).unwrap();
        let found = channels(&path);
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        let sorted = [
            "A",
            "B",
            "G",
            "R",
            "backward.u",
            "backward.v",
            "forward.u",
            "forward.v",
            "id.curve",
            "id.fabric",
        ];
        assert_eq!(names, sorted);
        let motion = layers().motion.unwrap();
        for (place, name) in MOTION.into_iter().enumerate() {
            let expected = FlatSamples::F32(motion.iter().map(|pixel| pixel[place]).collect());
            assert!(found.contains(&(name.to_owned(), expected)), "{name}");
        }
        let ids = layers().ids.unwrap();
        for (place, name) in IDS.into_iter().enumerate() {
            let expected = FlatSamples::U32(ids.iter().map(|pixel| pixel[place]).collect());
            assert!(found.contains(&(name.to_owned(), expected)), "{name}");
        }
        write_layers(&path, &picture(), &Layers { motion: None, ..layers() }).unwrap();
        assert_eq!(channels(&path).len(), 6);
        write_layers(&path, &picture(), &Layers { ids: None, ..layers() }).unwrap();
        assert_eq!(channels(&path).len(), 8);
    }

    #[test]
    fn readers_of_pictures_see_the_light_and_files_are_the_same_each_time() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a.exr", "b.exr"].map(|name| folder.path().join(name));
        write_layers(&a, &picture(), &layers()).unwrap();
        write_layers(&b, &picture(), &layers()).unwrap();
        assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(&b).unwrap());
        assert_eq!(read_exr(&a).unwrap(), picture());
        assert_eq!(MeasuredImage::read(&a).unwrap(), MeasuredImage { mean: picture(), variance: None });
    }

    #[test]
    fn a_layer_of_another_size_is_refused_and_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mut wrong = layers();
        wrong.ids.as_mut().unwrap().pop();
        let error = write_layers(&path, &picture(), &wrong).unwrap_err().to_string();
        assert!(error.contains("expected layers of every pixel, found 14 of 15"), "{error}");
        assert!(!path.exists());
        let error =
            write_layers(&folder.path().join("no/a.exr"), &picture(), &layers()).unwrap_err().to_string();
        assert!(error.contains("a.exr") && !error.contains('\n'), "{error}");
    }
}
