//! Error against something, both on logarithmic scales, as SVG.

use super::cell_id;
use crate::bench::report::{Cell, Report};
use crate::bench::settings::DEFAULT;
use crate::error::Error;
use maud::html;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::series::DashedLineSeries;

/// What error is plotted against.
pub struct Axis {
    /// Its title.
    title: String,
    /// A picture's value.
    value: fn(&Cell, &Report) -> f64,
    /// How a tick is labelled.
    label: fn(f64) -> String,
    /// Whether the front is of this and the error.
    is_time: bool,
}

impl Axis {
    /// Against time.
    pub fn time(report: &Report) -> Self {
        let title = format!("time of a picture ({})", report.head.timing_method);
        Self {
            title,
            value: |cell, report| cell.time(&report.head).median,
            label: super::words::milliseconds,
            is_time: true,
        }
    }

    /// Against device memory.
    pub const MEMORY: Self = Self {
        title: String::new(),
        value: |cell, _| cell.gpu_bytes as f64 / f64::from(1 << 20),
        label: |mib| format!("{mib} MiB"),
        is_time: false,
    };
}

const INK: RGBColor = RGBColor(0x22, 0x26, 0x2b);
const FAINT: RGBColor = RGBColor(0xe3, 0xe5, 0xe8);
const GREY: RGBColor = RGBColor(0x9a, 0xa1, 0xa9);
const ACCENT: RGBColor = RGBColor(0xb0, 0x3a, 0x2e);
/// Room around the outermost points, as a factor.
const ROOM: f64 = 1.35;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn failed(error: impl std::fmt::Display) -> Error {
    Error::Failed(format!("plot: {error}"))
}

/// The plot of a view, with a place to hover over for each of its pictures.
pub fn plot(report: &Report, view: &str, axis: &Axis, size: [u32; 2]) -> Result<String, Error> {
    let value = |cell: &Cell| (axis.value)(cell, report);
    let is_shown =
        |cell: &&Cell| cell.flip > 0.0 && value(cell) > 0.0 && (cell.flip * value(cell)).is_finite();
    let cells: Vec<&Cell> = report.cells_of(view).filter(is_shown).collect();
    let floor = report.cell(view, DEFAULT).and_then(|cell| cell.floor_flip).filter(|flip| *flip > 0.0);
    let ranges =
        [range(cells.iter().map(|cell| value(cell))), range(cells.iter().map(|cell| cell.flip).chain(floor))];
    let mut svg = String::new();
    let mut places = Vec::new();
    {
        let area = SVGBackend::with_string(&mut svg, (size[0], size[1])).into_drawing_area();
        area.fill(&WHITE).map_err(failed)?;
        let mut chart = ChartBuilder::on(&area)
            .margin_top(14)
            .margin_right(18)
            .x_label_area_size(44)
            .y_label_area_size(52)
            .build_cartesian_2d(log(ranges[0]), log(ranges[1]))
            .map_err(failed)?;
        draw_grid(&mut chart, &ranges, axis)?;
        draw_titles(&area, axis, size)?;
        if let Some(floor) = floor {
            let ends = [(ranges[0][0].log10(), floor.log10()), (ranges[0][1].log10(), floor.log10())];
            chart.draw_series(DashedLineSeries::new(ends, 5, 4, GREY.into())).map_err(failed)?;
        }
        let at = |cell: &Cell| (value(cell).log10(), cell.flip.log10());
        let grey = cells.iter().map(|cell| Circle::new(at(cell), 4, GREY.filled()));
        chart.draw_series(grey).map_err(failed)?;
        if axis.is_time {
            draw_front(&mut chart, &report.front(view), &at)?;
        }
        let default = cells.iter().filter(|cell| cell.setting.name == DEFAULT);
        let ring = default.map(|cell| Circle::new(at(cell), 9, INK.stroke_width(2)));
        chart.draw_series(ring).map_err(failed)?;
        places.extend(cells.iter().map(|cell| chart.backend_coord(&at(cell))));
        area.present().map_err(failed)?;
    }
    Ok(with_places(&svg, report, &cells, &places, axis))
}

