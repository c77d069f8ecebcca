//! Pictures and scenes that are written for later.

use super::desk::Desk;
use crate::error::Error;
use crate::io::error::FileError;
use crate::io::picture::{DisplayImage, write_png};
use crate::io::whole::write_whole;
use crate::scene::SceneFile;
use std::path::{Path, PathBuf};

/// Writes the picture as it is shown, and beside it the scene that `worsted render` draws it from.
///
/// # Errors
/// No picture yet; files that cannot be written.
pub fn screenshot(desk: &Desk, path: &Path) -> Result<(), Error> {
    let shown = desk.shown().ok_or_else(|| Error::Failed("expected a picture, found none yet".into()))?;
    let [width, height] = shown.picture.size;
    let image = DisplayImage { width, height, pixels: shown.picture.display.clone() };
    write_png(path, &image)?;
    let scene = path.with_extension("toml");
    let text = scene_text(&shown.file, desk.document.folder())?;
    let samples = shown.stats.samples;
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let (of, to) = (name(&scene), name(path));
    let head = format!("# worsted render {of} -o {to} --size {width}x{height} --samples {samples}\n");
    write_whole(&scene, |file| {
        file.write_all(head.as_bytes())?;
        file.write_all(text.as_bytes())
    })?;
    Ok(())
}

/// A scene's every key, with paths that hold wherever the file lies.
fn scene_text(file: &SceneFile, folder: &Path) -> Result<String, Error> {
    let mut file = file.clone();
    let whole = |path: &str| -> Result<String, FileError> {
        let place = folder.join(path);
        let whole = std::path::absolute(&place).map_err(|e| FileError::io(&place, "find", &e))?;
        Ok(whole.to_string_lossy().into_owned())
    };
    for fabric in &mut file.fabric {
        fabric.model = whole(&fabric.model)?;
        fabric.motion = fabric.motion.as_deref().map(whole).transpose()?;
    }
    file.ambient.environment = file.ambient.environment.as_deref().map(whole).transpose()?;
    toml::to_string(&file).map_err(|e| Error::Failed(format!("writing the scene: {e}")))
}

/// What a window does by itself, for scripts.
#[derive(Clone, Debug, Default)]
pub struct Script {
    /// Where the picture goes that is shown at the end.
    pub screenshot: Option<PathBuf>,
    /// Pictures after which the window closes, or sooner where nothing better follows.
    pub exit_after: Option<u64>,
}

impl Script {
    /// Whether the window is to be closed.
    pub fn is_over(&self, desk: &Desk) -> bool {
        self.exit_after.is_some_and(|most| desk.pictures >= most || desk.is_settled() && desk.pictures > 0)
    }
}
