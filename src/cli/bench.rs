//! `worsted bench`.

use super::args::Common;
use super::bench_args::{Bench, BenchCloth};
use super::job::parse_size;
use super::open_device;
use super::output::write_text;
use super::progress::{set_share, share_bar};
use crate::bench::ablate::{Effort, OMISSIONS, Omission, ablate, table};
use crate::bench::cloth::{Cloth, Model};
use crate::bench::fronts::{Fronts, look};
use crate::bench::page;
use crate::bench::report::{Cell, Report};
use crate::bench::run::{self, Plan};
use crate::bench::settings::{DEFAULT, Setting, check_samples, grid, quick_grid};
use crate::bench::truth::TruthSettings;
use crate::bench::views::views;
use crate::cli::say::{say, tell};
use crate::error::Error;
use crate::io::cache::Cache;
use crate::io::error::FileError;
use crate::scene::Scene;
use crate::vulkan::Device;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

/// The swatch that is drawn where no model is given: larger than a close picture.
const SWATCH: Cloth = Cloth::Stockinette { wales: 8, courses: 10 };
const YARN: &str = "worsted_3ply";
/// The dye that the README's demo has.
const COLOR: [f64; 3] = [0.42, 0.10, 0.05];
/// Size and samples of a reference where nothing is said, and of a quick run.
const USUAL: (&str, u64) = ("480x360", 64);
const QUICK: (&str, u64) = ("160x120", 16);
/// Size of the pictures that things are left out of.
const ABLATED: &str = "320x240";

/// Measures, writes the report, keeps the front.
///
/// # Errors
/// Arguments that make no sense; those of scenes, references, the device and files.
pub fn run(args: &Bench, common: &Common) -> Result<(), Error> {
    match &args.output {
        Some(output) if !args.ablate => report(args, output, common),
        _ => ablations(args, common),
    }
}

/// Prints what leaving each thing out saves.
fn ablations(args: &Bench, common: &Common) -> Result<(), Error> {
    let size = parse_size(args.size.as_deref().unwrap_or(ABLATED))?;
    let part = args.only.as_deref().unwrap_or_default();
    let omissions: Vec<Omission> =
        OMISSIONS.iter().copied().filter(|omission| omission.name.contains(part)).collect();
    if omissions.is_empty() {
        return Err(Error::Arguments(format!("--only {part}: nothing of that name can be left out")));
    }
    let device = open_device(common)?;
    let bar = share_bar(common);
    let effort = Effort { size, frames: args.frames };
    let savings = ablate(&device, effort, &omissions, &mut |share, doing| {
        set_share(&bar, share);
        bar.set_message(doing.to_owned());
    });
    bar.finish_and_clear();
    let savings = savings?;
    let clock = if device.is_cpu() { "processor time of all threads" } else { "time by the device" };
    say!("{} ({}), {clock}, medians of {} pictures", device.name(), device.driver(), args.frames);
    say!("{}", table(&savings));
    Ok(Device::shutdown(device)?)
}

fn report(args: &Bench, output: &Path, common: &Common) -> Result<(), Error> {
    check_samples(&args.samples)?;
    let cache = Cache::new(args.cache.folder.as_deref()).map_err(Error::Arguments)?;
    let (size, samples) = if args.quick { QUICK } else { USUAL };
    let size = parse_size(args.size.as_deref().unwrap_or(size))?;
    let all = if args.quick { quick_grid() } else { grid(&args.samples) };
    // Of all of them, so that a part of the grid has the references of the whole.
    let mut floors: Vec<u64> = all.iter().map(|setting| u64::from(setting.samples)).collect();
    floors.sort_unstable();
    floors.dedup();
    let settings = only(all, args.only.as_deref())?;
    let folder = make_folder(output)?;
    let models = tempfile::tempdir().map_err(|e| FileError::io(&std::env::temp_dir(), "write", &e))?;
    let (scene, model) = scene(args, models.path())?;
    let views = views(&scene, &args.set, size, &args.views)?;
    let samples = args.spp.unwrap_or(samples);
    let plan = Plan {
        scene,
        model,
        sets: args.set.clone(),
        views,
        settings,
        size,
        truth: TruthSettings { samples, floors },
        frames: args.frames,
        folder,
        cache,
    };
    let device = open_device(common)?;
    let report = measure(&plan, &device, common)?;
    if !args.quick {
        keep_front(&plan, &device, &report)?;
    }
    Device::shutdown(device)?;
    page::write(&report, &plan.folder)?;
    if args.quick {
        write_text(Path::new("-"), &ratios(&report))?;
    }
    if !common.quiet {
        say!("{}", page::summary(&report));
        report.warnings.iter().for_each(|warning| tell!("warning: {warning}"));
        say!("{}", plan.folder.join(page::PAGE_FILE).display());
    }
    Ok(())
}

