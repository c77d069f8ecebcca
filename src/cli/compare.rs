//! `worsted compare`.

mod table;

use super::args::{Common, Compare, ShownTone};
use super::output::write_text;
use crate::cli::say;
use crate::error::Error;
use crate::io::error::{FileError, Place};
use crate::io::measured::MeasuredImage;
use crate::io::picture::{read_png, write_png};
use crate::io::whole::check_target;
use crate::math::tone::{Display, Tone};
use crate::metrics::MetricError;
use crate::metrics::error::{Comparison, PictureError, compare};
use crate::metrics::noise::{Noise, separate};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Most stops up or down, as a scene file's `display.exposure_stops`.
const MOST_STOPS: f64 = 30.0;

/// The figures, with all that is needed to know what they are of. Where two pictures are equal, `psnr_db` is
/// infinite: null in JSON.
#[derive(Debug, Serialize)]
struct Report {
    test: String,
    reference: String,
    size: [u32; 2],
    /// What an EXR is shown by; null where both pictures are PNGs.
    shown: Option<Shown>,
    /// What squared errors are of.
    light: Light,
    #[serde(flatten)]
    error: PictureError,
    noise: Option<Noise>,
    /// What there is no figure for, and why.
    not_measured: BTreeMap<&'static str, String>,
    notes: Vec<String>,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct Shown {
    exposure_stops: f64,
    tone: &'static str,
}

/// What squared errors are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Light {
    /// Linear radiance.
    Radiance,
    /// Light that a display gives, linear in 0 to 1: all that a PNG knows.
    Displayed,
}

/// A picture as its file holds it.
struct Input<'a> {
    path: &'a Path,
    image: MeasuredImage,
    /// Whether it holds what was shown and not radiance.
    displayed: bool,
}

/// Compares, writes, judges.
///
/// # Errors
/// Files that cannot be read or written, pictures that cannot be compared, arguments that make no sense; a mean
/// FLIP above `--fail-above`.
pub fn run(args: &Compare, common: &Common) -> Result<(), Error> {
    check(args)?;
    let inputs = [read(&args.test)?, read(&args.reference)?];
    let display = display(args, &inputs)?;
    let (report, comparison) = judge(args, inputs, display)?;
    if let Some(path) = &args.heatmap {
        write_png(path, &comparison.flip.heatmap())?;
    }
    if let Some(path) = &args.json {
        let text =
            serde_json::to_string_pretty(&report).map_err(|e| Error::Failed(format!("figures: {e}")))?;
        write_text(path, &text)?;
    }
    if !common.quiet && args.json.as_deref() != Some(Path::new("-")) {
        say::print(format_args!("{}", table::table(&report)));
    }
    let flip = comparison.error.covered.flip_mean;
    match args.fail_above {
        Some(limit) if flip > limit => Err(Error::Failed(format!(
            "{} against {}: mean FLIP {flip:.5} over the covered pixels is above {limit}",
            args.test.display(),
            args.reference.display()
        ))),
        _ => Ok(()),
    }
}

/// What can be told to be wrong before any picture is read.
fn check(args: &Compare) -> Result<(), Error> {
    if let Some(limit) = args.fail_above.filter(|limit| !(0.0..=1.0).contains(limit)) {
        return Err(Error::Arguments(format!("--fail-above {limit}: expected a mean FLIP from 0 to 1")));
    }
    if let Some(stops) = args.exposure.filter(|stops| !(-MOST_STOPS..=MOST_STOPS).contains(stops)) {
        let message = format!("--exposure {stops}: expected -{MOST_STOPS} to {MOST_STOPS} stops");
        return Err(Error::Arguments(message));
    }
    if let Some(path) = &args.heatmap {
        if extension(path).as_deref() != Some("png") {
            let message = format!("--heatmap {}: expected a name ending in .png", path.display());
            return Err(Error::Arguments(message));
        }
        check_target(path)?;
    }
    if let Some(path) = args.json.as_deref().filter(|path| *path != Path::new("-")) {
        check_target(path)?;
    }
    Ok(())
}

fn extension(path: &Path) -> Option<String> {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase())
}

fn read(path: &Path) -> Result<Input<'_>, Error> {
    match extension(path).as_deref() {
        Some("exr") => Ok(Input { path, image: MeasuredImage::read(path)?, displayed: false }),
        Some("png") => {
            let image = MeasuredImage { mean: read_png(path)?.light(), variance: None };
            Ok(Input { path, image, displayed: true })
        }
        _ => {
            Err(FileError::new(path, Place::File, "expected a picture's name ending in .exr or .png").into())
        }
    }
}

