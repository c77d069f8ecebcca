//! What the last picture took, what it is made of, and what it did without.

use super::canvas::Judged;
use super::desk::Look;
use super::painter::Shown;
use super::references::Known;
use crate::metrics::error_vs_time::{Outcome, front};
use egui_plot::{Line, Plot, PlotPoints, Points, uniform_grid_spacer};

/// The panel of figures.
pub struct Live {
    /// Whether it is shown.
    pub is_open: bool,
    look: Option<Look>,
}

impl Default for Live {
    fn default() -> Self {
        Self { is_open: true, look: None }
    }
}

impl Live {
    /// Whether pictures are to be drawn otherwise than the last time that somebody asked.
    pub fn look_changed(&mut self, look: &Look) -> bool {
        let changed = self.look.as_ref() != Some(look);
        if changed {
            self.look = Some(look.clone());
        }
        changed
    }

    /// Shows the figures, errors against another picture, the last one at the end, and what is known of other ways to
    /// draw the scene.
    pub fn show(
        ui: &mut egui::Ui,
        shown: Option<&Shown>,
        (judged, known): (&[Judged], Option<&[Known]>),
        statistics: &mut bool,
    ) {
        ui.heading("Picture");
        ui.checkbox(statistics, "count fibers").on_hover_text("Counting takes time of its own");
        let Some(shown) = shown else { return };
        let stats = &shown.stats;
        let state = match (shown.own_tables, shown.settled) {
            (false, _) => "tables of the scene before; its own are being baked",
            (true, false) => "being refined",
            (true, true) => "settled",
        };
        ui.label(format!("{} on {}", state, stats.device));
        let [width, height] = stats.size;
        row(ui, "pixels", format!("{width} x {height}"));
        row(ui, "samples", stats.samples.to_string());
        row(ui, "drawn in", format!("{:.1} ms", stats.frame_ms.median));
        row(ui, "after the edit", format!("{:.0} ms", 1e3 * shown.delay.as_secs_f64()));
        row(ui, "control points", grouped(stats.control_points));
        let counts = [
            ("pieces drawn", stats.patches_drawn),
            ("pieces culled", stats.patches_culled),
            ("fiber pieces", stats.fiber_segments),
            ("triangles", stats.triangles),
            ("cut too coarsely", stats.patches_coarse),
        ];
        for (what, count) in counts {
            if let Some(count) = count {
                row(ui, what, grouped(count));
            }
        }
        row(ui, "fibers of yarn", grouped(stats.fiber_curves));
        let bytes: u64 = stats.gpu_bytes.values().sum();
        row(ui, "on the device", format!("{:.1} MB", bytes as f64 / 1e6));
        for note in &shown.notes {
            ui.label(egui::RichText::new(note).weak());
        }
        if let Some(last) = judged.last() {
            plot(ui, (judged, known), last);
        }
        ui.separator();
        ui.collapsing("Left out", |ui| {
            for (what, why) in stats.left_out.iter().chain(&stats.left_out_of_frame) {
                ui.label(format!("{what}: {why}"));
            }
        });
        ui.collapsing("Tables", |ui| {
            for (what, ms) in &stats.precompute_ms {
                let cached = if stats.precompute_from_cache.contains(what) { ", read" } else { "" };
                row(ui, what, format!("{ms:.0} ms{cached}"));
            }
        });
        ui.collapsing("Memory", |ui| {
            for (what, bytes) in &stats.gpu_bytes {
                row(ui, what, format!("{:.2} MB", *bytes as f64 / 1e6));
            }
        });
    }
}

/// Error against time of the pictures that were compared, the last one marked, among what is known of other settings.
fn plot(ui: &mut egui::Ui, (judged, known): (&[Judged], Option<&[Known]>), last: &Judged) {
    ui.separator();
    ui.label("FLIP against milliseconds");
    row(ui, "FLIP", format!("{:.4} at {} samples", last.flip, last.samples));
    if known.is_some_and(<[_]>::is_empty) {
        ui.label(egui::RichText::new("no other settings: none were measured of this look").weak());
    }
    let known = known.unwrap_or_default();
    let outcomes: Vec<Outcome> =
        known.iter().map(|known| Outcome { error: known.flip, time: known.ms }).collect();
    // Times of settings lie decades apart.
    let place = |ms: f64, flip: f64| [ms.max(1e-3).log10(), flip];
    let of_judged = |judged: &Judged| place(judged.ms, judged.flip);
    let before: PlotPoints<'_> = judged.iter().map(of_judged).collect();
    let now = PlotPoints::from(vec![of_judged(last)]);
    let decades = |mark: egui_plot::GridMark, _: &_| match mark.value {
        value if value.fract() == 0.0 => format!("{:.0}", 10.0_f64.powf(value)),
        _ => String::new(),
    };
    Plot::new("error")
        .height(160.0)
        .allow_scroll(false)
        .include_y(0.0)
        .x_grid_spacer(uniform_grid_spacer(|_| [1.0, 0.5, 0.1]))
        .x_axis_formatter(decades)
        .show(ui, |plot| {
            let best = front(&outcomes).into_iter().map(|i| place(outcomes[i].time, outcomes[i].error));
            let best: PlotPoints<'_> = best.collect();
            plot.line(Line::new("best of those measured", best).color(egui::Color32::GRAY));
            for other in known {
                let point = PlotPoints::from(vec![place(other.ms, other.flip)]);
                let shown = Points::new(&other.name, point).radius(3.0).filled(false);
                plot.points(shown.color(egui::Color32::GRAY));
            }
            plot.points(Points::new("before", before).radius(2.0).color(egui::Color32::LIGHT_BLUE));
            plot.points(Points::new("now", now).radius(5.0).color(egui::Color32::YELLOW));
        });
}

fn row(ui: &mut egui::Ui, what: &str, value: String) {
    ui.horizontal(|ui| {
        ui.label(what);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.monospace(value));
    });
}

/// A count with its thousands apart.
fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let head = digits.len() % 3;
    let mut groups: Vec<&str> = Vec::new();
    if head > 0 {
        groups.push(&digits[..head]);
    }
    groups.extend((head..digits.len()).step_by(3).map(|at| &digits[at..at + 3]));
    groups.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_stand_apart() {
        let counts = [(0, "0"), (7, "7"), (999, "999"), (1000, "1 000"), (1_234_567, "1 234 567")];
        assert!(counts.iter().all(|(count, text)| grouped(*count) == *text));
    }
}
