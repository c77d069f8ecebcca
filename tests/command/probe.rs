//! `worsted probe` as a user runs it.

use super::process::{Workplace, assert_good, assert_one_line_error};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::io::{BufRead, BufReader, Write};
use std::process::Output;

fn ask(function: &str, backend: &str, queries: &[String]) -> Output {
    let arguments = ["probe", function, "--backend", backend, "--validate"];
    Workplace::new().run_on(&arguments, &queries.join("\n"))
}

fn answers(output: &Output) -> Vec<Value> {
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn simple(phi: f64) -> String {
    json!({"strength": 2, "theta_h": 0, "phi": phi, "width": 0.25}).to_string()
}

#[test]
fn both_backends_answer_every_line_in_order() {
    let phis: Vec<f64> = (0..20_000).map(|i| 1e-4 * f64::from(i)).collect();
    let queries: Vec<String> = phis.iter().map(|phi| simple(*phi)).collect();
    for backend in ["device", "f64"] {
        let output = ask("simple_specular", backend, &queries);
        assert_good(&output);
        let found = answers(&output);
        assert_eq!(found.len(), phis.len());
        for (phi, answer) in phis.iter().zip(found) {
            let value = answer["value"].as_f64().unwrap();
            assert!((value - 2.0 * (0.5 * phi).cos()).abs() < 1e-5, "{backend} at {phi}: {answer}");
        }
    }
}

#[test]
fn a_straight_untwisted_yarn_is_where_it_is_drawn() {
    let yarn = json!({"ply_count": 2, "yarn_radius": 0.5, "ply_pitch": 4, "fiber_pitch": null, "ellipse_short": 0.125,
        "ellipse_long": 0.25, "migration_min": 1, "migration_max": 1, "migration_rate": 0});
    // A quarter of a turn of the plies, and four thousand whole ones.
    let query = json!({"control_points": [[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3]], "basis": "bezier", "t": 0.5,
        "length_start": 16_000, "length_end": 16_002, "normal_reference": [1, 0, 5], "yarn": yarn,
        "fiber": {"ply": 1, "radius": 1, "angle": 0.5 * PI, "migration_phase": 1}});
    for backend in ["device", "f64"] {
        let output = ask("fiber_point", backend, &[query.to_string()]);
        assert_good(&output);
        let answer = answers(&output).remove(0);
        for (part, expected) in [
            ("yarn_center", [0.0, 0.0, 1.5]),
            ("ply_center", [0.0, -0.25, 1.5]),
            ("position", [0.25, -0.25, 1.5]),
        ] {
            for (k, expected) in expected.into_iter().enumerate() {
                let found = answer[part][k].as_f64().unwrap();
                assert!((found - expected).abs() < 1e-4, "{backend}: {part} of {answer}");
            }
        }
    }
}

#[test]
fn a_line_that_cannot_be_answered_has_an_error_in_its_place() {
    let queries = [simple(0.0), "{".to_owned(), simple(1e4), simple(PI)];
    for backend in ["device", "f64"] {
        let output = ask("simple_specular", backend, &queries);
        assert_eq!(output.status.code(), Some(1));
        let found = answers(&output);
        assert_eq!(found.len(), 4);
        assert!((found[0]["value"].as_f64().unwrap() - 2.0).abs() < 1e-6, "{found:?}");
        assert!(found[1]["error"].as_str().unwrap().starts_with("line 2: not JSON"), "{found:?}");
        assert_eq!(found[2]["error"], "line 3: phi = 10000.0: expected a number from -1000 to 1000");
        assert!(found[3]["value"].as_f64().unwrap().abs() < 1e-6, "{found:?}");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(said.ends_with("worsted: 2 of 4 lines could not be answered\n"), "{said}");
    }
}

#[test]
fn an_answer_comes_before_the_next_question() {
    let place = Workplace::new();
    let mut child = place.start(&["probe", "simple_specular", "--backend", "f64"]);
    let mut queries = child.stdin.take().unwrap();
    let mut answers = BufReader::new(child.stdout.take().unwrap());
    for phi in [0.0, PI] {
        writeln!(queries, "{}", simple(phi)).unwrap();
        let mut line = String::new();
        answers.read_line(&mut line).unwrap();
        let answer: Value = serde_json::from_str(&line).unwrap();
        assert!((answer["value"].as_f64().unwrap() - 2.0 * (0.5 * phi).cos()).abs() < 1e-6, "{answer}");
    }
    drop(queries);
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn functions_and_backends_that_do_not_exist_are_named_in_one_line() {
    let place = Workplace::new();
    for (arguments, needles) in [
        (
            &["probe", "bcsdf_sin", "--backend", "f64"][..],
            &["bcsdf_sin", "curve_point", "ambient_scattering"][..],
        ),
        (&["probe", "bcsdf", "--backend", "f32"], &["f32", "device", "f64"]),
        (&["probe", "bcsdf"], &["--backend"]),
    ] {
        assert_one_line_error(&place.run_on(arguments, ""), 2, needles);
    }
}
