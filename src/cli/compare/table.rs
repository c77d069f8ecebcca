//! The figures as a person reads them.

use super::{Light, Report};
use crate::metrics::error::RegionError;
use crate::metrics::noise::{Noise, RegionNoise};
use std::fmt::Write;

const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// Lines of text, each ended.
pub(super) fn table(report: &Report) -> String {
    let [width, height] = report.size;
    let mut text = format!("{} against {}, {width} x {height} pixels\n\n", report.test, report.reference);
    row(&mut text, "", ["covered".into(), "all pixels".into()]);
    errors(&mut text, [&report.error.covered, &report.error.whole]);
    if let Some(noise) = &report.noise {
        noises(&mut text, noise);
    }
    text.push('\n');
    let mut lines = Vec::new();
    if let Some(noise) = &report.noise {
        lines.push(verdict(noise));
    }
    if let Some(shown) = &report.shown {
        lines.push(format!(
            "FLIP of what a display shows of an EXR: {} stops, tone curve {}, over black",
            shown.exposure_stops, shown.tone
        ));
    }
    if report.light == Light::Radiance {
        lines.push("squared errors of linear radiance, as it is".into());
    }
    lines
        .extend(report.not_measured.iter().map(|(what, why)| format!("not measured: {what}, because {why}")));
    lines.extend(report.notes.iter().map(|note| format!("note: {note}")));
    for line in lines {
        text.push_str(&line);
        text.push('\n');
    }
    text
}

/// A name and what it is over either set of pixels, in columns.
fn row(text: &mut String, name: &str, values: [String; 2]) {
    let [covered, whole] = values;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}", format!("{name:<16}{covered:>24}{whole:>24}").trim_end());
}

fn errors(text: &mut String, regions: [&RegionError; 2]) {
    let mut figure = |name: &str, of: &dyn Fn(&RegionError) -> String| row(text, name, regions.map(of));
    figure("pixels", &|r| r.pixels.to_string());
    figure("FLIP, mean", &|r| format!("{:.4}", r.flip_mean));
    figure("FLIP, largest", &|r| format!("{:.4}", r.flip_max));
    figure("MSE", &|r| format!("{:.3e}", r.mse));
    figure("relative MSE", &|r| format!("{:.3e}", r.relative_mse));
    figure("PSNR, dB", &|r| {
        if r.psnr_db.is_finite() { format!("{:.2}", r.psnr_db) } else { "infinite".into() }
    });
}

fn noises(text: &mut String, noise: &Noise) {
    let regions = [&noise.covered, &noise.whole];
    let mut figure = |name: &str, of: &dyn Fn(&RegionNoise) -> String| row(text, name, regions.map(of));
    figure("noise", &|r| format!("{:.3e}", r.variance));
    figure("bias squared", &|r| format!("{:.3e} +- {:.1e}", r.bias_squared, r.bias_squared_error));
    figure("bias, RMS", &|r| format!("{:.3e}", r.bias_squared.max(0.0).sqrt()));
}

fn verdict(noise: &Noise) -> String {
    let blocks = &noise.blocks;
    let [x, y] = blocks.largest_at;
    format!(
        "{}: in {} blocks of {side} x {side} pixels the mean difference is at most {:+.1} standard errors, in {} at \
         pixel ({x}, {y}); beyond {:.1} is no chance, and beyond 3 lie {:.2}% (0.27% by chance)",
        if blocks.differs { "the pictures differ" } else { "no difference but noise was found" },
        blocks.count,
        blocks.largest_z,
        CHANNELS[blocks.largest_channel % CHANNELS.len()],
        blocks.limit,
        100.0 * blocks.beyond_3,
        side = blocks.side,
    )
}
