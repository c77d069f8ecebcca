//! The table against the reader of scenes itself.

use super::*;
use crate::bsdf::params::FiberParams;
use crate::bsdf::presets as fibers;
use crate::scene::SceneFile;
use crate::yarn::params::YarnParams;
use crate::yarn::presets as yarns;
use std::collections::BTreeSet;
use toml::{Table, Value};

fn read(text: &str) -> Result<SceneFile, String> {
    let table: Table = toml::from_str(text).map_err(|e| e.to_string())?;
    SceneFile::from_table(table).map_err(|e| e.to_string())
}

/// The names that serde lists after one that it does not know.
fn known(message: &str) -> BTreeSet<String> {
    message.lines().next().unwrap().split('`').skip(1).step_by(2).skip(1).map(str::to_owned).collect()
}

/// The keys that serde knows of a table of a scene.
fn keys_of(table: &str) -> BTreeSet<String> {
    let message = match table {
        "" => toml::from_str::<SceneFile>("zzzz = 1").unwrap_err(),
        "yarn" => toml::from_str::<YarnParams>("zzzz = 1").unwrap_err(),
        "fiber" => toml::from_str::<FiberParams>("zzzz = 1").unwrap_err(),
        "light" => toml::from_str::<SceneFile>("[[light]]\nzzzz = 1").unwrap_err(),
        _ => toml::from_str::<SceneFile>(&format!("[{table}]\nzzzz = 1")).unwrap_err(),
    };
    known(message.message())
}

fn set<'a>(names: impl IntoIterator<Item = &'a str>) -> BTreeSet<String> {
    names.into_iter().map(str::to_owned).collect()
}

#[test]
fn the_table_lists_exactly_the_keys_of_scene_files() {
    let tables = Group::ALL.iter().map(|group| group.table());
    assert_eq!(keys_of(""), set(tables.chain(["seed"])));
    for group in Group::ALL {
        let mut keys = keys_of(group.table());
        match group {
            // Read before the parameters that they are presets of.
            Group::Yarn => keys.extend(set(["preset"])),
            Group::Fiber => keys.extend(set(["preset", "color"])),
            // Tables of parameters that are listed as the scene's own.
            Group::Fabric => keys.retain(|key| !["yarn", "fiber"].contains(&key.as_str())),
            _ => {}
        }
        assert_eq!(keys, set(of_table(group.table()).map(|row| row.key)), "[{}]", group.table());
    }
    let paths: BTreeSet<String> = parameters().iter().map(Parameter::path).collect();
    assert_eq!(paths.len(), parameters().len(), "each once");
}

#[test]
fn every_parameter_says_what_it_is_and_offers_what_is_allowed() {
    for row in parameters() {
        let path = row.path();
        assert!(row.about.ends_with('.') && (8..130).contains(&row.about.len()), "{path}: {}", row.about);
        assert_eq!(row.symbol.is_empty(), row.paper.is_empty(), "{path}");
        assert_eq!(find(&path).map(Parameter::path), Some(path.clone()));
        if matches!(row.kind, Kind::Rgb(_)) {
            continue;
        }
        if let Some((low, high)) = row.range() {
            let (from, to) = row.usual;
            assert!(low <= from && from < to && to <= high, "{path}: {from} to {to}");
        }
    }
    assert_eq!(find("fabric.1.yarn.ply_count").map(Parameter::path).as_deref(), Some("yarn.ply_count"));
    assert_eq!(find("light.3.kind").map(Parameter::path).as_deref(), Some("light.kind"));
    assert!(find("yarn.none").is_none() && find("a.b.c").is_none() && find("").is_none());
}

#[test]
fn every_default_and_every_preset_is_in_range() {
    let scene = Table::try_from(SceneFile::default()).unwrap();
    let yarns = yarns::yarn_names().map(|name| ("yarn", Table::try_from(yarns::yarn(name).unwrap())));
    let fibers = fibers::fiber_names().map(|name| ("fiber", Table::try_from(fibers::fiber(name).unwrap())));
    let mut judged = 0;
    let mut judge = |row: &Parameter, value: Option<&Value>| match value {
        Some(value) => {
            check_value(row, &row.path(), value).unwrap();
            judged += 1;
        }
        None => assert!(row.optional || matches!(row.kind, Kind::Pitch(..)), "{}", row.path()),
    };
    for (table, values) in yarns.chain(fibers) {
        let values = values.unwrap();
        of_table(table).filter(|row| row.key != "preset").for_each(|row| judge(row, values.get(row.key)));
    }
    for row in
        parameters().iter().filter(|row| !["yarn", "fiber", "light", "fabric", ""].contains(&row.table))
    {
        judge(row, scene[row.table].as_table().unwrap().get(row.key));
    }
    assert!(judged > 300, "{judged}");
}