/// The settings whose name holds `part`, where one is given.
fn only(mut settings: Vec<Setting>, part: Option<&str>) -> Result<Vec<Setting>, Error> {
    if let Some(part) = part {
        settings.retain(|setting| setting.name.contains(part));
        if settings.is_empty() {
            return Err(Error::Arguments(format!("--only {part}: no settings of that name")));
        }
    }
    Ok(settings)
}

fn make_folder(folder: &Path) -> Result<PathBuf, Error> {
    std::fs::create_dir_all(folder).map_err(|e| FileError::io(folder, "make", &e))?;
    Ok(folder.to_owned())
}

/// The scene's path and what a reader knows it by.
fn scene(args: &Bench, folder: &Path) -> Result<(PathBuf, String), Error> {
    if let Some(path) = &args.model {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        return Ok((path.clone(), name));
    }
    let mut fiber = toml::Table::new();
    fiber.insert("color".into(), COLOR.to_vec().into());
    let cloth = match args.cloth {
        BenchCloth::Swatch => SWATCH,
        BenchCloth::Sweater => Cloth::Sweater,
    };
    let model = Model::write(folder, YARN, cloth, fiber)?;
    Ok((model.path, format!("{} of {YARN}", cloth.name())))
}

fn measure(plan: &Plan, device: &std::sync::Arc<Device>, common: &Common) -> Result<Report, Error> {
    let bar = share_bar(common);
    let lines = !common.quiet && !std::io::stderr().is_terminal();
    let mut doing_before = String::new();
    let report = run::run(device, plan, &mut |share, doing| {
        set_share(&bar, share);
        if doing != doing_before {
            bar.set_message(doing.to_owned());
            if lines && common.verbose > 0 {
                tell!("{:3.0}% {doing}", 100.0 * share);
            }
            doing_before = doing.to_owned();
        }
    });
    bar.finish_and_clear();
    report
}

/// Keeps what was measured for `worsted render --max-error` and `--max-ms`.
fn keep_front(plan: &Plan, device: &Device, report: &Report) -> Result<(), Error> {
    let mut fronts = Fronts::read(&plan.cache, device.name(), device.driver())?;
    fronts.add(report, &look(&Scene::load(&plan.scene, &plan.sets)?));
    fronts.write(&plan.cache)
}

/// A table of every picture against the default of its view, where that was drawn.
fn ratios(report: &Report) -> String {
    let mut lines =
        vec!["| view | setting | FLIP | time / default's |".to_owned(), "|---|---|---|---|".to_owned()];
    for view in &report.views {
        let ms = |cell: &Cell| cell.time(&report.head).median;
        let default_ms = report.cell(&view.name, DEFAULT).map(ms);
        for cell in report.cells_of(&view.name) {
            let ratio =
                default_ms.map_or("-".to_owned(), |default_ms| format!("{:.2}", ms(cell) / default_ms));
            lines.push(format!("| {} | {} | {:.4} | {ratio} |", view.name, cell.setting.name, cell.flip));
        }
    }
    lines.join("\n")
}
