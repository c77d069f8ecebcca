//! Worsted
pub mod bsdf;
pub mod cli;
pub mod error;
pub mod frame;
pub mod gpu_types;
pub mod graph;
pub mod io;
pub mod knit;
pub mod math;
pub mod metrics;
pub mod passes;
pub mod precompute;
pub mod scene;
pub mod shaders;
pub mod vulkan;
pub mod yarn;
