//! `worsted export`.

use super::args::{Common, Export};
use super::job::{load_scene, realise_settings, report_notes};
use super::progress::task_bar;
use crate::cli::say::say;
use crate::error::Error;
use crate::io::fiber_bcc::{side_file, write_fiber_bcc};
use crate::io::fiber_runs::{FiberGroup, FiberRun, point_count};
use crate::io::fiber_usda::{USDA_PASSES, write_usda};
use crate::io::whole::check_target;
use crate::reference::fibers::{RealisedFiber, realise};
use crate::scene::Scene;
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
    let settings = realise_settings(args.chord_error)?;
    let scene = load_scene(&args.scene, &args.time, None)?;
    report_notes(&scene, common);
    let bar = task_bar(common, "realising fibers", None);
    let fibers = realise(&scene, &settings).map_err(|e| Error::Arguments(e.to_string()))?;
    bar.finish_and_clear();
    let groups = groups(&scene, &fibers);
    write(&args.output, format, &groups, common)?;
    if !common.quiet {
        let (path, points) = (args.output.display(), point_count(&groups));
        say!("{path}: {} runs of fibers, {points} points", fibers.len());
        if format == Format::Bcc {
            say!("{}: their radii, yarns and plies", side_file(&args.output).display());
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

fn write(path: &Path, format: Format, groups: &[FiberGroup<'_>], common: &Common) -> Result<(), Error> {
    let passes = if format == Format::Usda { USDA_PASSES } else { 1 };
    let bar = task_bar(common, "writing", Some(passes * point_count(groups)));
    let progress = |points: u64| bar.inc(points);
    match format {
        Format::Bcc => write_fiber_bcc(path, groups, &progress)?,
        Format::Usda => write_usda(path, groups, &progress)?,
    }
    bar.finish_and_clear();
    Ok(())
}
