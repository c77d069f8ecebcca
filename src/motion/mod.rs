//! Yarn that moves: where its control points are, and how they and their normals have turned since rest.

pub mod coherence;
pub mod local_rotation;
pub mod mover;
pub mod pose;
