//! What can be typed about viewing.

use super::args::{SceneArgs, TimeArgs, ViewArgs};
use super::bench_args::CacheArgs;
use clap::Args as ClapArgs;
use std::path::PathBuf;

/// `worsted view`.
#[derive(Debug, ClapArgs)]
pub struct View {
    /// What to edit.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// When; as of `render`.
    #[command(flatten)]
    pub time: TimeArgs,
    /// Width and height of the window, in pixels, and from where the scene is seen.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Samples per pixel to which a picture is refined while nothing changes.
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(4..=64))]
    pub samples: u32,
    /// Compare with this picture of linear radiance (`.exr`); pictures then have its size.
    #[arg(long, value_name = "FILE.exr")]
    pub reference: Option<PathBuf>,
    /// Draw with the shaders of this folder, which is like `glsl/` of the source, and again whenever a file there changes.
    #[cfg(feature = "hot-reload")]
    #[arg(long, value_name = "FOLDER")]
    pub shaders: Option<PathBuf>,
    /// Write the picture that is shown last, when the window closes by itself, and the scene beside it.
    #[arg(long, value_name = "FILE.png", requires = "exit_after_frames")]
    pub screenshot: Option<PathBuf>,
    /// Close the window after so many pictures, or once nothing better follows.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub exit_after_frames: Option<u64>,
    /// Bake tables and build pipelines anew, and keep neither.
    #[arg(long, conflicts_with = "folder")]
    pub no_cache: bool,
    /// Where tables and pipelines are kept.
    #[command(flatten)]
    pub cache: CacheArgs,
}
