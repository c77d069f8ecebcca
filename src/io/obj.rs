//! Wavefront OBJ: `v` points and `l` lines, chained into polylines. Everything else is passed over.
//!
//! Elements that meet end to end at the same vertex become one curve (Blender writes one `l` of two
//! vertices per edge); a chain that comes back to its own start is closed. Where three or more ends meet
//! at a vertex, curves end there, and a note says so. Coordinates behind the third are ignored.

use std::borrow::Cow;
use std::path::Path;

use glam::DVec3;

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
        obj.line_of.resize(obj.elements.len(), number);
    }
    if obj.elements.is_empty() {
        return Err(FileError::new(file, Place::File, "expected at least one `l` element, found none"));
    }
    obj.check_range(file)?;
    let (curves, junctions) = obj.chain();
    let mut notes = Vec::new();
    if junctions > 0 {
        notes.push(format!("curves end at {junctions} vertices where three or more line ends meet"));
    }
    if obj.faces > 0 {
        notes.push(format!("{} faces ignored", obj.faces));
    }
    let curves = CurveSet { basis: Basis::Polyline, up_axis: None, curves };
    Ok(Loaded { curves, repairs: Vec::new(), notes, format: "OBJ", kept_points: None })
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
    /// Vertex indices of all elements, one after the other, counted from 0.
    indices: Vec<usize>,
    /// Where each element ends in `indices`; it starts where the one before ends.
    elements: Vec<usize>,
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
        let start = self.indices.len();
        for word in words.take_while(|w| !w.starts_with(b"#")) {
            // `vertex/texture`: only the vertex matters here.
            let vertex = word.split(|&b| b == b'/').next().unwrap_or_default();
            let index = parse::<i64>(vertex)
                .ok_or_else(|| format!("expected a vertex index after `l`, found \"{}\"", excerpt(word)))?;
            self.indices.push(self.zero_based(index)?);
        }
        let found = self.indices.len() - start;
        if found < 2 {
            return Err(format!("expected 2 or more indices after `l`, found {found}"));
        }
        self.elements.push(self.indices.len());
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
        for element in 0..self.elements.len() {
            if let Some(&index) = self.element(element).iter().find(|&&i| i >= known) {
                // One more than the largest index on disk is impossible: `zero_based` took 1 off.
                let message = format!("expected an index of at most {known}, found {}", index + 1);
                return Err(FileError::new(file, Place::Line(self.line_of[element]), message));
            }
        }
        Ok(())
    }

    fn element(&self, element: usize) -> &[usize] {
        let start = if element == 0 { 0 } else { self.elements[element - 1] };
        &self.indices[start..self.elements[element]]
    }

    /// The curves, and the number of vertices where three or more element ends meet.
    fn chain(&self) -> (Vec<Curve>, usize) {
        let joints = Joints::new(self);
        let mut used = vec![false; self.elements.len()];
        let mut curves = Vec::new();
        for element in 0..self.elements.len() {
            if used[element] {
                continue;
            }
            let chain = joints.chain_through(element);
            for end in &chain {
                used[end / 2] = true;
            }
            curves.push(self.curve(&chain));
        }
        (curves, joints.junctions())
    }

    /// The polyline through elements entered at the given ends.
    fn curve(&self, chain: &[usize]) -> Curve {
        let mut path: Vec<usize> = Vec::new();
        for &end in chain {
            // Each element starts at the vertex where the one before ended.
            path.pop();
            let vertices = self.element(end / 2).iter();
            if end.is_multiple_of(2) { path.extend(vertices) } else { path.extend(vertices.rev()) }
        }
        let closed = path.first() == path.last();
        if closed {
            path.pop();
        }
        Curve { points: path.into_iter().map(|i| self.vertices[i]).collect(), closed }
    }
}

/// Which element ends meet. End 2e is the start of element e, end 2e + 1 its finish.
struct Joints<'a> {
    obj: &'a Obj,
    /// Per vertex: how many ends are there, and the first two of them.
    at: Vec<(u32, [usize; 2])>,
}

impl<'a> Joints<'a> {
    fn new(obj: &'a Obj) -> Self {
        let mut joints = Self { obj, at: vec![(0, [0; 2]); obj.vertices.len()] };
        for end in 0..2 * obj.elements.len() {
            let vertex = joints.vertex(end);
            let (count, ends) = &mut joints.at[vertex];
            if *count < 2 {
                ends[*count as usize] = end;
            }
            *count = count.saturating_add(1);
        }
        joints
    }

    fn vertex(&self, end: usize) -> usize {
        let element = self.obj.element(end / 2);
        if end.is_multiple_of(2) { element[0] } else { element[element.len() - 1] }
    }

    fn junctions(&self) -> usize {
        self.at.iter().filter(|(count, _)| *count > 2).count()
    }

    /// The end that `end` continues into: only where exactly two meet.
    fn mate(&self, end: usize) -> Option<usize> {
        let (count, ends) = self.at[self.vertex(end)];
        (count == 2).then(|| if ends[0] == end { ends[1] } else { ends[0] })
    }

    /// Every element joined to this one, in order along the curve, each as the end it is entered at.
    fn chain_through(&self, element: usize) -> Vec<usize> {
        let start = 2 * element;
        let mut chain = vec![start];
        let mut leaving = start + 1;
        while let Some(next) = self.mate(leaving) {
            if next == start {
                return chain;
            }
            chain.push(next);
            leaving = next ^ 1;
        }
        let mut before = Vec::new();
        let mut entering = start;
        while let Some(previous) = self.mate(entering) {
            entering = previous ^ 1;
            before.push(entering);
        }
        before.reverse();
        before.append(&mut chain);
        before
    }
}

fn parse<T: std::str::FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
#[path = "obj_tests.rs"]
mod tests;