/// A scene in which the parameter may be anything in its range; `end` is the value nearest to it that may be.
fn around(row: &Parameter, end: f64) -> String {
    match (row.table, row.key) {
        ("light", "irradiance" | "angular_size_deg" | "kind") => "[[light]]\n".into(),
        ("light", "position_mm") => "[[light]]\nkind = 'spot'\n".into(),
        ("light", _) => "[[light]]\nkind = 'spot'\nposition_mm = [0, 0, 9]\n".into(),
        ("yarn", "migration_min") => "[yarn]\nmigration_max = 1.5\n".into(),
        ("yarn", "migration_max") => "[yarn]\nmigration_min = 0\n".into(),
        ("yarn", "yarn_radius_mm") => "[yarn]\nellipse_short_mm = 1e4\nellipse_long_mm = 1e4\n".into(),
        ("yarn", "ellipse_short_mm") => format!("[yarn]\nyarn_radius_mm = 0\nellipse_long_mm = {end:?}\n"),
        ("yarn", "ellipse_long_mm") => format!("[yarn]\nyarn_radius_mm = 0\nellipse_short_mm = {end:?}\n"),
        ("yarn", "hair_length_mm") => "[yarn]\nhair_density_per_mm = 0\n".into(),
        ("fiber", "color") => "[fiber]\nc_r = [0, 0, 0]\n".into(),
        ("", _) => String::new(),
        (table, _) => format!("[{table}]\n"),
    }
}

/// Values as text: those at the ends of a range with that end, and some just outside of it.
type Ends = (Vec<(String, f64)>, Vec<String>);

fn ends(row: &Parameter) -> Ends {
    let of = |values: Vec<(String, f64)>, outside: Vec<String>| (values, outside);
    let three = |x: f64| format!("[{x:?}, {x:?}, {x:?}]");
    match row.kind {
        Kind::Number(low, high) | Kind::Pitch(low, high) => of(
            [low, high].map(|x| (format!("{x:?}"), x)).to_vec(),
            [low.next_down(), high.next_up(), f64::NAN].map(|x| format!("{x:?}").to_lowercase()).to_vec(),
        ),
        Kind::Vector(low, high) => of(
            [low, high].map(|x| (three(x), x)).to_vec(),
            [low.next_down(), high.next_up()].map(|x| format!("[0, 0, {x:?}]")).to_vec(),
        ),
        Kind::Rgb(most) => of(
            [0.0, most].map(|x| (three(x), x)).to_vec(),
            [0f64.next_down(), most.next_up()].map(|x| format!("[0, 0, {x:?}]")).to_vec(),
        ),
        Kind::Spread(low, high) => of(
            vec![(format!("[{low:?}, 0]"), low), (format!("[{high:?}, {high:?}]"), high)],
            vec![
                format!("[{:?}, 0]", low.next_down()),
                format!("[{:?}, 0]", high.next_up()),
                format!("[0, {:?}]", 0f64.next_down()),
                format!("[0, {:?}]", high.next_up()),
            ],
        ),
        Kind::Count(low, high) | Kind::PowerOfTwo(low, high) => of(
            [low, high].map(|n| (n.to_string(), n as f64)).to_vec(),
            [i128::from(low) - 1, i128::from(high) + 1].map(|n| n.to_string()).to_vec(),
        ),
        Kind::Direction => of(Vec::new(), vec!["[0, 0, 0]".into(), "[0, inf, 0]".into()]),
        _ => (Vec::new(), Vec::new()),
    }
}

/// Ends that another parameter keeps out of reach, with what the reader says of them.
const NEVER_REACHED: &[(&str, f64, &str)] = &[
    ("light.inner_angle_deg", 90.0, "allowed is 0 to below outer_angle_deg"),
    ("fiber.color", 1.0, "with this c_r"),
];

#[test]
fn every_end_of_a_range_is_accepted_and_what_lies_just_outside_is_not() {
    let mut ranges = 0;
    for row in parameters() {
        let path = row.path();
        let text = |value: &str, end: f64| format!("{}{} = {value}\n", around(row, end), row.key);
        let (inside, outside) = ends(row);
        ranges += usize::from(!outside.is_empty());
        for (value, end) in inside {
            let reached = NEVER_REACHED.iter().find(|(never, at, _)| *never == path && *at == end);
            match (read(&text(&value, end)), reached) {
                (Ok(_), None) => {}
                (Err(message), Some((_, _, says))) => assert!(message.contains(says), "{message}"),
                (found, _) => panic!("{path} = {value}: {found:?}"),
            }
        }
        for value in outside {
            let error = read(&text(&value, row.range().map_or(1.0, |(_, high)| high))).expect_err(&value);
            let whole = matches!(row.kind, Kind::Count(..) | Kind::PowerOfTwo(..));
            // Numbers that serde's own types have no room for are refused by them.
            assert!(error.contains(row.key) && (whole || error.contains("allowed is")), "{path}: {error}");
        }
    }
    assert!(ranges > 60, "{ranges}");
}

#[test]
fn names_switches_and_presets_are_those_that_the_reader_knows() {
    for row in parameters() {
        let path = row.path();
        let with = |value: &str| read(&format!("{}{} = {value}\n", around(row, 0.0), row.key));
        match row.kind {
            Kind::Switch => {
                assert!(with("true").is_ok() && with("false").is_ok() && with("1").is_err(), "{path}");
            }
            Kind::Name(names) => {
                let error = with("'zzzz'").unwrap_err();
                assert_eq!(known(error.split_once(": ").unwrap().1), set(names.iter().copied()), "{path}");
            }
            Kind::Preset(names) => {
                for name in names() {
                    with(&format!("'{name}'")).unwrap();
                }
                let error = with("'zzzz'").unwrap_err();
                assert!(error.ends_with(&names().join(", ")), "{error}");
            }
            _ => {}
        }
    }
}
