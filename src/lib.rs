//! Worsted renders knitted and woven garments down to the single fiber, on Vulkan, from nothing but the
//! yarn's centre line.
//!
//! The pipeline, in order:
//!
//! 1. [`io`] reads a yarn file into curves, or [`knit`] makes them.
//! 2. [`scene`] resolves what a scene file says: fabrics in mm, camera, light, and the features needed.
//! 3. [`yarn`] is the f64 truth: plies, fibers, migration, loops and hairs along a centre line.
//! 4. [`precompute`] works out tables on the CPU.
//! 5. [`frame`] uploads the scene once and draws pictures, one of [`passes`] after the other; [`motion`] puts yarns that
//!    move where a frame has them.
//! 6. [`reference`](mod@reference) traces the same scene over its real fibers, slowly: the judge.
//! 7. [`metrics`] says how far a picture is from another.
//! 8. [`mod@bench`] measures error against run time.
//! 9. [`mod@probe`] says what one function of the device makes of given numbers, and [`mod@stress`] whether that is
//!    right up to the ends of every domain.
//!
//! ```no_run
//! use worsted::frame::{Renderer, Request, sampling::Sampling};
//! use worsted::scene::Scene;
//! use worsted::vulkan::{Device, DeviceOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::load("models/demo.toml".as_ref(), &["camera.yaw_deg=40".into()])?;
//! let device = Device::new(&DeviceOptions::default())?;
//! let request = Request { size: [640, 480], sampling: Sampling::new(4)?, statistics: false, profile: false };
//! let picture = Renderer::new(&device, scene, request)?.render(&|_| ())?;
//! println!("{} pixels of linear radiance", picture.linear.len());
//! # Ok(())
//! # }
//! ```

pub mod bench;
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
pub mod motion;
pub mod passes;
pub mod precompute;
pub mod probe;
pub mod reference;
pub mod scene;
pub mod shaders;
pub mod stress;
#[cfg(feature = "viewer")]
pub mod viewer;
pub mod vulkan;
pub mod yarn;
