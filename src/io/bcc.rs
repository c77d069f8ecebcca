//! BCC (binary curve collection) files: Cem Yuksel's format for yarn-level models.
//!
//! 64-byte little-endian header: `BCC`, a byte of widths (high nibble integers, low nibble floats, in
//! bytes), two letters of curve type, the dimensions, the up axis, u64 curve count, u64 point count,
//! 40 bytes of info. Then per curve an i32 point count, negative where the curve is closed, and the
//! points. Every claim is checked against the bytes that are left before anything is allocated.
//!
//! | oddity | judged |
//! |---|---|
//! | counts that need more bytes than there are, or disagree | error |
//! | widths other than 4, dimensions other than 3, unknown type | error |
//! | NaN, infinity, beyond 1e15 | error |
//! | a Bezier count that is not 3k + 1 (open), 3k (closed; 3k + 1 with the first point repeated) | error |
//! | no curves at all | error |
//! | bytes after the data, unknown up axis | note |
//! | info bytes that are no text | ignored |
//! | curves too short to draw | passed on: [`super::repair`] drops them |

use std::io::Write;
use std::path::Path;

use glam::DVec3;

use super::curves::{Basis, Curve, CurveSet, UpAxis};
use super::error::{FileError, Place};
use super::whole::write_whole;
use super::yarn_file::{Loaded, coordinate_fault, excerpt, read_file_bytes};

/// The first three bytes of every BCC file.
pub const BCC_MAGIC: [u8; 3] = *b"BCC";

const HEADER_BYTES: usize = 64;
/// Offsets of the two u64 counts in the header.
const CURVES_AT: u64 = 8;
const POINTS_AT: u64 = 16;
/// Three little-endian f32.
pub(super) const POINT_BYTES: usize = 12;
const COUNT_BYTES: usize = 4;
/// Four-byte integers, four-byte floats: the only widths seen in files and the only ones read.
const WIDTHS: u8 = 0x44;

/// Reads a BCC file as it stands: validated, not repaired (see [`super::yarn_file::load_yarn_file`]).
///
/// # Errors
/// One line naming the byte at fault, with what was expected and found.
pub fn read_bcc(path: &Path) -> Result<Loaded, FileError> {
    parse_bcc(path, &read_file_bytes(path)?)
}

/// [`read_bcc`] over bytes already in memory; `file` only names them in errors.
///
/// # Errors
/// As [`read_bcc`].
pub fn parse_bcc(file: &Path, bytes: &[u8]) -> Result<Loaded, FileError> {
    let (header, body) = parse_header(file, bytes)?;
    let mut reader = Reader { file, bytes: body, offset: HEADER_BYTES };
    let mut curves = Vec::new();
    let mut points = 0u64;
    for index in 0..header.curves {
        let curve = reader.curve(index, header.basis)?;
        points += curve.points.len() as u64;
        curves.push(curve);
    }
    if points != header.points {
        let message = format!(
            "expected {points} points in all, as the curves hold, found a claim of {}",
            header.points
        );
        return Err(FileError::new(file, Place::Byte(POINTS_AT), message));
    }
    let mut notes = Vec::new();
    if header.up_axis.is_none() {
        notes.push(format!("up axis {} is unknown (expected 0, 1 or 2 for X, Y or Z)", bytes[7]));
    }
    if !reader.bytes.is_empty() {
        notes.push(format!(
            "{} bytes after the data ignored, from byte {}",
            reader.bytes.len(),
            reader.offset
        ));
    }
    let curves = CurveSet { basis: header.basis, up_axis: header.up_axis, curves };
    Ok(Loaded { notes, ..Loaded::of_curves(curves, "BCC") })
}

/// What the header claims, once it is known to fit the file.
struct Header {
    basis: Basis,
    up_axis: Option<UpAxis>,
    curves: u64,
    points: u64,
}

/// The header and the bytes behind it.
fn parse_header<'a>(file: &Path, bytes: &'a [u8]) -> Result<(Header, &'a [u8]), FileError> {
    let error = |at: u64, message: String| Err(FileError::new(file, Place::Byte(at), message));
    let magic = &bytes[..bytes.len().min(BCC_MAGIC.len())];
    if magic != BCC_MAGIC {
        return error(0, format!("expected \"BCC\", found \"{}\"", excerpt(magic)));
    }
    let Some((head, body)) = bytes.split_first_chunk::<HEADER_BYTES>() else {
        return error(0, format!("expected a header of {HEADER_BYTES} bytes, found {}", bytes.len()));
    };
    if head[3] != WIDTHS {
        let (integer, float) = (head[3] >> 4, head[3] & 15);
        return error(
            3,
            format!(
                "expected 4-byte integers and floats, found {integer}-byte integers, {float}-byte floats"
            ),
        );
    }
    let basis = match &head[4..6] {
        b"C0" => Basis::CatmullRom,
        b"BS" => Basis::BSpline,
        b"BZ" => Basis::Bezier,
        b"PL" => Basis::Polyline,
        other => {
            return error(4, format!("expected curve type C0, BS, BZ or PL, found \"{}\"", excerpt(other)));
        }
    };
    if head[6] != 3 {
        return error(6, format!("expected 3 dimensions, found {}", head[6]));
    }
    let up_axis = match head[7] {
        0 => Some(UpAxis::X),
        1 => Some(UpAxis::Y),
        2 => Some(UpAxis::Z),
        _ => None,
    };
    let curves = u64_at(head, CURVES_AT);
    let points = u64_at(head, POINTS_AT);
    if curves == 0 {
        return error(CURVES_AT, "expected at least one curve, found 0".into());
    }
    let needed = u128::from(curves) * COUNT_BYTES as u128 + u128::from(points) * POINT_BYTES as u128;
    if needed > body.len() as u128 {
        return error(
            CURVES_AT,
            format!(
                "expected {needed} bytes for {curves} curves of {points} points in all, found {} left",
                body.len()
            ),
        );
    }
    Ok((Header { basis, up_axis, curves, points }, body))
}

