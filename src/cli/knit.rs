//! `worsted knit`.

use super::args::{Knit, Knitting, Pattern};
use crate::error::Error;
use crate::io::bcc::write_bcc;
use crate::io::curves::CurveSet;
use crate::io::whole::check_target;
use crate::knit::error::KnitError;
use crate::knit::stockinette::{StockinetteParams, stockinette};
use crate::knit::tube::{TubeParams, tube};
use crate::yarn::presets;

/// Generates a fabric and writes it.
///
/// # Errors
/// Parameters that give no sound fabric; a file that cannot be written.
pub fn run(args: &Knit) -> Result<(), Error> {
    match &args.pattern {
        Pattern::Stockinette(args) => {
            let default = StockinetteParams::default();
            let knitting = &args.knitting;
            let params = StockinetteParams {
                courses: args.courses,
                wales: args.wales,
                yarn_radius_mm: yarn_radius_mm(knitting, default.yarn_radius_mm),
                wale_spacing_mm: knitting.wale_spacing,
                course_spacing_mm: knitting.course_spacing,
                points_per_loop: knitting.points_per_loop.unwrap_or(default.points_per_loop),
            };
            write(knitting, || stockinette(&params))
        }
        Pattern::Tube(args) => {
            let default = TubeParams::default();
            let knitting = &args.knitting;
            let params = TubeParams {
                courses: args.courses,
                wales: args.wales,
                yarn_radius_mm: yarn_radius_mm(knitting, default.yarn_radius_mm),
                wale_spacing_mm: knitting.wale_spacing,
                course_spacing_mm: knitting.course_spacing,
                points_per_loop: knitting.points_per_loop.unwrap_or(default.points_per_loop),
            };
            write(knitting, || tube(&params))
        }
    }
}

/// Writes what `make` knits, if it can be written at all.
fn write(args: &Knitting, make: impl FnOnce() -> Result<CurveSet, KnitError>) -> Result<(), Error> {
    if args.output.extension().is_none_or(|e| !e.eq_ignore_ascii_case("bcc")) {
        let message = format!("-o {}: expected a name ending in .bcc", args.output.display());
        return Err(Error::Arguments(message));
    }
    check_target(&args.output)?;
    write_bcc(&args.output, &make()?)?;
    Ok(())
}

/// The radius asked for, or that of the default yarn.
fn yarn_radius_mm(args: &Knitting, otherwise: f64) -> f64 {
    let preset_mm = || presets::yarn(presets::DEFAULT_YARN).map(|yarn| yarn.outer_radius_mm());
    args.yarn_radius.or_else(preset_mm).unwrap_or(otherwise)
}
