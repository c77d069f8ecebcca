//! One function at many arguments, on the device or in f64: JSON lines in, JSON lines out.
//!
//! A query is an object of numbers, all angles in radians and all lengths in one unit. It is checked against the
//! function's own table of fields and rounded to f32, so that both backends see the same numbers. On the device the
//! shader's function runs in a compute kernel, with what the renderer reduces in f64 reduced here and with the
//! renderer's tables; in f64 its twin runs, and no table is read.

mod curve;
mod entries;
pub mod fields;
pub mod function;
mod inside;
mod kernel;
mod line;
mod scattering;
mod stream;
mod yarn;

pub use function::{FUNCTIONS, Function, described, find};
pub use kernel::Kernel;
pub use line::parse;
pub use stream::{Tally, probe};
