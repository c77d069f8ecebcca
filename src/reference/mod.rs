//! The judge: what a scene's real fibers look like, every one of them, with no table, core or shadow map.
//! Shares nothing with the fast path but the f64 truth of `yarn`, `bsdf` and `scene`.
//!
//! [`fibers`] become [`geometry`], [`accel`] finds what a ray meets, [`integrator`] follows paths, and
//! [`rendering`] adds them up, to be stopped and gone on with by [`checkpoint`].

pub mod accel;
pub mod checkpoint;
mod cone;
pub mod display;
pub mod fibers;
pub mod geometry;
pub mod integrator;
mod material;
pub mod rendering;
mod sky;
mod sweep;

#[cfg(test)]
mod judged;
#[cfg(test)]
mod test_scene;