fn u64_at(head: &[u8; HEADER_BYTES], at: u64) -> u64 {
    let mut word = [0; 8];
    word.copy_from_slice(&head[at as usize..at as usize + 8]);
    u64::from_le_bytes(word)
}

/// The bytes not read yet.
struct Reader<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    offset: usize,
}

impl Reader<'_> {
    fn curve(&mut self, index: u64, basis: Basis) -> Result<Curve, FileError> {
        let Some((count, rest)) = self.bytes.split_first_chunk::<COUNT_BYTES>() else {
            let left = self.bytes.len();
            return Err(self.error(0, format!("curve {index}: expected a 4-byte count, found {left} bytes")));
        };
        let signed = i32::from_le_bytes(*count);
        let (closed, count) = (signed < 0, signed.unsigned_abs() as usize);
        let room = rest.len() / POINT_BYTES;
        if count > room {
            return Err(self.error(
                0,
                format!("curve {index}: expected at most {room} points in the bytes left, found a count of {signed}"),
            ));
        }
        let (data, rest) = rest.split_at(count * POINT_BYTES);
        let points: Vec<DVec3> = data.chunks_exact(POINT_BYTES).map(point).collect();
        for (i, &p) in points.iter().enumerate() {
            if let Some(fault) = coordinate_fault(p) {
                let at = COUNT_BYTES + i * POINT_BYTES;
                return Err(self.error(at, format!("curve {index}, point {i}: {fault}")));
            }
        }
        let curve = Curve { points, closed };
        if let Some(fault) = count_fault(CurveRef { points: &curve.points, closed }, basis) {
            return Err(self.error(0, format!("curve {index}: {fault}")));
        }
        self.offset += COUNT_BYTES + data.len();
        self.bytes = rest;
        Ok(curve)
    }

    fn error(&self, ahead: usize, message: String) -> FileError {
        FileError::new(self.file, Place::Byte((self.offset + ahead) as u64), message)
    }
}

/// The point that [`POINT_BYTES`] bytes hold.
pub(super) fn point(bytes: &[u8]) -> DVec3 {
    let axis = |i: usize| {
        let mut word = [0; 4];
        word.copy_from_slice(&bytes[4 * i..4 * i + 4]);
        f64::from(f32::from_le_bytes(word))
    };
    DVec3::new(axis(0), axis(1), axis(2))
}

/// Why a count cannot be cut into cubic pieces; curves of fewer than two points are left to the repairs.
fn count_fault(curve: CurveRef<'_>, basis: Basis) -> Option<String> {
    let n = curve.points.len();
    if basis != Basis::Bezier || n < 2 {
        return None;
    }
    let repeats_first = curve.points.first() == curve.points.last();
    match (curve.closed, n % 3) {
        (false, 1) | (true, 0) => None,
        (true, 1) if repeats_first => None,
        (false, _) => Some(format!("expected 3k + 1 points in an open Bezier curve, found {n}")),
        (true, _) => Some(format!("expected 3k points in a closed Bezier curve, found {n}")),
    }
}

/// Writes a BCC file with 4-byte floats, to a temporary name in the same folder, then renamed.
///
/// An unknown up axis is written as Y, the renderer's own; the info field says `worsted`.
///
/// # Errors
/// Curves that [`read_bcc`] would refuse (none at all, a coordinate that is not finite as f32, a Bezier
/// count that does not fit, 2^31 points or more), or the operating system's; no file is left behind then.
pub fn write_bcc(path: &Path, set: &CurveSet) -> Result<(), FileError> {
    let curves = set.curves.iter().map(|curve| CurveRef { points: &curve.points, closed: curve.closed });
    write_bcc_curves(path, set.basis, set.up_axis.unwrap_or(UpAxis::Y), curves, &|_| ())
}

/// A curve that is written from where it lies.
#[derive(Clone, Copy, Debug)]
pub struct CurveRef<'a> {
    /// Its control points.
    pub points: &'a [DVec3],
    /// Whether the last point joins the first again.
    pub closed: bool,
}

