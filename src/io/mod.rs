//! Bytes to and from plain data: yarn files, pictures, and what is kept between runs.

pub mod bcc;
pub mod cache;
pub mod chains;
pub mod curves;
pub mod environment;
pub mod error;
pub mod fiber_bcc;
pub mod fiber_runs;
pub mod fiber_usda;
pub mod frames;
pub mod gltf;
pub mod gltf_write;
pub mod kept;
pub mod layers;
pub mod measured;
pub mod numbered;
pub mod obj;
pub mod picture;
pub mod repair;
pub mod whole;
pub mod yarn_file;
