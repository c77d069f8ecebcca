//! The one door for yarn files: picks the reader, repairs what real files get wrong, reports both.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::DVec3;

use super::bcc::{BCC_MAGIC, parse_bcc};
use super::curves::{CurveLayout, CurveSet};
use super::error::{FileError, Place};
use super::gltf::{GLB_MAGIC, parse_gltf};
use super::obj::parse_obj;
use super::repair::{Repair, repair_curves};

/// A yarn file's curves with everything a user should hear about them.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The curves, in the file's units and axes.
    pub curves: CurveSet,
    /// What was changed, in file order; empty from the bare readers, which change nothing.
    pub repairs: Vec<Repair>,
    /// Oddities that needed no change (bytes after the data, an unknown up axis), one line each.
    pub notes: Vec<String>,
    /// The format's short name: `BCC`, `OBJ` or `glTF`.
    pub format: &'static str,
    /// Where repairs dropped points: for each point of `curves`, in order, its index among all points
    /// of the file, so that a frame sequence in the file's order still fits. `None` = all kept.
    pub kept_points: Option<Vec<usize>>,
    /// The curves of the file as they were before repairs.
    pub layout: CurveLayout,
    /// Whether the file says how they move.
    pub moves: bool,
    /// Millimetres in its unit, where the format says so.
    pub mm_per_unit: Option<f64>,
}

impl Loaded {
    /// Curves that need neither repairs nor notes, from what `format` names.
    pub fn of_curves(curves: CurveSet, format: &'static str) -> Self {
        let layout = CurveLayout::of(&curves);
        Self {
            curves,
            repairs: Vec::new(),
            notes: Vec::new(),
            format,
            kept_points: None,
            layout,
            moves: false,
            mm_per_unit: None,
        }
    }
}

/// Largest file that is read, in bytes: a yarn file beyond it is surely something else.
const MAX_FILE_BYTES: u64 = 4 << 30;

/// Largest coordinate magnitude, in file units: its square still fits the device's f32.
pub const MAX_COORDINATE: f64 = 1e15;

/// Reads a yarn file, BCC and binary glTF by their first bytes, OBJ and glTF by their extension, and repairs it.
///
/// # Errors
/// One line with the place at fault: an unreadable file, an unknown format, anything the format's
/// reader rejects, or no curve left that is long enough to draw.
pub fn load_yarn_file(path: &Path) -> Result<Loaded, FileError> {
    parse_yarn_file(path, &read_file_bytes(path)?)
}

/// [`load_yarn_file`] over bytes already read; `file` names them in errors and its extension counts.
///
/// # Errors
/// As [`load_yarn_file`].
pub fn parse_yarn_file(file: &Path, bytes: &[u8]) -> Result<Loaded, FileError> {
    let mut loaded = parse_unrepaired(file, bytes)?;
    let found = loaded.curves.curves.len();
    let repaired = repair_curves(loaded.curves);
    if repaired.curves.curves.is_empty() {
        let message = format!(
            "expected at least one curve with two distinct points, found {found} curves, all too short"
        );
        return Err(FileError::new(file, Place::File, message));
    }
    loaded.curves = repaired.curves;
    loaded.repairs = repaired.repairs;
    loaded.kept_points = repaired.kept_points;
    Ok(loaded)
}

/// A yarn file as it stands: all points of all curves, in the file's order.
///
/// # Errors
/// As [`load_yarn_file`], but for curves that are too short.
pub fn read_unrepaired(path: &Path) -> Result<Loaded, FileError> {
    parse_unrepaired(path, &read_file_bytes(path)?)
}