/// How EXRs are shown.
fn display(args: &Compare, inputs: &[Input<'_>; 2]) -> Result<Display, Error> {
    let both_displayed = inputs.iter().all(|input| input.displayed);
    if both_displayed && (args.exposure.is_some() || args.tone.is_some()) {
        let message = "--exposure, --tone: expected an EXR among the pictures, since a PNG is what was shown";
        return Err(Error::Arguments(message.into()));
    }
    let tone = args.tone.map_or_else(Tone::default, |tone| match tone {
        ShownTone::Neutral => Tone::Neutral,
        ShownTone::Filmic => Tone::Filmic,
        ShownTone::Clamp => Tone::Clamp,
    });
    Ok(Display { exposure: args.exposure.unwrap_or(0.0).exp2(), tone })
}

fn tone_name(tone: Tone) -> &'static str {
    match tone {
        Tone::Neutral => "neutral",
        Tone::Filmic => "filmic",
        Tone::Clamp => "clamp",
    }
}

/// The figures of two pictures.
fn judge(args: &Compare, inputs: [Input<'_>; 2], display: Display) -> Result<(Report, Comparison), Error> {
    let about = About::new(&inputs);
    let displayed = inputs.iter().any(|input| input.displayed);
    let both_displayed = inputs.iter().all(|input| input.displayed);
    let [test, reference] = if displayed { shown(inputs, &display)? } else { inputs };
    let seen_by = if displayed { Display::PLAIN } else { display };
    // Names both files: the error says which of them it is about.
    let failed = |error: MetricError| {
        let (test, reference) = (test.path.display(), reference.path.display());
        Error::Arguments(format!("{test} against {reference}: {error}"))
    };
    let comparison = compare(&test.image.mean, &reference.image.mean, &seen_by).map_err(failed)?;
    let noise = separate(&test.image, &reference.image).map_err(failed)?;
    let shown = Shown { exposure_stops: args.exposure.unwrap_or(0.0), tone: tone_name(display.tone) };
    let report = Report {
        test: test.path.display().to_string(),
        reference: reference.path.display().to_string(),
        size: [test.image.mean.width, test.image.mean.height],
        shown: (!both_displayed).then_some(shown),
        light: if displayed { Light::Displayed } else { Light::Radiance },
        error: comparison.error,
        noise,
        not_measured: about.not_measured,
        notes: about.notes,
    };
    Ok((report, comparison))
}

/// The light that a display gives of both pictures, one of which holds nothing else.
fn shown<'a>(inputs: [Input<'a>; 2], display: &Display) -> Result<[Input<'a>; 2], Error> {
    let light = |input: Input<'a>| -> Result<Input<'a>, Error> {
        let mean = match input.displayed {
            true => input.image.mean,
            false => {
                let failed = |e| Error::Arguments(format!("{}: {e}", input.path.display()));
                input.image.mean.shown(display).map_err(failed)?
            }
        };
        Ok(Input { image: MeasuredImage { mean, variance: None }, displayed: true, ..input })
    };
    let [test, reference] = inputs;
    Ok([light(test)?, light(reference)?])
}

/// What must be known to read the figures.
struct About {
    not_measured: BTreeMap<&'static str, String>,
    notes: Vec<String>,
}

impl About {
    fn new(inputs: &[Input<'_>; 2]) -> Self {
        let (mut not_measured, mut notes) = (BTreeMap::new(), Vec::new());
        for input in inputs.iter().filter(|i| i.image.mean.pixels.iter().all(|pixel| pixel[3] == 1.0)) {
            let path = input.path.display();
            notes.push(format!("{path} states no empty background: all of it counts as covered"));
        }
        if inputs.iter().any(|input| input.displayed) {
            let why = "a PNG holds what was shown, in 8 bits";
            not_measured.insert("bias and noise", why.to_owned());
            not_measured.insert("radiance", format!("{why}; squared errors are of the light shown"));
            if inputs.iter().any(|input| !input.displayed) {
                notes.push("a PNG is taken with what lies behind its yarn, an EXR over black".to_owned());
            }
        } else if inputs.iter().all(|input| input.image.variance.is_none()) {
            let why = "neither picture states the variance of its pixels";
            not_measured.insert("bias and noise", why.to_owned());
        } else {
            for input in inputs.iter().filter(|input| input.image.variance.is_none()) {
                let path = input.path.display();
                notes.push(format!("{path} states no variance: what noise it has counts as bias"));
            }
        }
        Self { not_measured, notes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::file::DisplayTable;

    #[test]
    fn pictures_are_shown_as_a_scene_is_that_says_nothing_of_it() {
        let scene = serde_json::to_value(DisplayTable::default()).unwrap();
        assert_eq!(scene["tone"], tone_name(Tone::default()));
        assert_eq!(scene["exposure_stops"], 0.0);
        assert_eq!(Display::default().exposure, 1.0);
    }
}
