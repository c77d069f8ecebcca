//! A film of numbered pictures, by the ffmpeg on the PATH.

use crate::error::Error;
use crate::io::numbered::NumberedPath;
use crate::io::whole::check_target;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The program.
const FFMPEG: &str = "ffmpeg";
/// Characters of what it says that are shown.
const SHOWN: usize = 300;

/// A film to be made.
pub struct Film {
    /// Its file; the extension says what kind.
    pub path: PathBuf,
    /// Pictures in a second.
    pub frames_per_second: f64,
}

impl Film {
    /// Checks before anything is drawn that there is an ffmpeg, and room for the film.
    ///
    /// # Errors
    /// No ffmpeg; a folder that does not exist; a name without extension.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |why: String| Error::Arguments(format!("--encode {}: {why}", self.path.display()));
        if self.path.extension().is_none() {
            return Err(wrong("expected a name with an extension, such as .mp4".into()));
        }
        check_target(&self.path)?;
        let found = Command::new(FFMPEG).arg("-version").stdin(Stdio::null()).output();
        match found {
            Ok(output) if output.status.success() => Ok(()),
            _ => Err(wrong("expected an ffmpeg on the PATH, found none: sudo apt-get install ffmpeg".into())),
        }
    }

    /// Makes the film of `count` PNGs from number `first` on, under a temporary name, then renamed.
    ///
    /// # Errors
    /// What ffmpeg says.
    pub fn encode(&self, pictures: &NumberedPath, first: u64, count: u64) -> Result<(), Error> {
        let failed =
            |why: &str| Error::Arguments(format!("--encode {}: {FFMPEG}: {why}", self.path.display()));
        let extension = self.path.extension().unwrap_or_default();
        let folder = self.path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let mut builder = tempfile::Builder::new();
        let mut suffix = OsString::from(".");
        suffix.push(extension);
        builder.prefix(".worsted-").suffix(&suffix);
        // As for other files, see `write_whole`.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let part = builder.tempfile_in(folder.unwrap_or(Path::new(".")));
        let part = part.map_err(|e| failed(&e.to_string()))?.into_temp_path();
        // ffmpeg reads a % in a folder's name as a number, too: it is sent there instead.
        let whole = std::path::absolute(&part).map_err(|e| failed(&e.to_string()))?;
        let folder = Some(pictures.folder()).filter(|folder| !folder.as_os_str().is_empty());
        let output = Command::new(FFMPEG)
            .current_dir(folder.unwrap_or(Path::new(".")))
            .args(arguments(&pictures.pattern(), self.frames_per_second, first, count))
            .arg(&whole)
            .stdin(Stdio::null())
            .output()
            .map_err(|e| failed(&e.to_string()))?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr);
            let last = text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("no reason given");
            return Err(failed(&last.chars().take(SHOWN).collect::<String>()));
        }
        part.persist(&self.path).map_err(|e| failed(&e.error.to_string()))
    }
}

/// Sides are made even, which the usual codecs ask for.
fn arguments(pattern: &str, frames_per_second: f64, first: u64, count: u64) -> Vec<String> {
    let words = format!(
        "-hide_banner -loglevel error -y -framerate {frames_per_second} -start_number {first} -i {{}} \
         -frames:v {count} -vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -pix_fmt yuv420p"
    );
    words
        .split_whitespace()
        .map(|word| if word == "{}" { pattern.to_owned() } else { word.to_owned() })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_spaces_stay_whole() {
        let words = arguments("a b%04d.png", 24.0, 3, 60);
        let at = words.iter().position(|word| word == "-i").unwrap();
        assert_eq!(words[at + 1], "a b%04d.png");
        assert!(words.windows(2).any(|w| w == ["-start_number", "3"]) && words.contains(&"24".to_owned()));
    }
}
