//! Generated fabric: yarn centre lines that knit a cloth, and the checks that they do.

pub mod clearance;
mod dense;
pub mod error;
mod fine;
pub mod interlock;
pub mod layout;
pub mod motion;
pub mod params;
mod relax;
mod selvedge;
pub mod stockinette;
#[cfg(test)]
mod stockinette_tests;
pub mod tube;
#[cfg(test)]
mod tube_tests;
mod unit_cell;
pub mod unrolled;
