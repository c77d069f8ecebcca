//! Fiber scattering in f64.

pub mod simple;