fn parse_unrepaired(file: &Path, bytes: &[u8]) -> Result<Loaded, FileError> {
    let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match extension.as_str() {
        _ if bytes.starts_with(&BCC_MAGIC) => parse_bcc(file, bytes),
        "bcc" => parse_bcc(file, bytes),
        _ if bytes.starts_with(&GLB_MAGIC) => parse_gltf(file, bytes),
        "gltf" | "glb" => parse_gltf(file, bytes),
        "obj" => parse_obj(file, bytes),
        _ => {
            let message = format!(
                "expected a BCC file (first bytes \"BCC\") or a name ending in .obj, .gltf or .glb, found \"{}\"",
                excerpt(extension.as_bytes())
            );
            Err(FileError::new(file, Place::File, message))
        }
    }
}

/// The bytes of a regular file of at most 4 GiB; pipes and devices, which may never end, are refused.
///
/// # Errors
/// The operating system's, or a file that is no regular file or too large.
pub(super) fn read_file_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    let failed = |e: std::io::Error| FileError::io(path, "read", &e);
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(FileError::new(path, Place::File, "expected a regular file, found a folder or device"));
    }
    let mut bytes = Vec::new();
    let mut file = File::open(path).map_err(failed)?.take(MAX_FILE_BYTES + 1);
    file.read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(FileError::new(path, Place::File, "expected at most 4 GiB, found more"));
    }
    Ok(bytes)
}

/// What is wrong with a point, as the tail of an error line, or `None` when it can be drawn.
pub(super) fn coordinate_fault(p: DVec3) -> Option<String> {
    let sound = |x: &f64| x.abs() <= MAX_COORDINATE;
    let at = p.to_array().iter().position(|x| !sound(x))?;
    let axis = ["x", "y", "z"][at];
    Some(format!("expected a finite coordinate within 1e15, found {axis} = {:e}", p.to_array()[at]))
}

/// At most 40 characters of hostile bytes, made safe to print on one line.
pub(super) fn excerpt(bytes: &[u8]) -> String {
    const SHOWN: usize = 40;
    let head: String = bytes.iter().take(SHOWN).map(|b| b.escape_ascii().to_string()).collect();
    if bytes.len() > SHOWN { format!("{head}...") } else { head }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_wins_over_the_extension_and_unknown_names_are_refused() {
        let obj = b"v 0 0 0\nv 1 0 0\nl 1 2\n";
        assert_eq!(parse_yarn_file(Path::new("a.OBJ"), obj).unwrap().format, "OBJ");
        let error = parse_yarn_file(Path::new("a.txt"), obj).unwrap_err().to_string();
        assert!(error.starts_with("a.txt: expected a BCC file"), "{error}");
        // Ten bytes that begin like BCC are judged as BCC whatever the name says.
        let error = parse_yarn_file(Path::new("a.obj"), b"BCC\x44C0\x03\x01ab").unwrap_err();
        assert!(error.to_string().contains("header"), "{error}");
    }

    #[test]
    fn a_file_of_nothing_but_short_curves_is_an_error() {
        let obj = b"v 0 0 0\nv 0 0 0\nl 1 2\n";
        let error = parse_yarn_file(Path::new("a.obj"), obj).unwrap_err();
        assert!(error.message.contains("found 1 curves, all too short"), "{error}");
    }

    #[test]
    fn folders_and_missing_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(load_yarn_file(folder.path()).unwrap_err().message.contains("regular file"));
        let missing = folder.path().join("no.bcc");
        assert!(load_yarn_file(&missing).unwrap_err().message.starts_with("cannot read"));
    }

    #[test]
    fn coordinates_are_judged_and_excerpts_clipped() {
        assert_eq!(coordinate_fault(DVec3::new(1.0, -2.0, MAX_COORDINATE)), None);
        assert!(coordinate_fault(DVec3::new(0.0, f64::NAN, 0.0)).unwrap().ends_with("y = NaN"));
        assert!(coordinate_fault(DVec3::new(0.0, 0.0, -2e15)).is_some());
        assert_eq!(excerpt(b"a\n\xff"), "a\\n\\xff");
        assert_eq!(excerpt(&[b'x'; 50]).len(), 43);
    }
}
