//! What can be typed about error against run time.

use crate::bench::views::ViewKind;
use clap::{Args as ClapArgs, ValueEnum};
use std::path::PathBuf;

/// Where what took long is kept.
#[derive(Debug, ClapArgs)]
pub struct CacheArgs {
    /// Where what took long is kept: references and fronts of `bench`, tables and pipelines of `render`;
    /// `WORSTED_CACHE` or the user's cache folder when not given.
    #[arg(long = "cache", value_name = "DIR")]
    pub folder: Option<PathBuf>,
}

/// Settings picked from what `worsted bench` measured on this device; they have the last word over `--set` and
/// `--samples`.
#[derive(Debug, ClapArgs)]
pub struct Budget {
    /// The fastest settings that err by at most this: mean FLIP over covered pixels, 0 to 1.
    #[arg(long, value_name = "FLIP")]
    pub max_error: Option<f64>,
    /// The most accurate settings that take at most so many milliseconds of wall time for a picture.
    #[arg(long, value_name = "MS")]
    pub max_ms: Option<f64>,
    /// Measure what was promised, and end with exit code 1 where it was not kept. An error needs a traced
    /// reference, which takes minutes.
    #[arg(long)]
    pub verify: bool,
    /// Where references and fronts are kept.
    #[command(flatten)]
    pub cache: CacheArgs,
}

/// `worsted bench`.
#[derive(Debug, ClapArgs)]
pub struct Bench {
    /// A folder for the report: `index.html`, `bench.json`, `bench.csv`, `bench.svg`. What it holds already is not
    /// measured again.
    #[arg(short, long, value_name = "DIR", required_unless_present = "ablate")]
    pub output: Option<PathBuf>,
    /// Print what leaving each thing out of three scenes saves in time, memory and baking, and nothing else; `--only`,
    /// `--size` and `--frames` are as for a report, but that pictures are of 320x240 pixels when not given.
    #[arg(long, conflicts_with_all = ["output", "model", "cloth", "views", "samples", "spp", "set", "quick"])]
    pub ablate: bool,
    /// A scene (`.toml`) or a yarn file (`.bcc`, `.obj`) in place of generated cloth.
    #[arg(long, value_name = "FILE", conflicts_with = "cloth")]
    pub model: Option<PathBuf>,
    /// Generated cloth.
    #[arg(long, value_enum, default_value = "swatch")]
    pub cloth: BenchCloth,
    /// From where it is looked at.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "close,worst,full")]
    pub views: Vec<ViewKind>,
    /// Width and height in pixels; 480x360, or of a quick run 160x120, when not given.
    #[arg(long, value_name = "WxH")]
    pub size: Option<String>,
    /// Settings whose name holds this, alone.
    #[arg(long, value_name = "SUBSTRING")]
    pub only: Option<String>,
    /// Samples per pixel to measure the default with, besides 4.
    #[arg(long, value_delimiter = ',', default_value = "1,16", value_name = "N,N")]
    pub samples: Vec<u32>,
    /// Samples per pixel of the references; 64, or of a quick run 16, when not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(4..=1 << 16))]
    pub spp: Option<u64>,
    /// Pictures of which the median counts, after one to warm up; two where one takes over a second.
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub frames: u32,
    /// Set a scene key of every picture and reference. May be given more than once.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// A few settings in small pictures, as ratios: for a machine with little time. Keeps no front.
    #[arg(long)]
    pub quick: bool,
    /// Where references and fronts are kept.
    #[command(flatten)]
    pub cache: CacheArgs,
}

/// Generated cloth to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BenchCloth {
    /// Stockinette, 8 x 10 loops.
    Swatch,
    /// A doll's: a tube with a sleeve hanging on either side.
    Sweater,
}
