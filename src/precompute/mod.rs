//! What is worked out once on the CPU before a picture is drawn.

pub mod core_bake;
pub mod core_texture;
pub mod environment;
pub mod occlusion_fit;
pub mod optical_depth;
pub mod scattering_table;
