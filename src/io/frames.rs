//! Moving curves, frame by frame from disk: never more than one frame is in memory here.
//!
//! - **Raw frames** (`frames.f32`): little-endian f32 `[frame][point][xyz]` and nothing else, in the order of the points
//!   of the model at rest.
//! - **Numbered files** (`cloth.%04d.bcc`): one yarn file a frame, with the same curves as the model at rest. The least
//!   number that is there is frame 0.
//! - **glTF**: its first animation, looked at so many times a second. It is in memory as a whole, as it is in the file.

use super::bcc::{POINT_BYTES, point};
use super::curves::CurveLayout;
use super::error::{FileError, Place, shown};
use super::gltf::Model;
use super::numbered::NumberedPath;
use super::yarn_file::{Loaded, coordinate_fault, read_file_bytes, read_unrepaired};
use glam::DVec3;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Where frames come from.
#[derive(Debug)]
pub enum FrameSource {
    /// One file with all of them.
    Raw(RawFrames),
    /// A file each.
    Numbered(NumberedFrames),
    /// An animation.
    Gltf(GltfFrames),
}

impl FrameSource {
    /// Opens the frames of a model whose file holds curves of this layout: numbered files where the name has a `%`, and
    /// raw frames where it ends in `.f32`, a glTF where it ends in `.gltf` or `.glb`. Of that `per_second` frames are a second.
    ///
    /// # Errors
    /// A file or a frame that is missing; frames of another number of points.
    pub fn open(path: &Path, layout: &CurveLayout, per_second: f64) -> Result<Self, FileError> {
        if NumberedPath::is_meant(path) {
            return NumberedFrames::open(path, layout.clone()).map(Self::Numbered);
        }
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gltf") || e.eq_ignore_ascii_case("glb")) {
            return GltfFrames::open(path, layout, per_second).map(Self::Gltf);
        }
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("f32")) {
            return RawFrames::open(path, layout.point_count()).map(Self::Raw);
        }
        let message = format!(
            "expected frames in a .f32, .gltf or .glb file or numbered files (cloth.%04d.bcc), found {}",
            shown(path)
        );
        Err(FileError::new(path, Place::File, message))
    }

    /// Frames that there are, at least 1.
    pub fn count(&self) -> u64 {
        match self {
            Self::Raw(raw) => raw.count,
            Self::Numbered(numbered) => numbered.count,
            Self::Gltf(gltf) => gltf.count,
        }
    }

    /// The file that holds the first frame.
    pub fn first_file(&self) -> PathBuf {
        match self {
            Self::Raw(raw) => raw.path.clone(),
            Self::Numbered(numbered) => numbered.names.file(numbered.first),
            Self::Gltf(gltf) => gltf.path.clone(),
        }
    }

    /// The points of one frame, counted from 0, in the file's units, axes and order.
    ///
    /// # Errors
    /// One line that names the frame: one that is not there, cannot be read or holds other curves than the model, a
    /// point that is not finite.
    pub fn read(&mut self, frame: u64) -> Result<Vec<DVec3>, FileError> {
        match self {
            Self::Raw(raw) => raw.read(frame),
            Self::Numbered(numbered) => numbered.read(frame),
            Self::Gltf(gltf) => gltf.read(frame),
        }
    }
}

/// Whether there is a frame of that number among `count`; `path` is what is named where not.
fn check_frame(path: &Path, frame: u64, count: u64) -> Result<(), FileError> {
    if frame < count {
        return Ok(());
    }
    let message = format!("expected a frame of 0 to {}, found none", count - 1);
    Err(FileError::new(path, Place::Frame(frame), message))
}

/// A file of raw frames.
#[derive(Debug)]
pub struct RawFrames {
    path: PathBuf,
    file: File,
    points: usize,
    count: u64,
    bytes: Vec<u8>,
}

impl RawFrames {
    fn open(path: &Path, points: usize) -> Result<Self, FileError> {
        let failed = |e: std::io::Error| FileError::io(path, "read", &e);
        let metadata = std::fs::metadata(path).map_err(failed)?;
        if !metadata.is_file() {
            return Err(FileError::new(
                path,
                Place::File,
                "expected a regular file, found a folder or device",
            ));
        }
        let (frame_bytes, found) = ((points * POINT_BYTES) as u64, metadata.len());
        let (count, rest) = (found / frame_bytes.max(1), found % frame_bytes.max(1));
        if rest != 0 || count == 0 {
            let message = format!(
                "expected {frame_bytes} bytes for the model's {points} points, found {rest} at the file's end"
            );
            return Err(FileError::new(path, Place::Frame(count), message));
        }
        let file = File::open(path).map_err(failed)?;
        Ok(Self { path: path.to_owned(), file, points, count, bytes: Vec::new() })
    }

