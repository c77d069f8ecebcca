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

/// Share of an error up to which another is the same: a reference with a quarter of the samples moves one by 1.5%.
const SAME_ERROR: f64 = 0.01;
/// Share of a time from which on another is worth a word where errors are the same.
const MUCH_FASTER: f64 = 0.1;

/// Whether the default is on the fronts, as far as errors can be told apart, and what beats it.
pub fn standing(report: &Report) -> String {
    let views: Vec<&str> = report.views.iter().map(|view| view.name.as_str()).collect();
    let of_views = |say: fn(&Report, &str) -> Option<String>| -> Vec<String> {
        views.iter().filter_map(|view| say(report, view)).collect()
    };
    let (beaten, equalled) = (of_views(beaten_by), of_views(equalled_by));
    let measured = views.iter().filter(|view| report.cell(view, DEFAULT).is_some()).count();
    let told_apart = format!("where errors differ by more than {:.0}%", 100.0 * SAME_ERROR);
    let mut said = if beaten.is_empty() && measured == views.len() {
        format!(
            "The default lies on the front of every view: no other settings were both faster and more accurate, \
             {told_apart}."
        )
    } else {
        let on = measured - beaten.len();
        let beaten = beaten.join("; ");
        format!("The default lies on the front of {on} of {} views, {told_apart}; {beaten}.", views.len())
    };
    if !equalled.is_empty() {
        said += &format!(" {}.", capital(&equalled.join("; ")));
    }
    said
}

/// The most accurate picture that is faster than the default and better by more than can be overlooked.
fn beaten_by(report: &Report, view: &str) -> Option<String> {
    let default = report.cell(view, DEFAULT)?;
    let better = faster(report, view, default).filter(|cell| cell.flip < (1.0 - SAME_ERROR) * default.flip);
    let best = better.min_by(|a, b| a.flip.total_cmp(&b.flip))?;
    Some(format!(
        "in the {view} view \"{}\" is {:.0}% faster and errs by {:.4} less",
        best.setting.name,
        100.0 * spared(report, default, best),
        default.flip - best.flip
    ))
}

/// The fastest picture that is much faster than the default and as good.
fn equalled_by(report: &Report, view: &str) -> Option<String> {
    let default = report.cell(view, DEFAULT)?;
    let same = |cell: &&Cell| (cell.flip - default.flip).abs() <= SAME_ERROR * default.flip;
    let equal = faster(report, view, default).filter(same);
    let best = equal.max_by(|a, b| spared(report, default, a).total_cmp(&spared(report, default, b)))?;
    let spared = spared(report, default, best);
    (spared >= MUCH_FASTER).then(|| {
        let name = &best.setting.name;
        format!(
            "in the {view} view \"{name}\" errs as much as the default and is {:.0}% faster",
            100.0 * spared
        )
    })
}

fn faster<'a>(report: &'a Report, view: &'a str, default: &'a Cell) -> impl Iterator<Item = &'a Cell> {
    let others = report.cells_of(view).filter(|cell| cell.setting.name != DEFAULT);
    others.filter(move |cell| spared(report, default, cell) >= 0.0)
}

/// Share of the default's time that other settings spare.
fn spared(report: &Report, default: &Cell, cell: &Cell) -> f64 {
    1.0 - cell.time(&report.head).median / default.time(&report.head).median
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
        let better = report.cells.iter().position(|cell| cell.setting.name == "better").unwrap();
        let default = report.cell("close", DEFAULT).unwrap().flip;
        report.cells[better].flip = 0.995 * default;
        let said = standing(&report);
        assert!(said.contains("lies on the front of every view"), "{said}");
        assert!(said.contains("\"better\" errs as much as the default and is 20% faster"), "{said}");
        report.cells.remove(1);
        let said = standing(&report);
        assert!(said.contains("lies on the front of every view") && !said.contains("as much"), "{said}");
        report.cells.remove(0);
        assert!(view_line(&report, "close").contains("default was not measured"));
    }

    #[test]
    fn times_are_short() {
        let said = [0.523, 4.0, 38.4, 950.0, 1000.0, 2449.0, 20_000.0].map(milliseconds);
        assert_eq!(said, ["0.52 ms", "4 ms", "38 ms", "950 ms", "1 s", "2.4 s", "20 s"]);
    }
}
