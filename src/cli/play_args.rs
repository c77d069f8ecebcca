//! What can be typed about playing.

use super::args::{SceneArgs, ViewArgs};
use super::bench_args::CacheArgs;
use crate::frame::sampling::Sampling;
use clap::{Args as ClapArgs, ValueEnum};
use std::path::PathBuf;

/// What an EXR holds besides light.
#[derive(Debug, ClapArgs)]
pub struct LayersArgs {
    /// Layers of the `.exr` pictures besides their light, as `layers.motion` and `layers.id`: how far what a pixel's centre
    /// sees moves to the picture before and after, and which fabric and yarn it is.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "motion,id")]
    pub layers: Vec<LayerName>,
}

impl LayersArgs {
    /// As assignments to scene keys.
    pub fn assignments(&self) -> impl Iterator<Item = String> {
        self.layers.iter().map(|layer| match layer {
            LayerName::Motion => "layers.motion=true".to_owned(),
            LayerName::Id => "layers.id=true".to_owned(),
        })
    }
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LayerName {
    /// Motion in pixels: `forward.u`, `forward.v`, `backward.u`, `backward.v`.
    Motion,
    /// Numbers from 1: `id.fabric`, `id.curve`.
    Id,
}

/// `worsted play`.
#[derive(Debug, ClapArgs)]
pub struct Play {
    /// What to show.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The pictures, a number in their name (`frames/%04d.png`): `.png` as displayed, `.exr` as linear radiance. May be
    /// given more than once; their folders are made.
    #[arg(short, long, required = true)]
    pub output: Vec<PathBuf>,
    /// Pictures to draw, counted from 0: `10..20` are ten, from 10 to 19; `10..`, `..20`, `10..=19` and `10` are as they
    /// read. All of the motion when not given. With `animation.speed` = 1 a picture shows the frame of its number.
    #[arg(long, value_name = "A..B")]
    pub frames: Option<String>,
    /// How it is seen. A camera that is fitted stays where all of the motion is in view.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Samples per pixel: 1, 4, 16, 36, 64 ...
    #[arg(long, default_value = "4")]
    pub samples: Sampling,
    /// Beside the light.
    #[command(flatten)]
    pub layers: LayersArgs,
    /// Write statistics of every picture as JSON; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
    /// Draw pictures anew that are there already, whatever they are of.
    #[arg(long)]
    pub fresh: bool,
    /// Make a film of the pictures by the ffmpeg on the PATH, `animation.frames_per_second` a second.
    #[arg(long, value_name = "FILM.mp4")]
    pub encode: Option<PathBuf>,
    /// Bake tables and build pipelines anew, and keep neither.
    #[arg(long, conflicts_with = "folder")]
    pub no_cache: bool,
    /// Where tables and pipelines are kept.
    #[command(flatten)]
    pub cache: CacheArgs,
}