    fn read(&mut self, frame: u64) -> Result<Vec<DVec3>, FileError> {
        check_frame(&self.path, frame, self.count)?;
        let error = |message: String| FileError::new(&self.path, Place::Frame(frame), message);
        self.bytes.resize(self.points * POINT_BYTES, 0);
        self.file
            .seek(SeekFrom::Start(frame * self.bytes.len() as u64))
            .and_then(|_| self.file.read_exact(&mut self.bytes))
            .map_err(|e| error(format!("cannot read: {e}")))?;
        let mut points = Vec::with_capacity(self.points);
        for (index, xyz) in self.bytes.chunks_exact(POINT_BYTES).enumerate() {
            let p = point(xyz);
            if let Some(fault) = coordinate_fault(p) {
                return Err(error(format!("point {index}: {fault}")));
            }
            points.push(p);
        }
        Ok(points)
    }
}

/// A yarn file for every frame.
#[derive(Debug)]
pub struct NumberedFrames {
    names: NumberedPath,
    first: u64,
    count: u64,
    layout: CurveLayout,
}

impl NumberedFrames {
    fn open(path: &Path, layout: CurveLayout) -> Result<Self, FileError> {
        let wrong = |message: String| FileError::new(path, Place::File, message);
        let names = NumberedPath::new(path).map_err(wrong)?;
        let found = names.found().map_err(|e| FileError::io(names.folder(), "read", &e))?;
        let Some((count, first, last)) = found else {
            return Err(wrong(format!("expected at least one file such as {}, found none", names.pattern())));
        };
        if last - first + 1 != count {
            // One of few is missing among many: looked for by name.
            let missing = (first..last).find(|number| !names.file(*number).exists()).unwrap_or(last);
            let message = format!(
                "expected {} files up to number {last}, found {count} and not this one",
                last - first + 1
            );
            return Err(FileError::new(&names.file(missing), Place::Frame(missing - first), message));
        }
        Ok(Self { names, first, count, layout })
    }

    fn read(&mut self, frame: u64) -> Result<Vec<DVec3>, FileError> {
        let path = self.names.file(self.first.saturating_add(frame));
        check_frame(&path, frame, self.count)?;
        let Loaded { curves, layout, .. } = read_unrepaired(&path)
            .map_err(|e| FileError { message: format!("frame {frame}: {}", e.message), ..e })?;
        match self.layout.difference(&layout) {
            Some(message) => Err(FileError::new(&path, Place::Frame(frame), message)),
            None => Ok(curves.curves.into_iter().flat_map(|curve| curve.points).collect()),
        }
    }
}

/// Most frames that an animation may have.
const MOST_FRAMES: f64 = 1e9;

/// An animation of a glTF.
#[derive(Debug)]
pub struct GltfFrames {
    path: PathBuf,
    model: Model,
    per_second: f64,
    count: u64,
}

impl GltfFrames {
    fn open(path: &Path, layout: &CurveLayout, per_second: f64) -> Result<Self, FileError> {
        let model = Model::new(path, &read_file_bytes(path)?)?;
        let wrong = |message: String| FileError::new(path, Place::File, message);
        let seconds =
            model.duration().ok_or_else(|| wrong("expected at least one animation, found none".into()))?;
        if let Some(message) = layout.difference(&CurveLayout::new(model.curves())) {
            return Err(FileError::new(path, Place::Frame(0), message));
        }
        // A last key that lies on a frame but for rounding is one.
        let count = (seconds * per_second + 1e-6).floor() + 1.0;
        if count > MOST_FRAMES {
            return Err(wrong(format!("expected at most {MOST_FRAMES} frames, found {count}")));
        }
        Ok(Self { path: path.to_owned(), model, per_second, count: count as u64 })
    }

    fn read(&self, frame: u64) -> Result<Vec<DVec3>, FileError> {
        check_frame(&self.path, frame, self.count)?;
        let points = self.model.points(Some(frame as f64 / self.per_second));
        points.map_err(|e| FileError { place: Place::Frame(frame), ..e })
    }
}

#[cfg(test)]
#[path = "frames_tests.rs"]
mod tests;
