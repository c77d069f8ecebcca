//! `worsted bench` and the budget of `worsted render`.

use crate::process::{Workplace, assert_good, error_fault, swatch};
use serde_json::Value;
use std::process::Output;

/// The default settings alone, in a small picture of a thin yarn: quick.
const SMALL: [&str; 17] = [
    "bench",
    "--device",
    "software",
    "--size",
    "64x48",
    "--spp",
    "4",
    "--frames",
    "1",
    "--views",
    "close",
    "--set",
    "yarn.fibers_per_ply=4",
    "--cache",
    "cache",
    "-o",
    "report",
];

fn bench(place: &Workplace, more: &[&str]) -> Output {
    place.run(&[&SMALL[..], more].concat())
}

fn report(place: &Workplace) -> Value {
    serde_json::from_slice(&place.read("report/bench.json")).unwrap()
}

#[test]
fn a_bench_goes_on_from_what_it_measured_and_keeps_its_references() {
    let place = Workplace::new();
    assert_good(&bench(&place, &["--only", "coarse detail, 1"]));
    let first = report(&place);
    let cells = |report: &Value| report["cells"].as_array().unwrap().clone();
    let [cell] = &cells(&first)[..] else { panic!("expected one picture: {first}") };
    for key in ["flip", "mse", "floor_flip", "gpu_bytes", "work"] {
        assert!(cell[key].as_f64().is_some_and(|v| v > 0.0), "{key}: {cell}");
    }
    for name in ["index.html", "bench.csv", "bench.svg"] {
        assert!(!place.read(&format!("report/{name}")).is_empty(), "{name}");
    }
    let reference = std::fs::read_dir(place.path("cache/references")).unwrap().next().unwrap().unwrap();
    let written = reference.metadata().unwrap().modified().unwrap();

    assert_good(&bench(&place, &["--only", "1 sample"]));
    let second = report(&place);
    assert_eq!(cells(&second).len(), 4, "{second}");
    assert!(cells(&second).contains(cell), "what was measured is not measured again");
    assert_eq!(reference.metadata().unwrap().modified().unwrap(), written, "nor traced again");

    assert_good(&bench(&place, &["--only", "1 sample"]));
    assert_eq!(report(&place), second, "nothing was left to do");
    assert_good(&bench(&place, &["--only", "coarse detail, 1", "--set", "seed=5"]));
    assert!(!cells(&report(&place)).contains(cell), "another scene is measured anew");
}

#[test]
fn a_quick_bench_prints_ratios_and_keeps_no_front() {
    let place = Workplace::new();
    let table = |only: &str| {
        let done = bench(&place, &["--quick", "--only", only, "-q"]);
        assert_good(&done);
        let printed = String::from_utf8(done.stdout).unwrap();
        let rows: Vec<&str> = printed.lines().skip(2).collect();
        let cells = |row: &str| row.split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        rows.into_iter().map(cells).collect::<Vec<_>>()
    };
    let [row] = &table("default")[..] else { panic!("expected one row") };
    assert_eq!((&row[1][..], &row[2][..], &row[4][..]), ("close", "default", "1.00"));
    assert_eq!(
        row[3].parse::<f64>().unwrap(),
        (report(&place)["cells"][0]["flip"].as_f64().unwrap() * 1e4).round() / 1e4
    );
    let without_default = table("1 sample");
    assert!(
        without_default.len() == 2 && without_default.iter().all(|row| row[4] == "-"),
        "{without_default:?}"
    );
    assert!(!place.read("report/index.html").is_empty() && !place.path("cache/fronts").exists());
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let place = Workplace::new();
    let wrong: [(&[&str], &str); 5] = [
        (&["--only", "nothing of that name"], "--only"),
        (&["--samples", "5"], "samples = 5"),
        (&["--model", "away.bcc"], "away.bcc"),
        (&["--set", "quality.speed=3"], "`speed`"),
        (&["--views", "sideways"], "sideways"),
    ];
    for (arguments, named) in wrong {
        assert_eq!(error_fault(&bench(&place, arguments), 2, &[named]), None, "{arguments:?}");
    }
    std::fs::create_dir_all(place.path("report")).unwrap();
    place.write("report/bench.json", "[]");
    assert_eq!(error_fault(&bench(&place, &["--only", "default"]), 2, &["bench.json", "remove it"]), None);
}

/// A scene that looks as that of [`SMALL`], from the same camera.
const SCENE: &str = r#"
fabric = { model = "cloth.bcc", mm_per_unit = 1.0 }
yarn = { preset = "worsted_3ply", fibers_per_ply = 4 }
fiber = { color = [0.42, 0.10, 0.05] }
camera = { distance_mm = 100 }
"#;

