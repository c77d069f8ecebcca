//! Tables of the page.

use super::{cell_id, data_uri, words};
use crate::bench::blame::{Change, blame};
use crate::bench::report::{Cell, Report, ViewFacts};
use crate::bench::settings::DEFAULT;
use crate::error::Error;
use maud::{Markup, html};
use std::path::Path;

/// What the default does in each view, and the two ends of the front.
pub fn views_table(report: &Report) -> Markup {
    let figures = |cell: Option<&Cell>| {
        let time = |cell: &Cell| words::milliseconds(cell.time(&report.head).median);
        cell.map_or_else(String::new, |cell| format!("{:.3} in {}", cell.flip, time(cell)))
    };
    let noise = |cell: Option<&Cell>| {
        cell.and_then(|cell| cell.floor_flip).map_or_else(String::new, |flip| format!("{flip:.3}"))
    };
    html! {
        div.scroll {
            table.brief {
                thead { tr { th { "view" } th { "default" } th { "noise alone*" } th { "fastest" } th { "best" } } }
                tbody {
                    @for view in &report.views {
                        @let default = report.cell(&view.name, DEFAULT);
                        @let front = report.front(&view.name);
                        tr {
                            td { (view.name) }
                            td { b { (figures(default)) } }
                            td { (noise(default)) }
                            td { (figures(front.first().copied())) }
                            td { (figures(front.last().copied())) }
                        }
                    }
                }
            }
        }
        p.meta { "* what a perfect picture of as many samples would err by, against the same reference" }
    }
}

/// What each approximation costs and saves, a row for each and a pair of columns for each view.
pub fn blame_table(report: &Report) -> Markup {
    let rows = blame(report);
    let mut names: Vec<&str> = Vec::new();
    for row in &rows {
        if !names.contains(&row.name) {
            names.push(row.name);
        }
    }
    let of = |name: &str, view: &str| rows.iter().find(|row| row.name == name && row.view == view);
    html! {
        div.scroll {
            table {
                thead {
                    tr {
                        th { "approximation" }
                        @for view in &report.views { th { (view.name) ", that one off" } th { (view.name) ", that one alone" } }
                    }
                }
                tbody {
                    @for name in names {
                        tr {
                            td { (name) }
                            @for view in &report.views {
                                @let row = of(name, &view.name);
                                td { (change(row.and_then(|row| row.off))) }
                                td { (change(row.and_then(|row| row.alone))) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// `FLIP +0.010, time x 0.52`.
fn change(change: Option<Change>) -> String {
    change.map_or_else(String::new, |Change { flip, time }| format!("FLIP {flip:+.4}, time x {time:.2}"))
}

/// Every picture of a view.
pub fn cell_table(report: &Report, view: &ViewFacts, folder: &Path) -> Result<Markup, Error> {
    let front = report.front(&view.name);
    let is_on_front = |cell: &Cell| front.iter().any(|other| std::ptr::eq(*other, cell));
    let number = |value: Option<f64>| value.map(|v| format!("{v:.4}")).unwrap_or_default();
    Ok(html! {
        div.scroll {
            table {
                thead { tr {
                    th { "settings" } th { "picture" } th { "FLIP" } th { "floor" } th { "MSE" } th { "time, ms" }
                    th { "least to most" } th { "wall, ms" } th { "memory, MiB" }
                } }
                tbody {
                    tr {
                        td { "reference, " (report.head.reference_samples) " samples" }
                        td { img src=(data_uri(folder, &view.thumbnail)?) alt="the reference"; }
                        @for _ in 0..7 { td {} }
                    }
                    @for cell in report.cells_of(&view.name) {
                        @let time = cell.time(&report.head);
                        tr id=(cell_id(report, cell)) {
                            td {
                                span class=[is_on_front(cell).then_some("front")] { (cell.setting.name) }
                                br;
                                code { (cell.setting.as_options()) }
                            }
                            td { img src=(data_uri(folder, &cell.thumbnail)?) alt=(words::capital(&cell.setting.name)); }
                            td { (number(Some(cell.flip))) }
                            td { (number(cell.floor_flip)) }
                            td { (format!("{:.2e}", cell.mse)) }
                            td { (format!("{:.1}", time.median)) }
                            td { (format!("{:.1} to {:.1} of {}", time.min, time.max, time.frames)) }
                            td { (format!("{:.1}", cell.wall_ms.median)) }
                            td { (format!("{:.1}", cell.gpu_bytes as f64 / f64::from(1 << 20))) }
                        }
                    }
                }
            }
        }
    })
}
