//! Fiber scattering in f64.

pub mod khungurn;
pub mod params;
pub mod presets;
pub mod simple;