fn log([low, high]: [f64; 2]) -> std::ops::Range<f64> {
    low.log10()..high.log10()
}

/// A range that holds all values with room around, at least a factor of 2.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let (low, high) =
        values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), v| (low.min(v), high.max(v)));
    if !(low.is_finite() && high > 0.0) {
        return [1.0, 10.0];
    }
    [low / ROOM, high * ROOM]
}

/// Round numbers within a range: 1, 2 and 5 times powers of ten, and some between where there is room.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let powers = (low.log10().floor() as i32)..=(high.log10().ceil() as i32);
    let tenths: &[u32] = if high < 10.0 * low { &[10, 15, 20, 30, 50, 70] } else { &[10, 20, 50] };
    // A decimal numeral read back has no rounding of its own to show in a label.
    let tick = |power: i32, tenth: &u32| format!("{tenth}e{}", power - 1).parse().unwrap_or(f64::NAN);
    let all = powers.flat_map(|power| tenths.iter().map(move |tenth| tick(power, tenth)));
    all.filter(|tick| (low..=high).contains(tick)).collect()
}

fn draw_grid(chart: &mut Chart<'_, '_>, ranges: &[[f64; 2]; 2], axis: &Axis) -> Result<(), Error> {
    let [x, y] = ranges.map(|[low, high]| [low.log10(), high.log10()]);
    let vertical = ticks(ranges[0]).into_iter().map(|t| vec![(t.log10(), y[0]), (t.log10(), y[1])]);
    let horizontal = ticks(ranges[1]).into_iter().map(|t| vec![(x[0], t.log10()), (x[1], t.log10())]);
    let lines = vertical.chain(horizontal).map(|ends| PathElement::new(ends, FAINT));
    chart.draw_series(lines).map_err(failed)?;
    let style =
        |h, v| ("sans-serif", 13).into_font().color(&INK).pos(plotters::style::text_anchor::Pos::new(h, v));
    use plotters::style::text_anchor::{HPos, VPos};
    let below = style(HPos::Center, VPos::Top);
    let beside = style(HPos::Right, VPos::Center);
    let area = chart.plotting_area().strip_coord_spec();
    let origin = area.get_base_pixel();
    let label = |place: (i32, i32), text: String, style: &TextStyle<'_>| {
        area.draw(&Text::new(text, (place.0 - origin.0, place.1 - origin.1), style.clone())).map_err(failed)
    };
    for t in ticks(ranges[0]) {
        let (px, py) = chart.backend_coord(&(t.log10(), y[0]));
        label((px, py + 6), (axis.label)(t), &below)?;
    }
    for t in ticks(ranges[1]) {
        let (px, py) = chart.backend_coord(&(x[0], t.log10()));
        label((px - 6, py), t.to_string(), &beside)?;
    }
    Ok(())
}

fn draw_titles(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    axis: &Axis,
    [width, height]: [u32; 2],
) -> Result<(), Error> {
    use plotters::style::text_anchor::{HPos, Pos, VPos};
    let style = ("sans-serif", 13).into_font().color(&INK);
    let title = if axis.is_time { axis.title.as_str() } else { "device memory" };
    let below = style.clone().pos(Pos::new(HPos::Center, VPos::Bottom));
    area.draw(&Text::new(title.to_owned(), (width as i32 / 2 + 20, height as i32 - 4), below))
        .map_err(failed)?;
    let beside = style.transform(FontTransform::Rotate270).pos(Pos::new(HPos::Center, VPos::Top));
    area.draw(&Text::new("error (FLIP)", (2, height as i32 / 2 - 10), beside)).map_err(failed)
}

