//! The report as one page that needs nothing else: no script of others, no picture from elsewhere.

mod plot;
mod tables;
mod words;

use super::report::{Cell, Report};
use crate::error::Error;
use crate::io::error::FileError;
use crate::io::whole::write_whole;
use base64::Engine;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use plot::{Axis, plot};
use std::path::Path;

pub use words::summary;

/// The page's file in the report's folder.
pub const PAGE_FILE: &str = "index.html";
/// The first plot by itself, for a README.
pub const FIGURE_FILE: &str = "bench.svg";

/// Width and height of plots for wide and for narrow windows.
const PLOT_SIZES: [(&str, [u32; 2]); 2] = [("wide", [860, 460]), ("narrow", [380, 380])];

/// Writes the page, and the plot of its first view as a picture of its own. Small pictures are taken from the folder.
///
/// # Errors
/// What the file system says; a plot that cannot be drawn.
pub fn write(report: &Report, folder: &Path) -> Result<(), Error> {
    let page = page(report, folder)?.into_string();
    write_whole(&folder.join(PAGE_FILE), |out| out.write_all(page.as_bytes()))?;
    if let Some(view) = report.views.first() {
        let svg = plot(report, &view.name, &Axis::time(report), PLOT_SIZES[0].1)?;
        write_whole(&folder.join(FIGURE_FILE), |out| out.write_all(svg.as_bytes()))?;
    }
    Ok(())
}

fn page(report: &Report, folder: &Path) -> Result<Markup, Error> {
    let head = &report.head;
    Ok(html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Worsted: error against run time" }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body {
                h1 { "Error against run time" }
                @for line in words::lead(report) { p.lead { (line) } }
                (tables::views_table(report))
                p.meta {
                    (head.device) " (" (head.driver) "), " (head.processors) " processors; " (head.date) "; "
                    (head.model) ", " (head.size[0]) " x " (head.size[1]) " pixels; Worsted " (head.version)
                }
                @for view in &report.views { (view_section(report, &view.name)?) }
                h2 { "What each approximation costs and saves" }
                p { (words::BLAME) }
                (tables::blame_table(report))
                h2 { "Every picture" }
                p { (words::errors(report)) }
                @for view in &report.views {
                    details {
                        summary { (words::capital(&view.name)) }
                        (tables::cell_table(report, view, folder)?)
                    }
                }
                h2 { "How this was measured" }
                ul { @for line in words::method(report) { li { (line) } } }
                @if !report.warnings.is_empty() {
                    h2 { "Warnings" }
                    ul { @for line in &report.warnings { li { (line) } } }
                }
                div #card hidden {}
                script { (PreEscaped(include_str!("page.js"))) }
            }
        }
    })
}

fn view_section(report: &Report, view: &str) -> Result<Markup, Error> {
    let front = report.front(view);
    Ok(html! {
        section {
            h2 { (words::capital(view)) " view" }
            p { (words::view_line(report, view)) }
            (plots(report, view, &Axis::time(report))?)
            p.legend { "Numbered and joined: the front, that no other settings beat in both. Ringed: the default. \
                        Dashed: what noise alone makes of a perfect picture of as many samples as the default." }
            ol { @for cell in &front { li { (front_line(report, cell)) } } }
            details {
                summary { "Error against memory" }
                (plots(report, view, &Axis::MEMORY)?)
            }
        }
    })
}

fn front_line(report: &Report, cell: &Cell) -> Markup {
    html! {
        b { (cell.setting.name) } ": FLIP " (format!("{:.3}", cell.flip)) ", "
        (words::milliseconds(cell.time(&report.head).median))
        br;
        code { (cell.setting.as_options()) }
    }
}

/// A plot for wide windows and one for narrow ones, of which the style sheet shows one.
fn plots(report: &Report, view: &str, axis: &Axis) -> Result<Markup, Error> {
    let drawn = PLOT_SIZES.map(|(class, size)| plot(report, view, axis, size).map(|svg| (class, svg)));
    Ok(html! {
        @for drawn in drawn {
            @let (class, svg) = drawn?;
            div class=(format!("plot {class}")) { (PreEscaped(svg)) }
        }
    })
}

/// A PNG of the report's folder as a data URI.
fn data_uri(folder: &Path, name: &str) -> Result<String, Error> {
    let path = folder.join(name);
    let bytes = std::fs::read(&path).map_err(|e| FileError::io(&path, "read", &e))?;
    Ok(format!("data:image/png;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes)))
}

/// Identifies a picture within the page.
fn cell_id(report: &Report, cell: &Cell) -> String {
    let index = report.cells.iter().position(|other| std::ptr::eq(other, cell)).unwrap_or(0);
    format!("c{index}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::report::sample;
    use crate::io::picture::{DisplayImage, write_png};

    #[test]
    fn the_page_is_whole_by_itself_and_escapes_what_it_shows() {
        let folder = tempfile::tempdir().unwrap();
        let mut report = sample();
        report.head.model = "<script>alert(1)</script>".into();
        std::fs::create_dir(folder.path().join("thumbnails")).unwrap();
        for name in ["close-0", "close-reference"] {
            let path = folder.path().join(format!("thumbnails/{name}.png"));
            write_png(&path, &DisplayImage::filled(4, 3, [9, 9, 9, 255])).unwrap();
        }
        write(&report, folder.path()).unwrap();
        let page = std::fs::read_to_string(folder.path().join(PAGE_FILE)).unwrap();
        assert!(!page.contains("<script>alert") && page.contains("&lt;script&gt;alert"));
        let outside = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!outside.contains("http:") && !outside.contains("https:") && !outside.contains("src=\"t"));
        // A plot of time and one of memory, each twice, with every picture to be hovered over.
        assert_eq!(page.matches("<svg").count(), 4);
        assert_eq!(page.matches("class=\"hit\"").count(), 4 * report.cells.len());
        assert!(page.contains("data:image/png;base64,") && page.contains("rough &quot;and&quot;, ready"));
        let figure = std::fs::read_to_string(folder.path().join(FIGURE_FILE)).unwrap();
        assert!(figure.starts_with("<svg") && figure.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn a_lost_picture_is_named() {
        let error = write(&sample(), tempfile::tempdir().unwrap().path()).unwrap_err();
        assert!(error.to_string().contains("thumbnails"), "{error}");
    }
}
