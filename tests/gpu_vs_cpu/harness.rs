//! Compares what the device returned with the f64 twin, row by row.
//!
//! Arguments are f32 numbers and the twin gets exactly these. The error of an answer is
//! |device - f64| / max(|f64|, floor) and must stay below [`BOUND`] or what [`Part::within`] says. One thing is allowed beyond it:
//! where the function itself magnifies a rounding of its arguments, no f32 formula can be better. So
//! the twin is also evaluated with every argument moved by one f32 step, and an answer may be off by
//! [`STEPS`] times the sum of those changes. [`Summary::well_conditioned`] says how many answers were held to
//! the bound alone; a case where that is few fails.

use glam::{DVec3, DVec4};

/// Largest relative error of an answer.
pub const BOUND: f64 = 1e-4;
/// Roundings inside a formula are no larger in effect than this many of its arguments.
const STEPS: f64 = 4.0;
/// Least share of a case's answers that must be held to the bound alone.
const LEAST_WELL_CONDITIONED: f64 = 0.5;

/// One argument as the device reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Word {
    /// A number.
    Real(f32),
    /// An index, a count or packed bits.
    Bits(u32),
}

impl Word {
    pub fn bits(self) -> u32 {
        match self {
            Self::Real(value) => value.to_bits(),
            Self::Bits(bits) => bits,
        }
    }
}

/// The arguments of one call, in the order of the kernel's `take_` calls.
pub type Row = Vec<Word>;

/// Reads a row from its start.
pub struct Args<'a> {
    words: std::slice::Iter<'a, Word>,
}

impl<'a> Args<'a> {
    pub fn new(row: &'a [Word]) -> Self {
        Self { words: row.iter() }
    }

    pub fn real(&mut self) -> f64 {
        match self.words.next() {
            Some(Word::Real(value)) => f64::from(*value),
            other => panic!("expected a number, found {other:?}"),
        }
    }

    pub fn bits(&mut self) -> u32 {
        match self.words.next() {
            Some(Word::Bits(bits)) => *bits,
            other => panic!("expected bits, found {other:?}"),
        }
    }

    pub fn vec3(&mut self) -> DVec3 {
        DVec3::new(self.real(), self.real(), self.real())
    }

    pub fn vec4(&mut self) -> DVec4 {
        DVec4::new(self.real(), self.real(), self.real(), self.real())
    }

    pub fn piece(&mut self) -> [DVec3; 4] {
        std::array::from_fn(|_| self.vec3())
    }

    pub fn is_empty(&self) -> bool {
        self.words.len() == 0
    }
}

/// One thing a function returns: a number or the components of a vector, whose error is measured as a
/// whole.
#[derive(Clone, Debug)]
pub struct Part {
    pub name: &'static str,
    pub values: Vec<f64>,
    /// Below this magnitude the error is measured against it.
    pub floor: f64,
    /// Largest error.
    pub bound: f64,
}

impl Part {
    /// Held to another bound than [`BOUND`].
    pub fn within(self, bound: f64) -> Self {
        Self { bound, ..self }
    }
}

/// A number.
pub fn number(name: &'static str, value: f64, floor: f64) -> Part {
    numbers(name, vec![value], floor)
}

/// A vector.
pub fn vector(name: &'static str, value: DVec3, floor: f64) -> Part {
    numbers(name, value.to_array().to_vec(), floor)
}

/// Several numbers whose error is measured as a whole.
pub fn numbers(name: &'static str, values: Vec<f64>, floor: f64) -> Part {
    Part { name, values, floor, bound: BOUND }
}

