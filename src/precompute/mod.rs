//! What is worked out once on the CPU before a picture is drawn.

pub mod chord_shadow;
pub mod chord_table;
pub mod core_bake;
pub mod core_texture;
pub mod environment;
pub mod occlusion_fit;
pub mod occlusion_size;
pub mod occlusion_table;
pub mod optical_depth;
pub mod scattering_table;
pub mod self_shadow;
pub mod shadow_radius;
pub mod sky;
pub mod stored;
pub mod table;
pub mod table_error;
