//! One file per pass.

pub mod draw_plan;
pub mod fiber_sets;
pub mod fibers;
mod image_kernel;
pub mod layers;
pub mod pipelines;
pub mod resolve;
pub mod shadow_map;
mod stages;
pub mod strand_pipeline;
pub mod targets;
pub mod tonemap;
