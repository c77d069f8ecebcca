//! Plain mathematics that every other module may use; imports no project module.

pub mod angle;
pub mod bounds;
pub mod color;
pub mod coverage;
pub mod curve;
pub mod digest;
pub mod frame;
pub mod hash;
pub mod motion;
pub mod quadrature;
pub mod rng;
pub mod rotation;
pub mod special;
pub mod spread;
pub mod strip;
pub mod tone;
