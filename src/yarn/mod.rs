//! The yarn in f64: parameters, plies, fibers, migration, frames and phases along a centre line.

pub mod contact;
pub mod density;
pub mod fiber;
pub mod level;
pub mod migration;
pub mod params;
pub mod presets;
pub mod strand;
pub mod table;
pub mod transport;
