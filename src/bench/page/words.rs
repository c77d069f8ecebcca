//! What the figures say, in sentences that follow from them.

use crate::bench::report::{Cell, Report};
use crate::bench::settings::DEFAULT;

/// Above the table of approximations.
pub const BLAME: &str = "Each approximation left out of the default by itself (\"that one off\": default against \
                         default without it), and added by itself to a picture without any of its kind (\"that one \
                         alone\"). FLIP above 0: it costs error. Time below x 1: it saves time. The first three \
                         simplify; the others dim light, so that they cost time and save error.";

/// `2.4 s`, `38 ms`, `0.52 ms`.
pub fn milliseconds(ms: f64) -> String {
    if ms >= 1000.0 { format!("{} s", significant(1e-3 * ms)) } else { format!("{} ms", significant(ms)) }
}

/// Two digits or more, no zeros behind a point.
fn significant(value: f64) -> String {
    let digits = if value >= 10.0 {
        0
    } else if value >= 1.0 {
        1
    } else {
        2
    };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// With a capital first letter.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The page's first sentences.
pub fn lead(report: &Report) -> Vec<String> {
    let date = report.head.date.get(..10).unwrap_or(&report.head.date);
    let about = format!(
        "How far Worsted's pictures are from the traced reference (FLIP, 0 is equal), and what they take, on {}, {date}.",
        report.head.device
    );
    vec![about, standing(report)]
}

/// Whether the default is on the fronts, and what beats it.
pub fn standing(report: &Report) -> String {
    let views: Vec<&str> = report.views.iter().map(|view| view.name.as_str()).collect();
    let beaten: Vec<String> = views.iter().filter_map(|view| beaten_by(report, view)).collect();
    let on = views.iter().filter(|view| is_default_on(report, view)).count();
    if beaten.is_empty() && on == views.len() {
        return "The default lies on the front of every view: no other settings were both faster and more accurate."
            .into();
    }
    let beaten = beaten.join("; ");
    format!("The default lies on the front of {on} of {} views; {beaten}.", views.len())
}

fn is_default_on(report: &Report, view: &str) -> bool {
    report.front(view).iter().any(|cell| cell.setting.name == DEFAULT)
}

/// The front's picture that is the most accurate of those that beat the default.
fn beaten_by(report: &Report, view: &str) -> Option<String> {
    let default = report.cell(view, DEFAULT)?;
    let ms = |cell: &Cell| cell.time(&report.head).median;
    let front = report.front(view);
    let better = front.iter().filter(|cell| cell.flip <= default.flip && ms(cell) <= ms(default));
    let best = better.filter(|cell| cell.setting.name != DEFAULT).min_by(|a, b| a.flip.total_cmp(&b.flip))?;
    let faster = 100.0 * (1.0 - ms(best) / ms(default));
    let less = default.flip - best.flip;
    Some(format!(
        "in the {view} view \"{}\" is {faster:.0}% faster and errs by {less:.4} less",
        best.setting.name
    ))
}

/// What the default, the fastest and the most accurate do in a view.
pub fn view_line(report: &Report, view: &str) -> String {
    let figures =
        |cell: &Cell| format!("FLIP {:.3} in {}", cell.flip, milliseconds(cell.time(&report.head).median));
    let facts = report.views.iter().find(|facts| facts.name == view);
    let width =
        facts.map_or_else(String::new, |facts| format!(" (a fiber is {:.2} pixels wide)", facts.fiber_px));
    let mut line = match report.cell(view, DEFAULT) {
        None => format!("{}{width}: the default was not measured.", capital(view)),
        Some(default) => {
            let noise = default.floor_flip.map_or_else(String::new, |flip| {
                format!("; noise alone would make {flip:.3} of a perfect picture of as many samples")
            });
            format!("{}{width}: the default errs by {}{noise}.", capital(view), figures(default))
        }
    };
    let front = report.front(view);
    if let (Some(fastest), Some(best)) = (front.first(), front.last()) {
        line += &format!(
            " On the front are {} of {} settings, from \"{}\", {}, to \"{}\", {}.",
            front.len(),
            report.cells_of(view).count(),
            fastest.setting.name,
            figures(fastest),
            best.setting.name,
            figures(best)
        );
    }
    line
}

/// What the errors are.
pub fn errors(report: &Report) -> String {
    format!(
        "FLIP: mean LDR-FLIP at 67 pixels per degree over the pixels that yarn covers in either picture, against every \
         fiber traced with {} samples a pixel. Floor: the same of another traced picture with as many samples as the \
         settings have. MSE: on linear radiance, over the same pixels.",
        report.head.reference_samples
    )
}

/// How it was measured.
pub fn method(report: &Report) -> Vec<String> {
    let mut lines = vec![
        format!("Times: {}; the median after a picture to warm up.", report.head.timing_method),
        "References: every fiber, loop and hair traced with shadows by single fibers and no light handed on."
            .into(),
    ];
    let coarse = report.views.iter().filter(|view| view.chord_error > 0.1);
    lines.extend(coarse.map(|view| {
        format!(
            "The reference of the {} view is of straight pieces that depart from fibers by up to {} of their radius, \
             so that it fits into memory.",
            view.name, view.chord_error
        )
    }));
    if let Some(cell) = report.cells.first() {
        lines.push(format!(
            "The scene: {} control points; {} fiber curves (pieces of yarn times fibers; what Wu & Yuksel 2019 call \
             fiber segments is 56 for each control point, so curves).",
            cell.counts.control_points, cell.counts.fiber_curves
        ));
    }
    lines
}

/// The same for a terminal: what the views say, and how the default stands.
pub fn summary(report: &Report) -> String {
    let mut lines: Vec<String> = report.views.iter().map(|view| view_line(report, &view.name)).collect();
    lines.push(standing(report));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::report::sample;

    #[test]
    fn sentences_follow_the_figures() {
        let mut report = sample();
        let said = [lead(&report).join("\n"), view_line(&report, "close")].join("\n");
        for part in [
            "FLIP 0.200 in 100 ms",
            "make 0.060",
            "2 of 3 settings",
            "from \"rough",
            "to \"better\", FLIP 0.150",
        ] {
            assert!(said.contains(part), "{part}: {said}");
        }
        assert!(said.contains("\"better\" is 20% faster and errs by 0.0500 less"), "{said}");
        report.cells.remove(1);
        assert!(standing(&report).contains("lies on the front of every view"));
        report.cells.remove(0);
        assert!(view_line(&report, "close").contains("default was not measured"));
    }

    #[test]
    fn times_are_short() {
        let said = [0.523, 4.0, 38.4, 950.0, 1000.0, 2449.0, 20_000.0].map(milliseconds);
        assert_eq!(said, ["0.52 ms", "4 ms", "38 ms", "950 ms", "1 s", "2.4 s", "20 s"]);
    }
}
