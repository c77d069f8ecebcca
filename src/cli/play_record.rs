//! What the pictures of a folder are of, so that those that are there are not drawn again, and others not taken for them.

use crate::error::Error;
use crate::frame::Request;
use crate::io::error::{FileError, Place};
use crate::io::kept::Key;
use crate::io::numbered::NumberedPath;
use crate::io::whole::write_whole;
use crate::motion::mover::Movers;
use crate::scene::Scene;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// Stands for the number in the record's name.
const NAMED: &str = "play";
/// A record is no longer than this; a file that is, is none.
const MOST_BYTES: u64 = 4096;

/// The record beside some pictures.
pub struct Record {
    path: PathBuf,
    key: String,
}

impl Record {
    /// Of pictures of a scene that is played, in the first of the patterns' folder.
    pub fn new(
        pattern: &NumberedPath,
        scene: &Scene,
        movers: &Movers,
        request: &Request,
        device: &str,
    ) -> Self {
        let key = Key::new(NAMED, env!("CARGO_PKG_VERSION")).bytes(device.as_bytes()).shown(&(
            request.size,
            request.sampling,
            &scene.file,
        ));
        let models = scene.fabrics.iter().map(|fabric| &fabric.strands.points);
        let key = models.fold(key, |key, points| key.bytes(bytemuck::cast_slice(points)));
        let light = scene.environment.iter().map(|picture| &picture.pixels);
        let key = light.fold(key, |key, pixels| key.bytes(bytemuck::cast_slice(pixels)));
        let motions = movers.0.iter().map(|mover| (mover.frame_count(), stamp(&mover.source().first_file())));
        let key = motions.fold(key, |key, motion| key.shown(&motion));
        let path = pattern.named(NAMED).with_added_extension("txt");
        Self { path, key: key.hex() }
    }

    /// Whether pictures that are there are of this scene; makes the record where there is none. `any` is whether there
    /// are pictures, and with `fresh` it does not matter what they are of.
    ///
    /// # Errors
    /// Pictures of something else; a record that cannot be written.
    pub fn settle(&self, any: bool, fresh: bool) -> Result<(), Error> {
        if self.found().as_deref() == Some(self.key.as_str()) {
            return Ok(());
        }
        if any && !fresh {
            let message = "expected pictures of the same scene, motion, size and samples beside it, found others: \
                           --fresh draws them anew";
            return Err(FileError::new(&self.path, Place::File, message).into());
        }
        Ok(write_whole(&self.path, |out| writeln!(out, "{}", self.key))?)
    }

    fn found(&self) -> Option<String> {
        let small = std::fs::metadata(&self.path).is_ok_and(|file| file.len() <= MOST_BYTES);
        let text = small.then(|| std::fs::read_to_string(&self.path).ok())??;
        Some(text.trim_end().to_owned())
    }
}

/// What tells a file from another of that name: its size and when it was written.
fn stamp(path: &Path) -> Option<(u64, u128)> {
    let metadata = std::fs::metadata(path).ok()?;
    let written = metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    Some((metadata.len(), written.as_nanos()))
}