/// The front's points, numbered, joined from the fastest to the most accurate.
fn draw_front(
    chart: &mut Chart<'_, '_>,
    front: &[&Cell],
    at: &dyn Fn(&Cell) -> (f64, f64),
) -> Result<(), Error> {
    let points: Vec<(f64, f64)> = front.iter().map(|cell| at(cell)).collect();
    chart.draw_series(LineSeries::new(points.iter().copied(), ACCENT.stroke_width(2))).map_err(failed)?;
    let dots = points.iter().map(|&point| Circle::new(point, 5, ACCENT.filled()));
    chart.draw_series(dots).map_err(failed)?;
    let style = ("sans-serif", 14).into_font().color(&ACCENT);
    let numbers = points.iter().enumerate().map(|(index, &point)| {
        EmptyElement::at(point) + Text::new((index + 1).to_string(), (7, -17), style.clone())
    });
    chart.draw_series(numbers).map_err(failed)?;
    Ok(())
}

/// The plot with an unseen disc over each picture's point, that says what it is.
fn with_places(svg: &str, report: &Report, cells: &[&Cell], places: &[(i32, i32)], axis: &Axis) -> String {
    let discs = html! {
        @for (cell, (x, y)) in cells.iter().zip(places) {
            circle class="hit" cx=(x) cy=(y) r="11" fill="transparent" tabindex="0" data-cell=(cell_id(report, cell)) {
                title {
                    (cell.setting.name) ": FLIP " (format!("{:.3}", cell.flip)) ", "
                    (super::words::milliseconds(cell.time(&report.head).median)) "\n" (cell.setting.as_options())
                }
            }
        }
    };
    let named = format!(
        "<svg role=\"img\" aria-label=\"error against {}\" ",
        if axis.is_time { "time" } else { "memory" }
    );
    let body = svg.trim_end().trim_end_matches("</svg>").replacen("<svg ", &named, 1);
    format!("{body}{}</svg>\n", discs.into_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::report::sample;

    #[test]
    fn ticks_are_round_and_within() {
        assert_eq!(ticks([0.04, 0.6]), [0.05, 0.1, 0.2, 0.5]);
        assert_eq!(ticks([900.0, 3500.0]), [1000.0, 1500.0, 2000.0, 3000.0]);
        assert_eq!(range([].into_iter()), [1.0, 10.0]);
    }

    #[test]
    fn every_point_is_within_the_plot_and_the_better_ones_are_lower() {
        let report = sample();
        let svg = plot(&report, "close", &Axis::time(&report), [400, 300]).unwrap();
        let number = |disc: &str, name: &str| -> f64 {
            let from = disc.split_once(&format!(" {name}=\"")).unwrap().1;
            from.split_once('"').unwrap().0.parse().unwrap()
        };
        let discs: Vec<[f64; 2]> = svg
            .split("<circle class=\"hit\"")
            .skip(1)
            .map(|disc| [number(disc, "cx"), number(disc, "cy")])
            .collect();
        assert_eq!(discs.len(), 3);
        assert!(
            discs.iter().all(|[x, y]| (52.0..382.0).contains(x) && (14.0..256.0).contains(y)),
            "{discs:?}"
        );
        let [default, better, rough] = [discs[0], discs[1], discs[2]];
        assert!(
            better[0] < default[0] && better[1] > default[1] && rough[0] < better[0] && rough[1] < default[1]
        );
    }

    #[test]
    fn what_cannot_be_on_a_logarithmic_scale_is_left_out() {
        let mut report = sample();
        report.cells[0].flip = 0.0;
        report.cells[1].flip = f64::NAN;
        let svg = plot(&report, "close", &Axis::time(&report), [400, 300]).unwrap();
        assert_eq!(svg.matches("class=\"hit\"").count(), 1);
        assert!(!svg.contains("NaN") && plot(&report, "far", &Axis::MEMORY, [400, 300]).is_ok());
    }
}
