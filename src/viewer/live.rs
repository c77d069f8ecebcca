//! What the last picture took, what it is made of, and what it did without.

use super::canvas::Judged;
use super::desk::Look;
use super::painter::Shown;
use crate::shaders::ShaderSet;
use egui_plot::{Line, Plot, PlotPoints, Points};

/// The panel of figures.
pub struct Live {
    /// Whether it is shown.
    pub is_open: bool,
    counted: bool,
    samples: u32,
    shaders: ShaderSet,
}

impl Default for Live {
    fn default() -> Self {
        Self { is_open: true, counted: false, samples: 0, shaders: ShaderSet::default() }
    }
}

impl Live {
    /// Whether pictures are to be drawn otherwise than the last time that somebody asked.
    pub fn look_changed(&mut self, look: &Look) -> bool {
        let now = (look.statistics, look.most_samples, &look.shaders);
        let changed = now != (self.counted, self.samples, &self.shaders);
        (self.counted, self.samples, self.shaders) =
            (look.statistics, look.most_samples, look.shaders.clone());
        changed
    }

    /// Shows the figures, and errors against another picture, the last one at the end.
    pub fn show(ui: &mut egui::Ui, shown: Option<&Shown>, judged: &[Judged], statistics: &mut bool) {
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
            plot(ui, judged, last);
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

/// Error against time of the pictures that were compared, the last one marked.
fn plot(ui: &mut egui::Ui, judged: &[Judged], last: &Judged) {
    ui.separator();
    ui.label("FLIP against milliseconds");
    row(ui, "FLIP", format!("{:.4} at {} samples", last.flip, last.samples));
    let point = |judged: &Judged| [judged.ms, judged.flip];
    let points: PlotPoints<'_> = judged.iter().map(point).collect();
    let now = PlotPoints::from(vec![point(last)]);
    Plot::new("error").height(140.0).allow_scroll(false).include_x(0.0).include_y(0.0).show(ui, |plot| {
        plot.line(Line::new("before", points));
        plot.points(Points::new("now", now).radius(5.0));
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
