//! `worsted knit`.

use super::args::{Knit, Pattern, Stockinette};
use crate::error::Error;
use crate::io::bcc::write_bcc;
use crate::io::whole::check_target;
use crate::knit::stockinette::{StockinetteParams, stockinette};
use crate::yarn::presets;

/// Generates a fabric and writes it.
///
/// # Errors
/// Parameters that give no sound fabric; a file that cannot be written.
pub fn run(args: &Knit) -> Result<(), Error> {
    match &args.pattern {
        Pattern::Stockinette(args) => {
            if args.output.extension().is_none_or(|e| !e.eq_ignore_ascii_case("bcc")) {
                let message = format!("-o {}: expected a name ending in .bcc", args.output.display());
                return Err(Error::Arguments(message));
            }
            check_target(&args.output)?;
            let curves = stockinette(&params(args))?;
            write_bcc(&args.output, &curves)?;
        }
    }
    Ok(())
}

fn params(args: &Stockinette) -> StockinetteParams {
    let default = StockinetteParams::default();
    let preset_mm = || presets::yarn(presets::DEFAULT_YARN).map(|yarn| yarn.outer_radius_mm());
    StockinetteParams {
        courses: args.courses,
        wales: args.wales,
        yarn_radius_mm: args.yarn_radius.or_else(preset_mm).unwrap_or(default.yarn_radius_mm),
        wale_spacing_mm: args.wale_spacing,
        course_spacing_mm: args.course_spacing,
        points_per_loop: args.points_per_loop.unwrap_or(default.points_per_loop),
    }
}
