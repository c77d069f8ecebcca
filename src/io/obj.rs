//! Wavefront OBJ: `v` points and `l` lines, chained into polylines. Everything else is passed over.
//!
//! Elements that meet end to end at the same vertex become one curve (Blender writes one `l` of two
//! vertices per edge); a chain that comes back to its own start is closed. Where three or more ends meet
//! at a vertex, curves end there, and a note says so. Coordinates behind the third are ignored.

use std::borrow::Cow;
use std::path::Path;

use glam::DVec3;

use super::chains::{Chain, Elements};
use super::curves::{Basis, Curve, CurveSet};
use super::error::{FileError, Place};
use super::yarn_file::{Loaded, coordinate_fault, excerpt, read_file_bytes};

/// Reads the `l` elements of an OBJ file as polylines, without repairs.
///
/// # Errors
/// One line naming the line at fault: a `v` without three finite numbers, an `l` with fewer than two
/// indices, an index that is no integer, 0 or out of range; or the file as a whole when it has no `l`.
pub fn read_obj(path: &Path) -> Result<Loaded, FileError> {
    parse_obj(path, &read_file_bytes(path)?)
}

/// [`read_obj`] over bytes already in memory; `file` only names them in errors.
///
/// # Errors
/// As [`read_obj`].
pub fn parse_obj(file: &Path, bytes: &[u8]) -> Result<Loaded, FileError> {
    let mut obj = Obj::default();
    let mut lines = LogicalLines { lines: bytes.split(|&b| b == b'\n'), number: 0 };
    while let Some((number, line)) = lines.next() {
        obj.read_line(&line).map_err(|message| FileError::new(file, Place::Line(number), message))?;
        // Elements are tagged here, where the line is known, so that late errors can name it.
        obj.line_of.resize(obj.elements.ends.len(), number);
    }
    if obj.elements.ends.is_empty() {
        return Err(FileError::new(file, Place::File, "expected at least one `l` element, found none"));
    }
    obj.check_range(file)?;
    let (chains, junctions) = obj.elements.chained(obj.vertices.len());
    let place = |chain: &Chain| Curve {
        points: chain.vertices.iter().map(|&i| obj.vertices[i]).collect(),
        closed: chain.closed,
    };
    let curves = chains.iter().map(place).collect();
    let mut notes = Vec::new();
    if junctions > 0 {
        notes.push(format!("curves end at {junctions} vertices where three or more line ends meet"));
    }
    if obj.faces > 0 {
        notes.push(format!("{} faces ignored", obj.faces));
    }
    let curves = CurveSet { basis: Basis::Polyline, up_axis: None, curves };
    Ok(Loaded { notes, ..Loaded::of_curves(curves, "OBJ") })
}

/// Lines with those that end in a backslash joined to the next, each with the number of its first.
struct LogicalLines<I> {
    lines: I,
    number: u64,
}

impl<'a, I: Iterator<Item = &'a [u8]>> LogicalLines<I> {
    fn next(&mut self) -> Option<(u64, Cow<'a, [u8]>)> {
        let line = self.lines.next()?;
        self.number += 1;
        let first = self.number;
        let Some(head) = continued(line) else { return Some((first, Cow::Borrowed(line))) };
        let mut joined = head.to_vec();
        for line in self.lines.by_ref() {
            self.number += 1;
            joined.push(b' ');
            let Some(head) = continued(line) else {
                joined.extend_from_slice(line);
                break;
            };
            joined.extend_from_slice(head);
        }
        Some((first, Cow::Owned(joined)))
    }
}

/// A line without the backslash that joins it to the next, if it ends in one.
fn continued(line: &[u8]) -> Option<&[u8]> {
    line.trim_ascii_end().strip_suffix(b"\\")
}

/// What has been read so far.
#[derive(Default)]
struct Obj {
    vertices: Vec<DVec3>,
    elements: Elements,
    line_of: Vec<u64>,
    faces: u64,
}

impl Obj {
    fn read_line(&mut self, line: &[u8]) -> Result<(), String> {
        let mut words = line.split(|b| b.is_ascii_whitespace()).filter(|w| !w.is_empty());
        match words.next() {
            Some(b"v") => self.read_vertex(words),
            Some(b"l") => self.read_element(words),
            Some(b"f") => {
                self.faces += 1;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn read_vertex<'a>(&mut self, mut words: impl Iterator<Item = &'a [u8]>) -> Result<(), String> {
        let mut xyz = [0.0; 3];
        for (i, x) in xyz.iter_mut().enumerate() {
            let word = words.next().ok_or_else(|| format!("expected 3 numbers after `v`, found {i}"))?;
            *x = parse::<f64>(word)
                .ok_or_else(|| format!("expected a number after `v`, found \"{}\"", excerpt(word)))?;
        }
        let p = DVec3::from_array(xyz);
        match coordinate_fault(p) {
            Some(fault) => Err(fault),
            None => {
                self.vertices.push(p);
                Ok(())
            }
        }
    }

    fn read_element<'a>(&mut self, words: impl Iterator<Item = &'a [u8]>) -> Result<(), String> {
        let start = self.elements.indices.len();
        for word in words.take_while(|w| !w.starts_with(b"#")) {
            // `vertex/texture`: only the vertex matters here.
            let vertex = word.split(|&b| b == b'/').next().unwrap_or_default();
            let index = parse::<i64>(vertex)
                .ok_or_else(|| format!("expected a vertex index after `l`, found \"{}\"", excerpt(word)))?;
            self.elements.indices.push(self.zero_based(index)?);
        }
        let found = self.elements.indices.len() - start;
        if found < 2 {
            return Err(format!("expected 2 or more indices after `l`, found {found}"));
        }
        self.elements.ends.push(self.elements.indices.len());
        Ok(())
    }

    /// An index counted from 0. Positive ones may name vertices further down; `check_range` sees to those.
    fn zero_based(&self, index: i64) -> Result<usize, String> {
        let known = self.vertices.len();
        let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        match index {
            0 => Err("expected indices from 1 or from -1, found 0".into()),
            1.. => Ok(back - 1),
            _ => known
                .checked_sub(back)
                .ok_or_else(|| format!("expected an index of at most {known} vertices back, found {index}")),
        }
    }

    fn check_range(&self, file: &Path) -> Result<(), FileError> {
        let known = self.vertices.len();
        for element in 0..self.elements.ends.len() {
            if let Some(&index) = self.elements.element(element).iter().find(|&&i| i >= known) {
                // One more than the largest index on disk is impossible: `zero_based` took 1 off.
                let message = format!("expected an index of at most {known}, found {}", index + 1);
                return Err(FileError::new(file, Place::Line(self.line_of[element]), message));
            }
        }
        Ok(())
    }
}

fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
#[path = "obj_tests.rs"]
mod tests;