/// [`write_bcc`] without a copy of the points; `progress` is told how many as they are written.
///
/// # Errors
/// As [`write_bcc`].
pub fn write_bcc_curves<'a>(
    path: &Path,
    basis: Basis,
    up_axis: UpAxis,
    curves: impl Iterator<Item = CurveRef<'a>> + Clone,
    progress: &dyn Fn(u64),
) -> Result<(), FileError> {
    check_writable(path, basis, curves.clone())?;
    write_whole(path, |out| {
        write_header(out, basis, up_axis, curves.clone())?;
        for CurveRef { points, closed } in curves {
            // `check_writable` has seen that the count fits an i32.
            let count = points.len() as i32;
            out.write_all(&(if closed { -count } else { count }).to_le_bytes())?;
            for x in points.iter().flat_map(|p| p.to_array()) {
                out.write_all(&(x as f32).to_le_bytes())?;
            }
            progress(points.len() as u64);
        }
        Ok(())
    })
}

fn check_writable<'a>(
    path: &Path,
    basis: Basis,
    curves: impl Iterator<Item = CurveRef<'a>>,
) -> Result<(), FileError> {
    let mut found = 0;
    for (i, curve) in curves.enumerate() {
        let error = |message| Err(FileError::new(path, Place::Curve(i), message));
        if i32::try_from(curve.points.len()).is_err() {
            return error(format!("expected fewer than 2^31 points, found {}", curve.points.len()));
        }
        if let Some(fault) = count_fault(curve, basis) {
            return error(fault);
        }
        if let Some(fault) = curve.points.iter().find_map(|&p| coordinate_fault(p)) {
            return error(fault);
        }
        found = i + 1;
    }
    if found == 0 {
        return Err(FileError::new(path, Place::File, "expected at least one curve to write, found 0"));
    }
    Ok(())
}

fn write_header<'a>(
    out: &mut dyn Write,
    basis: Basis,
    up_axis: UpAxis,
    curves: impl Iterator<Item = CurveRef<'a>>,
) -> std::io::Result<()> {
    let kind = match basis {
        Basis::CatmullRom => b"C0",
        Basis::BSpline => b"BS",
        Basis::Bezier => b"BZ",
        Basis::Polyline => b"PL",
    };
    let up = match up_axis {
        UpAxis::X => 0,
        UpAxis::Y => 1,
        UpAxis::Z => 2,
    };
    let sum =
        |(count, points): (u64, u64), curve: CurveRef<'_>| (count + 1, points + curve.points.len() as u64);
    let (count, points) = curves.fold((0, 0), sum);
    out.write_all(&BCC_MAGIC)?;
    out.write_all(&[WIDTHS, kind[0], kind[1], 3, up])?;
    out.write_all(&count.to_le_bytes())?;
    out.write_all(&points.to_le_bytes())?;
    let mut info = [0; 40];
    info[..7].copy_from_slice(b"worsted");
    out.write_all(&info)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(n: usize, closed: bool) -> Curve {
        Curve { points: (0..n).map(|i| DVec3::new(i as f64, 0.1 * i as f64, -1.5)).collect(), closed }
    }

    /// Every basis and up axis, open and closed, survives bit for bit once rounded to f32.
    #[test]
    fn round_trip_is_exact_to_f32() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bcc");
        for basis in [Basis::CatmullRom, Basis::BSpline, Basis::Bezier, Basis::Polyline] {
            for up in [UpAxis::X, UpAxis::Y, UpAxis::Z] {
                let curves = vec![curve(7, false), curve(6, true), curve(4, false)];
                let mut set = CurveSet { basis, up_axis: Some(up), curves };
                write_bcc(&path, &set).unwrap();
                for p in set.curves.iter_mut().flat_map(|c| &mut c.points) {
                    *p = p.as_vec3().as_dvec3();
                }
                let loaded = read_bcc(&path).unwrap();
                assert_eq!((loaded.curves, loaded.notes.len()), (set, 0));
            }
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "temporary files are left behind");
    }

    #[test]
    fn what_could_not_be_read_back_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bcc");
        let refused = |basis, curves| {
            let error = write_bcc(&path, &CurveSet { basis, up_axis: None, curves }).unwrap_err();
            assert!(!path.exists());
            error.message
        };
        assert!(refused(Basis::Polyline, vec![]).contains("found 0"));
        let wild = Curve { points: vec![DVec3::ZERO, DVec3::splat(1e300)], closed: false };
        assert!(refused(Basis::Polyline, vec![wild]).contains("x = 1e300"));
        assert!(refused(Basis::Bezier, vec![curve(6, false)]).contains("3k + 1 points"));
        assert!(refused(Basis::Bezier, vec![curve(7, true)]).contains("3k points"));
    }

    #[test]
    fn a_closed_bezier_may_repeat_its_first_point() {
        let mut loop_ = curve(7, true);
        loop_.points[6] = loop_.points[0];
        assert_eq!(count_fault(CurveRef { points: &loop_.points, closed: true }, Basis::Bezier), None);
        assert_eq!(
            count_fault(CurveRef { points: &curve(1, false).points, closed: false }, Basis::Bezier),
            None
        );
    }
}
