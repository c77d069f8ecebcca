//! What each field's domain refuses, by the table that help prints.

use serde_json::{Value, json};
use worsted::probe::fields::{Domain, Field};
use worsted::probe::{FUNCTIONS, Function, Tally, described, probe};
use worsted::stress::queries;

fn answer(function: &'static Function, query: &Value) -> Value {
    let mut written = Vec::new();
    let tally = probe(function, None, query.to_string().as_bytes(), &mut written).unwrap();
    let answer: Value = serde_json::from_slice(&written).unwrap();
    assert_eq!(tally, Tally { lines: 1, errors: answer.get("error").is_some().into() });
    answer
}

fn place<'a>(query: &'a mut Value, path: &str) -> &'a mut Value {
    path.split('.').fold(query, |value, key| &mut value[key])
}

/// Values that a field refuses: of other types, and just outside at either end.
fn refused(field: &Field) -> Vec<Value> {
    let others = [json!("x"), json!({}), json!([]), json!(true), json!([1, 2, 3, 4, 5])];
    let beyond = |low: f64, high: f64| [low - 1e-3 * (1.0 + low.abs()), high + 1e-3 * (1.0 + high.abs())];
    let more: Vec<Value> = match field.domain {
        Domain::Number(low, high) => beyond(low, high).map(|v| json!(v)).into(),
        Domain::Numbers(count, low, high) => beyond(low, high).map(|v| json!(vec![v; count])).into(),
        Domain::Points(low, high) => beyond(low, high).map(|v| json!(vec![vec![v; 3]; 4])).into(),
        Domain::Basis => vec![json!("b_spline"), json!(0)],
        Domain::Color => vec![json!(-0.1), json!(1.1), json!([0, 0, 1.1]), json!([0, 0])],
        Domain::Yarn("ply_count") => vec![json!(0), json!(9), json!(2.5)],
        Domain::Yarn("ply_pitch_mm" | "fiber_pitch_mm") => {
            vec![json!(0), json!(5e-4), json!(-5e-4), json!(2e9)]
        }
        Domain::Yarn(_) => vec![json!(-0.1), json!(1e9)],
        Domain::IndexBelow(_) => vec![json!(-1), json!(8), json!(0.5)],
    };
    let null = if field.path.ends_with("_pitch") { None } else { Some(Value::Null) };
    others.into_iter().chain(more).chain(null).collect()
}

#[test]
fn every_field_is_checked_and_its_domain_is_said() {
    for function in FUNCTIONS {
        let good = queries::random(function.name, 1).remove(0);
        assert!(answer(function, &good).get("error").is_none(), "{good}");
        for field in function.fields {
            let mut missing = good.clone();
            let (parent, key) = field.path.rsplit_once('.').unwrap_or(("", field.path));
            let parent = if parent.is_empty() { &mut missing } else { &mut missing[parent] };
            parent.as_object_mut().unwrap().remove(key);
            let expected = format!("line 1: {}: missing, expected {}", field.path, field.domain);
            assert_eq!(answer(function, &missing)["error"], json!(expected));
            for bad in refused(field) {
                let mut query = good.clone();
                *place(&mut query, field.path) = bad;
                let error = answer(function, &query)["error"].as_str().map(str::to_owned).unwrap_or_default();
                let named = error.starts_with(&format!("line 1: {} = ", field.path));
                assert!(
                    named && error.ends_with(&field.domain.to_string()),
                    "{}: {query}: {error}",
                    function.name
                );
            }
            let help = format!("{}: {}\n", field.path, field.domain);
            assert!(described().contains(&help), "{help}");
        }
    }
}

#[test]
fn the_ends_of_every_domain_belong_to_it() {
    let together = ["turns over the piece", "the yarn's outer radius"];
    for function in FUNCTIONS {
        let good = queries::random(function.name, 1).remove(0);
        for field in function.fields {
            let ends: Vec<Value> = match field.domain {
                Domain::Number(low, high) => [low, high].map(|v| json!(v)).into(),
                Domain::Numbers(count, low, high) => [low, high].map(|v| json!(vec![v; count])).into(),
                Domain::Color => vec![json!(0), json!([1, 1, 1])],
                _ => continue,
            };
            for end in ends {
                let mut query = good.clone();
                *place(&mut query, field.path) = end;
                // Lengths at an end are too many turns apart, and places there outside of the yarn.
                let error = answer(function, &query)["error"].as_str().map(str::to_owned).unwrap_or_default();
                assert!(
                    error.is_empty() || together.iter().any(|rule| error.contains(rule)),
                    "{query}: {error}"
                );
            }
        }
    }
}

#[test]
fn fields_that_do_not_fit_together_are_refused() {
    let query = queries::random("fiber_point", 1).remove(0);
    let function = worsted::probe::find("fiber_point").unwrap();
    let edits: [(&str, Value, &str); 4] = [
        ("length_end", json!(1e9), "length_end - length_start: expected at most 128 turns over the piece"),
        ("yarn.migration_min", json!(1), "yarn.migration_max = "),
        ("fiber.ply", json!(7), "fiber.ply = 7: expected less than ply_count = 2"),
        ("normal_reference", json!([0, 0, 0]), "normal_reference = [0, 0, 0]: expected a direction"),
    ];
    for (path, value, expected) in edits {
        let mut query = query.clone();
        query["yarn"]["ply_count"] = json!(2);
        query["yarn"]["ply_pitch"] = json!(0.01);
        query["yarn"]["migration_max"] = json!(0.5);
        query["yarn"]["migration_min"] = json!(0.25);
        query["fiber"]["ply"] = json!(1);
        *place(&mut query, "length_end") = query["length_start"].clone();
        *place(&mut query, path) = value;
        let answered = answer(function, &query);
        let error = answered["error"].as_str().unwrap_or_default();
        assert!(error.starts_with(&format!("line 1: {expected}")), "{answered}");
    }
}

#[test]
fn places_outside_of_an_occlusion_table_are_refused() {
    let function = worsted::probe::find("ambient_occlusion").unwrap();
    let yarn = json!({"ply_count": 1, "ply_offset": 0, "ellipse_short": 0.1, "ellipse_long": 0.1, "beta": 1, "epsilon": 0.1});
    let at = |x: f64, y: f64| answer(function, &json!({"yarn": yarn, "extinction": 2, "position": [x, y]}));
    assert!(at(0.1, -0.1)["visibility"].as_f64().unwrap() > 0.5, "{}", at(0.1, -0.1));
    let error = at(0.1, -0.101)["error"].as_str().map(str::to_owned).unwrap_or_default();
    assert!(error.contains("expected at most the yarn's outer radius"), "{error}");
}