/// What must hold of the device's answer whatever the conditioning; the message says what did not.
pub type Invariant = fn(&mut Args<'_>, &[f32]) -> Result<(), String>;

/// A GLSL function with its twin and the arguments to try.
pub struct Case {
    pub function: &'static str,
    pub rows: Vec<Row>,
    pub twin: fn(&mut Args<'_>) -> Vec<Part>,
    pub invariant: Option<Invariant>,
}

/// What a case came to.
#[derive(Debug)]
pub struct Summary {
    pub rows: usize,
    /// Largest error among the answers held to the bound alone.
    pub worst: f64,
    /// Share of the answers held to the bound alone.
    pub well_conditioned: f64,
    /// Largest error of the others, as a multiple of what one f32 step of the arguments does.
    pub worst_steps: f64,
}

/// The twin's answer for one row.
pub fn twin_of(case: &Case, row: &[Word]) -> Vec<Part> {
    let mut args = Args::new(row);
    let parts = (case.twin)(&mut args);
    assert!(args.is_empty(), "{}: the twin left arguments unread", case.function);
    parts
}

/// For each part of the twin's answer, the sum of its changes when each number of the row moves by one f32 step. Zeros stay:
/// an exact zero is an axis or an absent thing, and its neighbours are numbers no device keeps.
fn changes(case: &Case, row: &[Word]) -> Vec<f64> {
    let parts = twin_of(case, row);
    let mut sums = vec![0.0; parts.len()];
    for index in 0..row.len() {
        let Word::Real(value) = row[index] else { continue };
        if value == 0.0 {
            continue;
        }
        let mut largest = vec![0.0_f64; parts.len()];
        for moved in [value.next_up(), value.next_down()] {
            let mut near = row.to_vec();
            near[index] = Word::Real(moved);
            for ((largest, part), other) in largest.iter_mut().zip(&parts).zip(twin_of(case, &near)) {
                *largest = largest.max(distance(part.values.iter().copied(), &other.values));
            }
        }
        sums.iter_mut().zip(largest).for_each(|(sum, change)| *sum += change);
    }
    sums
}

fn distance(a: impl Iterator<Item = f64>, b: &[f64]) -> f64 {
    a.zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn length(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Compares one row; `expected` is what the device is held to, [`twin_of`] the row unless a test of this
/// comparison says otherwise.
fn compare_row(
    case: &Case,
    row: &[Word],
    found: &[f32],
    expected: &[Part],
    excuse: Excuse,
    tally: &mut Tally,
) -> Result<(), String> {
    let fail = |what: String| Err(format!("{}{row:?}: {what}", case.function));
    let mut rest = found;
    let changes = match excuse {
        Excuse::Conditioning => changes(case, row),
        Excuse::None => vec![0.0; expected.len()],
    };
    for (index, part) in expected.iter().enumerate() {
        let (values, after) = rest.split_at(part.values.len());
        rest = after;
        if let Some(bad) = values.iter().find(|v| !v.is_finite()) {
            return fail(format!("{} is {bad}, expected {:?}", part.name, part.values));
        }
        let off = distance(values.iter().map(|&v| f64::from(v)), &part.values);
        let scale = length(&part.values).max(part.floor);
        let by_steps = STEPS * changes[index];
        if by_steps <= part.bound * scale {
            tally.held += 1;
            tally.worst = tally.worst.max(off / scale);
        } else {
            tally.worst_steps = tally.worst_steps.max(off / changes[index]);
        }
        tally.all += 1;
        // Written so that a NaN fails.
        let good = off <= (part.bound * scale).max(by_steps);
        if !good {
            return fail(format!(
                "{} is {values:?}, expected {:?}: error {:.2e}, {:.1} times what one step of the arguments does",
                part.name,
                part.values,
                off / scale,
                off / changes[index],
            ));
        }
    }
    let invariant = case.invariant.map_or(Ok(()), |holds| holds(&mut Args::new(row), found));
    invariant.or_else(fail)
}

/// What an answer may be off by beyond its bound.
#[derive(Clone, Copy)]
enum Excuse {
    Conditioning,
    None,
}

#[derive(Default)]
struct Tally {
    all: usize,
    held: usize,
    worst: f64,
    worst_steps: f64,
}

/// Compares every row and says in which ones the device is wrong.
pub fn compare(
    case: &Case,
    found: &[Vec<f32>],
    expected: impl Fn(&[Word]) -> Vec<Part>,
) -> Result<Summary, String> {
    compare_rows(case, found, expected, Excuse::Conditioning)
}

/// [`compare`] with nothing allowed beyond the bounds.
pub fn compare_strictly(
    case: &Case,
    found: &[Vec<f32>],
    expected: impl Fn(&[Word]) -> Vec<Part>,
) -> Result<Summary, String> {
    compare_rows(case, found, expected, Excuse::None)
}

fn compare_rows(
    case: &Case,
    found: &[Vec<f32>],
    expected: impl Fn(&[Word]) -> Vec<Part>,
    excuse: Excuse,
) -> Result<Summary, String> {
    assert_eq!(case.rows.len(), found.len(), "{}: one answer per row", case.function);
    let mut tally = Tally::default();
    let mut wrong = Vec::new();
    for (row, found) in case.rows.iter().zip(found) {
        wrong.extend(compare_row(case, row, found, &expected(row), excuse, &mut tally).err());
    }
    let summary = Summary {
        rows: case.rows.len(),
        worst: tally.worst,
        well_conditioned: tally.held as f64 / tally.all as f64,
        worst_steps: tally.worst_steps,
    };
    if !wrong.is_empty() {
        let shown = wrong.iter().take(5).map(String::as_str).collect::<Vec<_>>().join("\n");
        return Err(format!(
            "{} of {} rows wrong ({summary:?}), such as\n{shown}",
            wrong.len(),
            summary.rows
        ));
    }
    if summary.well_conditioned < LEAST_WELL_CONDITIONED {
        return Err(format!("{}: too few rows test anything: {summary:?}", case.function));
    }
    Ok(summary)
}
