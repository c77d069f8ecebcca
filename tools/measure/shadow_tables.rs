//! How far the tables of self-shadows and of ambient occlusion are from the integrals they stand for, by size.

use crate::report::{Verdicts, print_columns, print_head};
use crate::stage::Stage;
use glam::DVec2;
use rayon::prelude::*;
use std::time::Instant;
use worsted::error::Error;
use worsted::precompute::occlusion_table::{
    OCCLUSION_ACROSS, OCCLUSION_LIMIT, bake_occlusion_table, exact_occlusion, occlusion_place,
    texture_occlusion,
};
use worsted::precompute::optical_depth::CrossSection;
use worsted::precompute::self_shadow::{
    SELF_SHADOW_LIMIT, SelfShadowSize, bake_self_shadow, exact_self_shadow_depth, self_shadow_depth,
    self_shadow_place,
};
use worsted::precompute::table_error::{TableError, places};
use worsted::yarn::density::extinction_per_mm;
use worsted::yarn::params::YarnParams;
use worsted::yarn::presets;

/// Texels across and slices of the self-shadow's tables.
const SELF_SHADOW_SIZES: [(u32, u32); 4] = [(32, 8), (64, 16), (128, 32), (256, 64)];
/// Texels across the occlusion's tables.
const OCCLUSION_SIZES: [u32; 5] = [16, 32, 64, 128, 256];

/// `measure shadow-tables`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Presets of yarn; `all` of them.
    #[arg(long, value_delimiter = ',', default_value = "worsted_3ply,silk2,polyester1")]
    yarns: Vec<String>,
    /// Places at which a self-shadow is compared; a tenth as many for occlusion.
    #[arg(long, default_value_t = 200_000, value_parser = clap::value_parser!(u32).range(1000..=10_000_000))]
    places: u32,
}

/// Bakes and compares every size, prints the errors and whether the limits hold.
///
/// # Errors
/// An unknown preset; an error beyond its limit.
pub fn run(stage: &Stage, options: &Options) -> Result<(), Error> {
    let lines = [
        format!("{} places in the outer circle, with as many directions of light", options.places),
        "errors are shares of a table's largest depth, and of all ambient light".to_owned(),
        format!("bakes run on {} CPU threads", rayon::current_num_threads()),
    ];
    print_head("Tables of self-shadows and occlusion", stage.device(), &lines);
    let yarns = yarns(&options.yarns)?;
    let mut verdicts = Verdicts::default();
    print_columns(&["yarn", "self-shadow", "rms", "99%", "worst", "bake ms", "within limits"]);
    for (name, yarn) in &yarns {
        for (across, slices) in SELF_SHADOW_SIZES {
            let size = SelfShadowSize { across, slices };
            let (error, ms) = self_shadow_error(yarn, size, options.places);
            let judged = size == SelfShadowSize::default();
            let holds = if judged { judge(&mut verdicts, name, &error, &SELF_SHADOW_LIMIT) } else { "-" };
            print_row(&format!("{name} | {across}^2 x {slices}"), &error, ms, holds);
        }
    }
    println!();
    print_columns(&["yarn", "occlusion", "rms", "99%", "worst", "bake ms", "within limits"]);
    for (name, yarn) in &yarns {
        for across in OCCLUSION_SIZES {
            let (error, ms) = occlusion_error(yarn, across, options.places / 10);
            let what = format!("{name}: worst error of occlusion");
            let judged = across == OCCLUSION_ACROSS;
            let holds = if judged { verdicts.at_most(&what, error.worst, OCCLUSION_LIMIT) } else { "-" };
            print_row(&format!("{name} | {across}^2"), &error, ms, holds);
        }
    }
    verdicts.finish()
}

fn print_row(head: &str, error: &TableError, ms: f64, holds: &str) {
    let TableError { rms, p99, worst } = error;
    println!("| {head} | {rms:.5} | {p99:.5} | {worst:.5} | {ms:.0} | {holds} |");
}

fn judge(verdicts: &mut Verdicts, name: &str, error: &TableError, limit: &TableError) -> &'static str {
    let each = [
        ("rms", error.rms, limit.rms),
        ("99th percentile", error.p99, limit.p99),
        ("worst", error.worst, limit.worst),
    ];
    let words =
        each.map(|(what, value, limit)| verdicts.at_most(&format!("{name}: {what} of depth"), value, limit));
    if words.contains(&"no") { "no" } else { "yes" }
}

fn yarns(names: &[String]) -> Result<Vec<(String, YarnParams)>, Error> {
    let all: Vec<String> = presets::yarn_names().map(str::to_owned).collect();
    let names = if names.iter().any(|name| name == "all") { &all } else { names };
    let known = |name: &String| {
        let yarn = presets::yarn(name).map(|yarn| (name.clone(), yarn));
        yarn.ok_or_else(|| {
            Error::Failed(format!("--yarns: expected one of {}, found {name}", all.join(", ")))
        })
    };
    names.iter().map(known).collect()
}

fn self_shadow_error(yarn: &YarnParams, size: SelfShadowSize, count: u32) -> (TableError, f64) {
    let started = Instant::now();
    let table = bake_self_shadow(yarn, size);
    let ms = 1e3 * started.elapsed().as_secs_f64();
    let section = CrossSection::new(yarn);
    let pair = |(position, light): (DVec2, DVec2)| {
        let place = self_shadow_place(position, light, yarn.ply_count, size);
        (self_shadow_depth(&table, place), exact_self_shadow_depth(&section, position, light))
    };
    let places: Vec<_> = places(count).collect();
    (TableError::new(&places.into_par_iter().map(pair).collect::<Vec<_>>(), table.largest()), ms)
}

fn occlusion_error(yarn: &YarnParams, across: u32, count: u32) -> (TableError, f64) {
    let started = Instant::now();
    let table = bake_occlusion_table(yarn, extinction_per_mm(yarn), across);
    let ms = 1e3 * started.elapsed().as_secs_f64();
    let section = CrossSection::new(yarn);
    let pair = |position: DVec2| {
        (
            texture_occlusion(&table, occlusion_place(position, across)),
            exact_occlusion(&section, extinction_per_mm(yarn), position),
        )
    };
    let places: Vec<_> = places(count).map(|(position, _)| position).collect();
    (TableError::new(&places.into_par_iter().map(pair).collect::<Vec<_>>(), 1.0), ms)
}
