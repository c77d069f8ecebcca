//! `worsted export`.

use super::args::{Common, Export};
use crate::error::Error;
use crate::io::fiber_bcc::{side_file, write_fiber_bcc};
use crate::io::fiber_runs::{FiberGroup, FiberRun, point_count};
use crate::io::fiber_usda::{USDA_PASSES, write_usda};
use crate::io::whole::check_target;
use crate::reference::fibers::{RealiseSettings, RealisedFiber, realise};
use crate::scene::Scene;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::Path;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Bcc,
    Usda,
}

/// Writes every fiber of a scene.
///
/// # Errors
/// A scene that cannot be had, more fibers than fit in memory, files that cannot be written.
pub fn run(args: &Export, common: &Common) -> Result<(), Error> {
    let format = format(&args.output)?;
    let scene = load(args)?;
    if !common.quiet {
        for fabric in &scene.fabrics {
            fabric.notes.iter().for_each(|note| eprintln!("{}: {note}", fabric.name));
        }
    }
    let shown = !common.quiet && std::io::stderr().is_terminal();
    let bar = bar(shown, "realising fibers", None);
    let settings = RealiseSettings { chord_error: args.chord_error, ..Default::default() };
    let fibers = realise(&scene, &settings).map_err(|e| Error::Arguments(e.to_string()))?;
    bar.finish_and_clear();
    let groups = groups(&scene, &fibers);
    write(&args.output, format, &groups, shown)?;
    if !common.quiet {
        let (path, points) = (args.output.display(), point_count(&groups));
        println!("{path}: {} runs of fibers, {points} points", fibers.len());
        if format == Format::Bcc {
            println!("{}: their radii, yarns and plies", side_file(&args.output).display());
        }
    }
    Ok(())
}

/// The format that the extension asks for, and whether there is room for the file.
fn format(path: &Path) -> Result<Format, Error> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let format = match extension.as_deref() {
        Some("bcc") => Format::Bcc,
        Some("usda") => Format::Usda,
        _ => {
            let message = format!("-o {}: expected a name ending in .bcc or .usda", path.display());
            return Err(Error::Arguments(message));
        }
    };
    check_target(path)?;
    if format == Format::Bcc {
        check_target(&side_file(path))?;
    }
    Ok(format)
}

fn load(args: &Export) -> Result<Scene, Error> {
    if !(1e-4..=10.0).contains(&args.chord_error) {
        let message = format!("--chord-error {}: expected 0.0001 to 10 radii", args.chord_error);
        return Err(Error::Arguments(message));
    }
    let mut assignments: Vec<String> = args.seed.map(|seed| format!("seed={seed}")).into_iter().collect();
    assignments.extend(args.set.iter().cloned());
    Ok(Scene::load(&args.scene, &assignments)?)
}

/// The fibers, fabric by fabric, each where it lies.
fn groups<'a>(scene: &Scene, fibers: &'a [RealisedFiber]) -> Vec<FiberGroup<'a>> {
    let mut groups = vec![FiberGroup::default(); scene.fabrics.len()];
    for fiber in fibers {
        groups[fiber.fabric].runs.push(FiberRun {
            points: &fiber.points,
            radii_mm: &fiber.radii_mm,
            closed: fiber.closed,
            curve: fiber.curve,
            ply: fiber.ply,
            fiber: fiber.fiber,
        });
    }
    groups
}

fn write(path: &Path, format: Format, groups: &[FiberGroup<'_>], shown: bool) -> Result<(), Error> {
    let passes = if format == Format::Usda { USDA_PASSES } else { 1 };
    let bar = bar(shown, "writing", Some(passes * point_count(groups)));
    let progress = |points: u64| bar.inc(points);
    match format {
        Format::Bcc => write_fiber_bcc(path, groups, &progress)?,
        Format::Usda => write_usda(path, groups, &progress)?,
    }
    bar.finish_and_clear();
    Ok(())
}

/// A bar, or where nobody knows how much there is to do, a sign of life.
fn bar(shown: bool, doing: &'static str, length: Option<u64>) -> ProgressBar {
    if !shown {
        return ProgressBar::hidden();
    }
    let (template, bar) = match length {
        Some(length) => ("{msg} {bar:40} {percent}% {elapsed} (left: {eta})", ProgressBar::new(length)),
        None => ("{msg} {spinner} {elapsed}", ProgressBar::new_spinner()),
    };
    let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = bar.with_style(style).with_message(doing);
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    bar
}
