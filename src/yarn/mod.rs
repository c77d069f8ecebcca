//! The yarn in f64: parameters, plies, fibers, migration, frames and phases along a centre line.

pub mod breaks;
pub mod contact;
pub mod core;
pub mod cusps;
pub mod density;
pub mod detail;
pub mod fetch;
pub mod fiber;
pub mod flyaway;
pub mod inside;
pub mod level;
pub mod migrated_density;
pub mod migration;
pub mod packed;
pub mod params;
pub mod period;
pub mod pose;
pub mod presets;
pub mod ranges;
pub mod strand;
pub mod table;
pub mod transport;
pub mod tube;
pub mod turning;
pub mod zhao;
