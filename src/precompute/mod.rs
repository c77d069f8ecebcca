//! What is worked out once on the CPU before a picture is drawn.

pub mod occlusion_fit;
pub mod optical_depth;