#[test]
fn a_budget_is_kept_refused_or_found_broken() {
    let place = Workplace::new();
    place.write("scene.toml", SCENE);
    assert_good(&place.run(&["knit", "stockinette", "--courses", "4", "--wales", "4", "-o", "cloth.bcc"]));
    let render = |more: &[&str]| {
        let small = ["render", "scene.toml", "--device", "software", "--size", "64x48", "--cache", "cache"];
        place.run(&[&small[..], &["-o", "a.png"], more].concat())
    };
    let unmeasured = render(&["--max-error", "0.5", "-q"]);
    assert_eq!(error_fault(&unmeasured, 2, &["worsted bench", "scene.toml"]), None);
    assert!(!place.path("a.png").exists());
    assert_eq!(error_fault(&render(&["--verify"]), 2, &["--verify", "--max-error"]), None);
    assert_eq!(error_fault(&render(&["--max-error", "nan"]), 2, &["--max-error"]), None);

    let model = ["--model", "scene.toml", "--only", "default"];
    let full = SMALL.map(|word| if word == "close" { "full" } else { word });
    assert_good(&place.run(&[&full[..], &model].concat()));
    let fit = ["--camera", "yaw=20,pitch=15,fit"];
    let kept = render(&[&fit[..], &["--max-error", "1", "--max-ms", "1000000", "--verify"]].concat());
    assert_good(&kept);
    let said = String::from_utf8_lossy(&kept.stderr).into_owned();
    assert!(said.contains("settings: default") && said.matches("kept").count() == 2, "{said}");
    for (option, least) in [("--max-error", "0.0001"), ("--max-ms", "0.0001")] {
        let refused = render(&[&fit[..], &[option, least, "-q"]].concat());
        assert_eq!(error_fault(&refused, 2, &["cannot keep", least]), None);
    }
    let other = render(&[&fit[..], &["--max-error", "1", "--set", "yarn.preset=rayon1", "-q"]].concat());
    assert_eq!(error_fault(&other, 2, &["no measured front of this yarn"]), None);

    // A front that claims too much is found out.
    let front = std::fs::read_dir(place.path("cache/fronts")).unwrap().next().unwrap().unwrap().path();
    let mut claims: Value = serde_json::from_slice(&std::fs::read(&front).unwrap()).unwrap();
    claims["entries"][0]["flip"] = 1e-4.into();
    std::fs::write(&front, claims.to_string()).unwrap();
    let broken = render(&[&fit[..], &["--max-error", "0.001", "--verify", "-q"]].concat());
    assert_eq!(error_fault(&broken, 1, &["not kept", "FLIP"]), None);
}

#[test]
fn ablations_are_printed_for_three_scenes_and_need_no_folder() {
    let place = Workplace::new();
    let quick = ["bench", "--ablate", "--device", "software", "--frames", "1", "--size", "32x24", "--only"];
    let output = place.run(&[&quick[..], &["self_shadow"]].concat());
    assert_good(&output);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let rows: Vec<&str> = text.lines().filter(|line| line.contains("| self_shadow |")).collect();
    assert_eq!(rows.len(), 3, "{text}");
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let number = |cell: usize| cells[cell].parse::<f64>().unwrap_or(f64::NAN);
        // Time with and without, bytes of the table (which a driver may round up) and the time to bake it.
        assert!(number(3) > 0.0 && number(4) > 0.0 && number(8) > 0.0, "{row}");
        assert!((1_048_576.0..1_200_000.0).contains(&number(7)), "{row}");
    }
    assert!(place.contents().is_empty(), "{:?}", place.contents());
    let output = place.run(&[&quick[..], &["nothing of that name"]].concat());
    assert_eq!(output.status.code(), Some(2));
    let output = place.run(&["bench"]);
    assert_eq!(output.status.code(), Some(2), "a report needs a folder");
}

#[test]
fn renders_keep_tables_where_they_are_told_to_or_nowhere() {
    let place = Workplace::new();
    let swatch = swatch();
    let render =
        ["render", &swatch, "--device", "software", "--size", "32x24", "--samples", "1", "-o", "a.png"];
    assert_good(&place.run(&[&render[..], &["--cache", "kept"]].concat()));
    assert!(place.path("kept/bakes").is_dir() && place.path("kept/pipelines").is_dir());
    let stats = [&render[..], &["--cache", "kept", "--stats", "s.json"]].concat();
    assert_good(&place.run(&stats));
    let stats: Value = serde_json::from_slice(&place.read("s.json")).unwrap();
    assert!(stats["precompute_from_cache"].as_array().is_some_and(|names| names.len() >= 5), "{stats}");
    assert!(stats["host_peak_bytes"].as_u64().is_none_or(|bytes| bytes > 1 << 20), "{stats}");
    let kept = place.path("nowhere");
    let nowhere = kept.to_str().unwrap();
    assert_good(&place.run_with(&[&render[..], &["--no-cache"]].concat(), &[("WORSTED_CACHE", nowhere)]));
    assert!(!kept.exists());
    assert_good(&place.run_with(&render[..], &[("WORSTED_CACHE", nowhere)]));
    assert!(kept.join("bakes").is_dir());
}
