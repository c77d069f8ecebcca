//! Tests of `report.rs`, and a small report for those of what reads one.

use super::*;

/// Three ways to draw one view: the second beats the default, the third is faster and worse.
pub fn sample() -> Report {
    let head = Head {
        date: "2026-01-02T03:04:05Z".into(),
        version: "0.1.0".into(),
        device: "a device".into(),
        driver: "a driver".into(),
        processors: 2,
        timing_method: TIMED_BY_PROCESSOR.into(),
        size: [64, 48],
        reference_samples: 64,
        model: "a swatch".into(),
    };
    let view = ViewFacts {
        name: "close".into(),
        fiber_px: 1.2,
        floors: vec![Floor { samples: 4, flip: 0.06, mse: 1e-3 }],
        chord_error: 0.1,
        thumbnail: "thumbnails/close-reference.png".into(),
    };
    let cells = vec![
        cell("default", 0.2, [100.0, 90.0, 105.0]),
        cell("better", 0.15, [80.0, 79.0, 81.0]),
        cell("rough \"and\", ready", 0.3, [10.0, 9.0, 13.0]),
    ];
    Report { head, views: vec![view], cells, warnings: Vec::new() }
}

fn cell(name: &str, flip: f64, [median, min, max]: [f64; 3]) -> Cell {
    let time = Spread { median, min, max, frames: 3 };
    Cell {
        key: format!("{:016x}", name.len()),
        view: "close".into(),
        setting: Setting { name: name.into(), samples: 4, sets: vec!["shadow.map=false".into()] },
        flip,
        mse: flip * flip,
        floor_flip: Some(0.06),
        cpu_ms: Some(time),
        wall_ms: Spread { median: 0.5 * median, ..time },
        device_ms: None,
        gpu_bytes: 12_345_678,
        counts: Counts { control_points: 100, fiber_curves: 1000, fiber_segments: 5000 },
        work: 1000.0,
        thumbnail: "thumbnails/close-0.png".into(),
    }
}

#[test]
fn what_is_written_is_read_again_in_both_forms() {
    let folder = tempfile::tempdir().unwrap();
    let report = sample();
    assert!(Report::read(folder.path()).unwrap().is_none());
    report.write(folder.path()).unwrap();
    assert_eq!(Report::read(folder.path()).unwrap().as_ref(), Some(&report));
    let mut table = csv::Reader::from_path(folder.path().join(CSV_FILE)).unwrap();
    let columns = table.headers().unwrap().clone();
    assert_eq!(columns.iter().collect::<Vec<_>>(), COLUMNS);
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), report.cells.len());
    for (row, cell) in rows.iter().zip(&report.cells) {
        let text = |name: &str| &row[COLUMNS.iter().position(|column| *column == name).unwrap()];
        let number = |name: &str| text(name).parse::<f64>().unwrap();
        assert_eq!((text("setting"), text("view")), (cell.setting.name.as_str(), "close"));
        assert_eq!((number("flip"), number("mse")), (cell.flip, cell.mse));
        assert_eq!((number("time_ms_max"), number("fiber_px")), (cell.cpu_ms.unwrap().max, 1.2));
        assert_eq!((number("gpu_bytes"), text("device_ms")), (12_345_678.0, ""));
    }
}

#[test]
fn the_front_leaves_out_what_is_beaten() {
    let report = sample();
    let names = |cells: Vec<&Cell>| cells.iter().map(|cell| cell.setting.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(report.front("close")), ["rough \"and\", ready", "better"]);
    assert!(report.front("far").is_empty());
}

#[test]
fn wide_spreads_are_named_and_narrow_ones_are_not() {
    let warnings = sample().spread_warnings();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("rough") && warnings[0].contains("40%"), "{warnings:?}");
}

#[test]
fn a_device_with_a_clock_is_timed_by_it() {
    let mut report = sample();
    assert_eq!(report.cells[0].time(&report.head).median, 100.0);
    report.cells[0].device_ms = Some(Spread { median: 3.0, min: 3.0, max: 3.0, frames: 3 });
    assert_eq!(report.cells[0].time(&report.head).median, 3.0);
    report.head.timing_method = TIMED_BY_WALL.into();
    assert_eq!(report.cells[1].time(&report.head).median, 40.0);
}

#[test]
fn something_else_of_that_name_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    for bytes in [&b""[..], b"[1, 2]", b"{\n\"head\": 3}", &[0xff; 9]] {
        std::fs::write(folder.path().join(JSON_FILE), bytes).unwrap();
        let error = Report::read(folder.path()).unwrap_err();
        let line = error.to_string();
        assert!(error.exit_code() == 2 && line.contains(JSON_FILE) && !line.contains('\n'), "{line}");
    }
}
