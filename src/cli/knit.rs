//! `worsted knit`.

use super::args::{Animate, Knit, Knitting, Pattern, Stockinette, Tube};
use crate::error::Error;
use crate::io::bcc::write_bcc;
use crate::io::curves::CurveSet;
use crate::io::gltf_write::write_gltf;
use crate::io::whole::check_target;
use crate::knit::error::KnitError;
use crate::knit::motion::{Dance, written};
use crate::knit::params::KnitParams;
use crate::knit::stockinette::stockinette;
use crate::knit::tube::tube;
use crate::yarn::presets;

/// Generates a fabric and writes it.
///
/// # Errors
/// Parameters that give no sound fabric; a file that cannot be written.
pub fn run(args: &Knit) -> Result<(), Error> {
    match &args.pattern {
        Pattern::Stockinette(Stockinette { courses, wales, knitting }) => {
            write(knitting, || stockinette(&params(*courses, *wales, knitting)))
        }
        Pattern::Tube(Tube { courses, wales, knitting }) => {
            write(knitting, || tube(&params(*courses, *wales, knitting)))
        }
    }
}

/// What was asked for, the rest as every pattern has it by default.
fn params(courses: u32, wales: u32, args: &Knitting) -> KnitParams {
    let default = KnitParams::swatch();
    KnitParams {
        courses,
        wales,
        yarn_radius_mm: yarn_radius_mm(args, default.yarn_radius_mm),
        wale_spacing_mm: args.wale_spacing,
        course_spacing_mm: args.course_spacing,
        points_per_loop: args.points_per_loop.unwrap_or(default.points_per_loop),
    }
}

/// Writes what `make` knits, if it can be written at all.
fn write(args: &Knitting, make: impl FnOnce() -> Result<CurveSet, KnitError>) -> Result<(), Error> {
    let extension = args.output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let wrong = |expected: &str| {
        Error::Arguments(format!("-o {}: expected a name ending in {expected}", args.output.display()))
    };
    let is_gltf = match extension.as_deref() {
        Some("gltf") => true,
        Some("bcc") if args.animate.is_some() => return Err(wrong(".gltf, which can move")),
        Some("bcc") => false,
        _ => return Err(wrong(".bcc or .gltf")),
    };
    check_target(&args.output)?;
    let set = make()?;
    if !is_gltf {
        return Ok(write_bcc(&args.output, &set)?);
    }
    let dance = args.animate.map(|animate| match animate {
        Animate::Stretch => Dance::Stretch,
        Animate::Wave => Dance::Wave,
        Animate::Bend => Dance::Bend,
    });
    let moves = dance.map(|dance| written(&set, dance));
    Ok(write_gltf(&args.output, &set, moves.as_ref())?)
}

/// The radius asked for, or that of the default yarn.
fn yarn_radius_mm(args: &Knitting, otherwise: f64) -> f64 {
    let preset_mm = || presets::yarn(presets::DEFAULT_YARN).map(|yarn| yarn.outer_radius_mm());
    args.yarn_radius.or_else(preset_mm).unwrap_or(otherwise)
}
